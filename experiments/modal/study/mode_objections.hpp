// Why a fitted pole of a free decay is no mode of the structure, and which modes of several records are one.
#pragma once

#include <string>
#include <vector>

#include "experiments/modal/close_pair.hpp"
#include "experiments/modal/study/modal_study.hpp"

namespace beamid::experiments {

/// Two poles less than a cycle apart over the record, or over three time constants of the slower decay where
/// that is less, are one mode: a frequency or a damping that follows the amplitude is realised as several.
bool indistinguishable(const Pole& a, const Pole& b, double duration);

/// Why mode m is none; empty: it is one. It is none where least squares carried it away from `from`, where
/// frequency or damping ratio are too uncertain, and where it is no more than noise: its energy over the
/// density of the noise around, sum y^2 / s^2, is chi-square of 2 p + 2 degrees of freedom where there is
/// nothing, and is not to be exceeded with probability 0.001 in any of the band's resolutions; a mode that is
/// a quarter of a channel's energy is none.
std::string objection_to(const Pole& from, const JointDecayFit& fit, std::size_t m, const RecordModes& found,
                         const StabilisationSettings& settings);

/// Takes the modes that are multiples (2 and 3) of a stronger one below them, with its damping ratio, out of
/// the modes: a motion a cos(w t) that decays with d leaves the n-th power of a curved characteristic as
/// a^n cos(n w t), which decays with n d. A sensor that saturates leaves one that decays more slowly: told by
/// its phase, n times that of the motion, and a frequency within 0.3 %. Where the frequency drifts, amplitude
/// and phase follow along the decay (overtone_coherence).
void set_overtones_aside(RecordModes& found);

/// Whether a frequency is within 5 % of twice or three times that of the strongest mode, whose motion it
/// follows in amplitude and phase to a coherence of 0.9. @returns the multiple; 0: none
int followed_multiple(const RecordModes& found, double frequency_hz);

// What contradicts a free decay.

/// Of the motion about a mode, what decaying modes do not explain: over lines within 15 % of its frequency,
/// three at least to either side, and its first three time constants, for what random forces or drafts move
/// later is no part of the decay. The noise is the broadband noise of the channels (defects.hpp).
ResidualAtMode residual_at(const RecordModes& found, const ModeEstimate& mode);

/// `no_decay` where the motion does not decay, goes on to the end, or was not released; else
/// `unexplained_motion` where decaying modes do not explain a fifth of the motion about the strongest mode,
/// which is nine times the power of the noise there: of noise and linear modes neither occurs. Then
/// found.decays is false, unless the modes explain all but 30 % of a motion that was there from its release
/// and dies out. Sets found.at_strongest, of a record that was released and decays.
/// @param whole the record before its window was chosen
void object_to_decay(const Record& whole, RecordModes& found);

// The same modes in several records, as one.

/// A mean over records and two ideas of its deviation. NaN where there is none.
struct MergedValue {
  double mean = 0;         ///< weighted by inverse variance where all deviations are known
  double deviation = 0;    ///< formal: what the records' own deviations leave of it
  double scatter = 0;      ///< of the mean, from the spread between the records
  bool scattered = false;  ///< chi^2 of the spread above 95 % of what the deviations allow
};

struct MergedMode {
  std::vector<int> places;  ///< in each record's modes; -1: not there
  MergedValue frequency_hz, damping_ratio;

  int records() const;  ///< in how many it is
};

/// Modes are the same when their frequencies are within 5 % and their MAC is 0.8 at least; of several, the
/// nearest. A mode of one record only is kept as well.
std::vector<MergedMode> merge_modes(const std::vector<RecordModes>& records);

}  // namespace beamid::experiments
