#include "experiments/text/objection.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace beamid::experiments {
namespace {

constexpr const char *records = "records", *decays = "free decays", *driven = "driven records",
                     *any = "any model", *modes = "modes", *predicted = "updated models",
                     *scattered = "posteriors", *laws = "force laws", *steps = "steps of the filter";

}  // namespace

const std::vector<ObjectionKind>& objection_kinds() {
  static const std::vector<ObjectionKind> all{
      {"diverged", any, "failure of the filter, or stiffness, mass or frequency beyond reason",
       "There is no estimate."},
      {"implausible_response", any, "size of the computed motion over that of the record",
       "A unit or a gain is wrong by a usual factor."},
      {"innovations", any, "normalised square and whiteness of the innovations, p < 0.001",
       "The noise is not as assumed; standard deviations are too small or too large."},
      {"modal_disagreement", any, "3 standard deviations between model and modal analysis",
       "The model's first mode is not that of the record; contradicted where the damping ratio differs "
       "twofold."},
      {"moved_mass", any, "share of the mass that the base moves, 0.95",
       "The reduced model lacks modes that a moving base excites."},
      {"not_determined", any, "standard deviation over the prior one, 0.7",
       "The record determines a parameter no better than it was known beforehand."},
      {"not_settled", any, "last move of an unknown, 5 of its standard deviations",
       "The passes have not converged."},
      {"not_unique", any, "difference of -2 log posterior, 6",
       "Other sets of parameters explain the record as well."},
      {"overconfident", any, "standard deviation over the Cramer-Rao bound, 0.5",
       "The filter's intervals are too narrow to hold the truth."},
      {"prior", any, "distance from the prior, 4 of its standard deviations",
       "Estimate and description exclude each other, one by one or by a common factor."},
      {"reduction_bias", any, "shift of a mode by the reduction, in standard deviations",
       "The reduction moves a mode by more than an interval."},
      {"step_bias", any, "shift of a mode by the discretisation, in standard deviations",
       "The scheme moves stiffness or damping by more than an interval."},
      {"unexplained", any, "residual that is no noise, 10 % of a driven record, 50 % of a free decay",
       "No parameters of this model make the record; approximate where sections of the record agree."},
      {"description", driven, "share of the residual that one described quantity explains, 0.5; or score, 5",
       "A mass, a place, a gain, a sign or a delay is not as described."},
      {"input_clock", driven, "lag or rate of a clock, in its standard deviations",
       "Inputs and outputs are not on one clock."},
      {"input_noise", driven, "gain of the log likelihood by noise of an input, 10.1",
       "A measured input holds noise. Taken for exact it biases stiffness and damping; identify allows for "
       "it."},
      {"part_law", driven, "law of damping of a part", "The law is that of the whole beam's modes."},
      {"no_law", laws, "failure of the fit", "No force law fits the whole record."},
      {"other_motion", laws, "motion beside the mode over its amplitude",
       "The force law also contains another mode, noise, or a motion that does not decay."},
      {"aliased", decays, "described frequency over half the sampling rate",
       "The mode lies above half the sampling rate and is identified by its alias."},
      {"channel_amplitudes", decays, "amplitude of a channel over that of the model's shape",
       "A unit, a gain or a place of a channel is wrong."},
      {"channel_clocks", decays, "scatter of the channels' frequencies, p < 1e-6",
       "The channels do not ring at one frequency: their clocks differ."},
      {"free_modes", decays, "what free modes explain beyond the model, 1 % of the motion, and p < 1e-4",
       "The record's modes are not those of the model: something is described wrongly."},
      {"jump", decays, "jump of amplitude, phase or frequency over its noise",
       "Something happened within the decay; no one frequency and damping ratio describe it."},
      {"no_modal_analysis", decays, "failure of the modal analysis",
       "No result independent of the filter confirms the estimate."},
      {"overtone", decays, "line at a multiple of the frequency",
       "Sensor or stiffness is not linear; the damping ratio is wrong through it."},
      {"undetermined_damping", decays, "half of the 95 % interval over the damping ratio, 0.5",
       "Noise or a short record decides the damping ratio."},
      {"amplitude_dependent", modes,
       "change of frequency or damping ratio along the decay, 5 standard deviations and 0.2 % or 20 %",
       "Stiffness or damping is not linear: one frequency and damping ratio do not describe the decay."},
      {"channel_phases", modes, "phase collinearity of a shape",
       "Clocks differ, a near mode was missed, or damping is not classical."},
      {"close_modes", modes,
       "chi^2 of one drifting mode less that of two modes, which gain with p < 1e-5; 25",
       "The record has two modes in place of one, or does not decide: one damping ratio is not determined."},
      {"damped_by_hammer", modes, "pulses of one hit", "The hammer rebounded: modal masses are wrong."},
      {"drift_or_pair", modes,
       "as close_modes; damping ratios differ by a factor of 1.5, or the modes by a quarter of a cycle at "
       "most",
       "Either frequency or damping depends on amplitude, or there are two modes. Intervals are widened."},
      {"excluded_lines", modes, "lines of a mode's band that are a machine's or another mode's, of all in it",
       "The band has other lines than the mode's: they are excluded, and intervals grow."},
      {"lines", modes, "line of the spectrum that no mode explains",
       "A mode was missed, or lies outside the band."},
      {"met_in_motion", modes, "motion before a hit", "The structure still moved when it was hit."},
      {"no_decay", modes,
       "second half of the record over the first, loss below 5 %, motion that goes on or "
       "was not released",
       "A method for free decays was applied to a record that is none: exit code 3."},
      {"no_deviations", modes, "failure of least squares", "Poles have no standard deviations."},
      {"no_mode", modes, "modes that can be relied on, 1",
       "The record determines no mode: there is no answer, and the exit code is 3."},
      {"overtone_mode", modes, "multiple of a mode's frequency with its damping ratio or phase",
       "What is listed as an overtone is no mode of the structure."},
      {"own_clock", modes, "channels with a clock of their own",
       "The shapes contain the time lags of the clocks."},
      {"phase_wander", modes, "chi^2 of phases in sections, or over that of amplitudes, p < 1e-4",
       "Frequencies or clocks wander."},
      {"residue_phase", modes, "phase of a residue", "A modal mass is not that of a real mode."},
      {"spurious_pole", modes, "change of a pole in least squares", "A pole was excluded."},
      {"steady_line", modes,
       "root mean square of lines that last over that of the record; 0.9: there is no more",
       "A machine or the mains moves the record."},
      {"unexplained_modes", modes, "motion that the measured input makes through the modes, 70 %",
       "Something else moves the structure, or modes are missing or not constant."},
      {"unexplained_motion", modes,
       "residual about the strongest mode that is no noise, 20 %; of "
       "autocorrelations 50 %",
       "No decay of constant frequency and damping makes the record: exit code 3; of random "
       "vibration, the strongest mode was missed."},
      {"unstable_peak", modes, "peaks without a stable pole",
       "Frequencies or damping follow the amplitude, or a force was not measured."},
      {"unsteady", modes, "one half of the record over the other, 10",
       "Random vibration was expected to be stationary."},
      {"at_bound", scattered, "draws at a stated bound", "The bound decides the interval."},
      {"prior_tail", scattered, "draws in 0.1 % of the prior",
       "Prior and measurement contradict each other."},
      {"clipped", records, "readings at the end of a range", "Amplitudes near the limit are too small."},
      {"dropped", records, "readings of zero or a constant", "Samples are omitted."},
      {"file", records, "what a reader found", "The file contradicts itself or its description."},
      {"gaps", records, "steps between stamps", "Samples are missing."},
      {"missing_input", records, "samples of an input that were not read",
       "The record was cut, or inputs are 0."},
      {"rattle", records, "broadband noise while motion is large", "A loose contact damps the motion."},
      {"repeated", records, "readings equal to the one before", "Samples are omitted."},
      {"spikes", records, "readings far from both neighbours", "Samples are omitted."},
      {"unrecorded_base", records, "moving base without a channel",
       "A driven motion is taken for a free decay."},
      {"decimated_shift", steps, "shift of the exact scheme between steps, in intervals",
       "Not only the step differs between two rows."},
      {"few_samples", steps, "samples a period", "No longer step can be tried."},
      {"no_estimate_at_step", steps, "failure of a scheme", "A scheme has no estimate at a step."},
      {"unexplained_step", steps, "found minus predicted damping, in intervals",
       "The closed form does not describe this record."},
      {"close_pair", predicted, "distance of two frequencies, 1 %", "Their measured shapes may be mixed."},
      {"common_factor", predicted, "factor of all stiffnesses", "A mass or a unit is wrong."},
      {"measured_modes", predicted, "messages of the modal analysis", "The measured modes have objections."},
      {"missing_mode", predicted, "ratios of the frequencies",
       "A mode was not measured: numbers are shifted."},
      {"remedy", predicted, "explanation of the misfit by one change",
       "The description may be wrong in that quantity."},
      {"sign", predicted, "MAC with the sign of a channel reversed", "A channel has the opposite sign."},
      {"strange_shape", predicted, "MAC with all predicted shapes",
       "A measured shape is none of the model's."},
      {"unit_of_frequency", predicted, "measured over described frequencies",
       "Frequencies are not in Hz, or masses wrong."},
  };
  return all;
}

Objection::Objection(std::string kind, std::string sentences, double value, double bound)
    : name(std::move(kind)), text(std::move(sentences)), statistic(value), limit(bound) {
  const auto& all = objection_kinds();
  if (std::none_of(all.begin(), all.end(), [&](const ObjectionKind& one) { return one.name == name; }))
    throw std::logic_error("unknown kind of objection '" + name + "'");
}

std::vector<std::string> texts(const std::vector<Objection>& objections) {
  std::vector<std::string> all;
  for (const Objection& one : objections) all.push_back(one.text);
  return all;
}

}  // namespace beamid::experiments
