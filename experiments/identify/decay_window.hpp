// Which part of a record of a hit or a release is a free decay worth identifying.
#pragma once

#include <optional>
#include <string>

#include "experiments/config/experiment.hpp"
#include "experiments/record/record.hpp"

namespace beamid::experiments {

struct DecayWindow {
  enum class Behind { event, start_up, gap };

  double event = 0;          ///< time of the last hit or release, or of what the window is behind instead [s]
  double settling = 0;       ///< periods of the first mode from there to the window
  double from = 0, to = 0;   ///< the window [s]
  double time_constant = 0;  ///< of the decay, 1/(xi omega) [s]
  Behind behind = Behind::event;  ///< a hit or release, a sensor's own start-up, or samples that are missing

  std::string words() const;  ///< a sentence for reports
};

/// The window where the record, whole, begins at rest and something happens to it: from three periods of the
/// first mode behind the last event, when a double hit is over and what died fast is gone, or from six or
/// twelve while there is another mode near it; over two time constants of the decay, eight periods at least.
///
/// More would add little to what is known, 1 - e^-4 of the decay's energy being inside, and in real beams
/// takes in damping at amplitudes e^2 times smaller: then no one damping ratio fits.
/// A slow letting go ends where the motion at the mode's frequency is largest. In a record that begins with a
/// sensor's start-up and shows no other event the window counts from where its offset has settled; where the
/// longest part without a long gap begins in motion, from that gap. Nothing for a record that begins in
/// motion with a settled offset, or whose decay cannot be made out.
/// @throws std::invalid_argument when the beam cannot be assembled
std::optional<DecayWindow> decay_window(const Experiment& experiment, const Record& record);

}  // namespace beamid::experiments
