// A record that is to be identified, and what is decided about it where nobody says.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/record/record.hpp"

namespace beamid::experiments {

// The part of a free decay in which nothing befell the structure or its sensors.

struct SoundPart {
  double from = 0, to = 0;  ///< [s]
  std::string words;        ///< why it is not the whole, a sentence for reports
};

/// Of a free decay that is broken by clipped readings (of any channel, to a period behind them) or by jumps
/// of its motion (decay_jump.hpp, of the first channel), the part that determines frequency and damping best:
/// that of the largest energy times squared length. Where the frequency jumps, the side whose frequency is
/// nearer to the mode as described is left: on the other the clock is another one. Nothing where the decay is
/// whole, or where no part of eight periods is left.
///
/// Clipped readings are missing by what their own noise was and by what the motion rides on: those beside
/// them are a choice, whose mean is no longer that of the motion. With a noise of a sixth of the limit the
/// damping ratio then comes out a tenth too small, with a slow sway of a quarter of it, too.
/// @throws std::invalid_argument when the beam cannot be assembled
std::optional<SoundPart> sound_part(const Experiment& experiment, const Record& record,
                                    const std::vector<RecordDefect>& defects);

// Which part of a record of a hit or a release is a free decay worth identifying.

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

/// One record, with the experiment as it holds for it.
struct IdentificationRequest {
  std::filesystem::path file;
  Experiment experiment;  ///< preparation and window included
  PreparedRecord prepared;
  std::string window = {};  ///< what was chosen, in words, where the experiment does not say
  bool thinned = false;     ///< by a step against higher modes, which the experiment does not have

  /// A paragraph for each thing that was decided.
  std::vector<std::string> decisions() const;
  /// K and C of a free decay have a report of their own.
  bool is_free_oscillator() const;
  /// With what the modal analysis needed of the record among its remarks: a filter takes it as it is.
  PreparedRecord as_analysed() const;
  /// The record as it is compared, with the noise before its event where that is what the experiment asks
  /// for.
  /// @throws InputError at the noise method
  ComparedRecord compared() const;
};

/// Cuts a free decay out of a record that the experiment does not cut, and in which no force was measured.
/// @throws as decay_window(); InputError at the window
void cut_decay(IdentificationRequest& one);

/// Adds the step that an experiment silent about preparation does not have.
/// @param reductions that the record is identified by; empty: the experiment's one. The step is added where
/// each of them would have it alone, for all are given the same record.
/// @throws as step_against_higher_modes(); InputError at the step or the window
void keep_out_higher_modes(IdentificationRequest& one, const std::vector<Choice>& reductions = {});

}  // namespace beamid::experiments
