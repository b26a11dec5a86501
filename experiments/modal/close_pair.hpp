// Two modes of a free decay where one is fitted, or one whose frequency and damping follow its amplitude.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "experiments/modal/dominant_mode.hpp"
#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/poles.hpp"

namespace beamid::experiments {

/// Mode m of a joint fit, with deviations.
Pole fitted_pole(const JointDecayFit& fit, std::size_t m);

/// Whether one mode with a rate that drifts describes a record (p x N) no worse than modes a and b of a joint
/// fit do:
///
///     Re(A e^(s_a t) + B e^(s_b t))    against    Re(exp(c_0 + c_1 t + c_2 t^2 + c_3 t^3)),
///                                      or         Re(exp(c_0 + c_1 t + c_2 a + c_3 a^2 + c_4 a^3)),  a =
///                                      e^(-d t)
///
/// with d the mean damping rate of both, complex A, B, s, c, in the channel where the two are largest, beside
/// the other modes of the fit. Two modes beat, which no cubic follows over more than a cycle; a drifting one
/// does not. Asked of poles less than 4 cycles apart over the record, or over three time constants of the
/// slower.
bool is_one_drifting_mode(const JointDecayFit& fit, std::size_t a, std::size_t b,
                          const Eigen::MatrixXd& target, double interval);

/// Distances of two modes from one.
struct PairSpread {
  double frequency_hz = 0.0, damping_ratio = 0.0;
};

/// Two modes in the place of mode m of a joint fit.
struct ClosePair {
  JointDecayFit fit;  ///< of the record; the two are m and the last of its modes
  std::size_t m = 0;
  double over_drift = 0.0;  ///< chi^2 of one drifting mode over theirs
  bool wins = false;        ///< the record has two modes; else neither explains it better
  double cycles = 0.0;      ///< by which they differ over the record

  Pole low() const;
  Pole high() const;
  /// Whether a record that does not decide has no result for one mode, either: both are damped alike, and a
  /// quarter of a cycle or more apart. What follows the amplitude looks like a second mode of another
  /// damping, as the n-th power of an amplitude decays n times as fast, or of nearly the same rate.
  bool is_indeterminate() const;
  /// Whether a result for one mode is none: the pair wins, or is indeterminate.
  bool contradicts_one() const { return wins || is_indeterminate(); }
  /// Whether one mode that drifts does not explain the record as well: then a drift is no way out.
  bool speaks_against_one() const { return contradicts_one() || over_drift > 0.0; }
  /// Of the farther one, each by its share of the larger.
  PairSpread spread_about(double frequency_hz, double damping_ratio) const;
  /// close_modes where it contradicts one mode, else drift_or_pair.
  const char* objection() const;
  /// What the record says of its mode at a frequency [Hz].
  std::string sentence(double frequency_hz) const;
};

/// chi^2 by which two modes must win.
constexpr double clearly_two = 25.0;

/// Poles less than a line apart are one pole to a search over orders, and a line that is wider than its mode.
/// In the place of mode m a pair is tried: the realisation of order 4 [juang1985] of the record (p x N)
/// without the other modes, then least squares of all. It wins where
///
/// - it reduces the squares by more than chance does: chi-square of 2 + 2 p degrees of freedom at 1e-6, by
///   the density of its residual near it;
/// - one mode whose frequency and damping drift, as in is_one_drifting_mode() but alike in all channels, has
///   squares larger by 25 times that density;
/// - they differ by a quarter of a cycle or more over the record, and some channel has both: friction and
///   clocks that differ look like two modes otherwise;
/// - its residual is as dense near it as farther away: a frequency that follows the amplitude is no pair.
///
/// Where squares of the drifting mode are not larger by 25 and not smaller by 10, neither wins.
/// @param fit of the record with one mode there
/// @return nothing where one mode explains the record
std::optional<ClosePair> close_pair(const Eigen::MatrixXd& record, double interval, const JointDecayFit& fit,
                                    std::size_t m);

/// The strongest mode of a decay, the first, and its companions by least squares of a record (p x N).
/// @throws as fit_decays_jointly()
JointDecayFit fit_with_companions(const Eigen::MatrixXd& record, double interval, const ModalEstimate& mode);

/// The decay of one channel as far as it lasts (8 time constants, 40,000 samples at most), decimated to 20
/// samples a cycle or more, and the least squares of its modes.
struct FittedDecay {
  Eigen::MatrixXd record;  ///< (1 x N)
  double interval = 0.0;   ///< [s]
  JointDecayFit fit;       ///< the strongest mode first, its companions after it
};

/// @param signal (N), finite
/// @return nothing where it is too short, or a motion that decaying modes do not fit
std::optional<FittedDecay> fitted_decay(const Eigen::VectorXd& signal, double interval,
                                        const ModalEstimate& mode);

/// In the place of the strongest mode of a decay, beside its companions; nothing where the search fails.
std::optional<ClosePair> close_pair(const FittedDecay& decay);

}  // namespace beamid::experiments
