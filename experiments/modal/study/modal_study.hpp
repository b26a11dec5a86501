// Modes of one record by one method: band, poles over orders, choice, polish.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/modal/modal_method.hpp"
#include "experiments/modal/poles.hpp"
#include "experiments/record/record.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/objection.hpp"

namespace beamid::experiments {

struct ModalStudySettings {
  Choice method{"era", {}};
  std::optional<std::pair<double, double>>
      band_hz;  ///< absent: from 2 cycles in the record to beyond its highest line
  int largest_order = 30;
  int modes = 0;                      ///< the strongest ones; 0: all
  std::optional<bool> polish;         ///< absent: of a method for free decays that goes over orders
  double smallest_amplitude = 0.003;  ///< relative to the strongest mode; weaker ones are left out
  StabilisationSettings stabilisation;
};

/// y_i(t) = Re(shape_i e^(rate t)), t = 0 at the first sample analysed. Deviations are NaN where unknown.
struct ModeEstimate {
  Pole pole;                ///< shape [unit of the channels]; of random vibration: root mean squares
  std::vector<int> orders;  ///< of the models in which it was stable
  double strength = 0;      ///< share of the squares of what it was to reproduce
  /// Farthest other explanation of the record (decay_polish.hpp), which the deviations of the pole hold in
  /// the end.
  double frequency_spread_hz = 0, damping_ratio_spread = 0;

  double amplitude(Eigen::Index channel) const { return std::abs(pole.shape[channel]); }
};

/// Of the motion about the strongest mode, what decaying modes do not explain (mode_objections.hpp).
struct ResidualAtMode {
  double share = 0.0;       ///< root of its power over that of the motion
  double over_noise = 0.0;  ///< its power over that of the noise

  /// Beyond a share and nine times the noise.
  bool exceeds(double least_share) const { return share > least_share && over_noise > 9.0; }
};

/// The modes of one record, and how they were found.
struct RecordModes {
  std::string name;                  ///< of the record
  Record record;                     ///< what was analysed: from its beginning on, motion only
  std::vector<std::string> remarks;  ///< sentences
  std::vector<Objection> objections;
  std::string drift;          ///< sentence about the sensor's drift that was taken off; empty: none
  bool free_decay = true;     ///< as the method takes it
  bool mode_by_mode = false;  ///< without model orders
  bool polished = false;
  bool decays = true;  ///< of a method for free decays: whether the record is one
  bool steady = true;  ///< of a method for random vibration: whether both halves are about as strong
  std::pair<double, double> band_hz;
  double interval = 0;  ///< after decimation [s]
  double start = 0;     ///< time of the first column of `target` [s]
  PoleSearch search;
  Stabilisation stabilisation;
  std::vector<ModeEstimate> modes;  ///< by rising frequency
  Eigen::MatrixXd target;           ///< (p x L) what the modes were to reproduce: record or autocorrelations
  Eigen::MatrixXd reproduced;       ///< (p x L)
  ResidualAtMode at_strongest;      ///< of a free decay; zero where there is none

  const Objection* objection(const std::string& kind) const;  ///< the first of its kind; nullptr: none
  double left() const;                    ///< of the target's size, what the modes leave; 1 without any
  bool is_steady_sine() const;            ///< lines that last are nearly all of the motion
  const ModeEstimate& strongest() const;  ///< of one mode at least
};

/// Analyses one record. Readings that are missing (NaN) end the part that is taken; without a window on a
/// free decay, what precedes the largest reading is left out. Channels are scaled by quantity for the search,
/// and decimated as far as the band allows. Lines that no mode stands for are named in the warnings.
/// @throws std::invalid_argument when record, band and orders do not fit.
RecordModes find_modes(const std::string& name, const Record& record, bool windowed,
                       const ModalStudySettings& settings);

// The modes of a free decay refined by nonlinear least squares (decay_polish.cpp).

/// All modes together, in all channels (fit_decays_jointly). Of two poles that cannot be told apart the one
/// of fewer orders goes to the rejected ones before the fit; where the fit does not converge, the weakest
/// goes; the weaker of two that are one drifting mode (close_pair.hpp); and, one at a time, the least
/// certain of those with an objection (mode_objections.hpp), and the rest is fitted anew. What went is tried
/// once more with those that stayed, for a pole may have gone for the company that it was in. Poles that no
/// fit has confirmed are no modes: where none is left, none is listed.
void polish(RecordModes& found, const StabilisationSettings& settings);

}  // namespace beamid::experiments
