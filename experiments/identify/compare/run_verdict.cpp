#include "experiments/identify/compare/run_verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/noise_near_mode.hpp"

namespace beamid::experiments {
namespace {

std::string innovations_text(const filters::InnovationConsistency& c) {
  if (c.white() && c.size_is_steady()) return {};
  const char* const what = c.white()            ? "white, but their size changes along the record"
                           : c.size_is_steady() ? "of steady size, but not white"
                                                : "neither white nor of steady size";
  return fmt::format(
      "The innovations are {} (Ljung-Box p = {:.2g}, mean normalised square {:.3g}): the record holds motion "
      "that "
      "the model does not, and the intervals are a lower limit of the uncertainty.",
      what, c.whiteness_p_value, c.mean_normalised_square);
}

// What counts for frequency and damping is the density of the noise at the mode, whatever R says of all of
// it.
double widening(const Comparison& comparison, ComparedRun& run, std::vector<std::string>& notes) {
  const Record& record = comparison.compared.record;
  const Eigen::Index first = output_channels(record)[0];
  const NoiseNearMode near =
      noise_near_mode(record.samples.row(first).transpose(), record.interval(), *comparison.modal);
  const double density = near.deviation / run.noise[0], factor = near.student() * density;
  if (!(factor > 1.0)) return 1.0;
  run.noise_ratio = density;
  run.noise_freedom = near.freedom;
  notes.push_back(fmt::format(
      "Near the mode the noise density, from {} spectral lines, is {:.3g} times that of white noise of the "
      "deviation assumed: intervals are widened by {:.3g}.",
      near.lines, density, factor));
  return factor;
}

void widen(ComparedRun& run, double factor) {
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    Estimate& e = run.parameters[j].estimate;
    const Unknown& unknown = run.unknowns[j];
    const auto place = static_cast<Eigen::Index>(j);
    const double mean = run.unknown_state.mean[place];
    const double half = quantile_95 * factor * std::sqrt(run.unknown_state.covariance(place, place));
    e.deviation *= factor;
    e.lower_95 = unknown.to_physical(mean - half);
    e.upper_95 = unknown.to_physical(mean + half);
  }
  if (run.mode) {
    run.mode->damping_ratio_deviation *= factor;
    run.mode->frequency_deviation_hz *= factor;
  }
}

// "the damping ratio 0.56 % (modal analysis 0.40 %, 12 standard deviations)", where it is many of them.
void add_difference(const char* what, double found, double deviation, double modal, double modal_deviation,
                    double shown, const char* unit, std::string& text) {
  constexpr double many = 3.0;
  const double apart = std::abs(found - modal) / std::hypot(deviation, modal_deviation);
  if (!(apart > many)) return;
  text += fmt::format(
      "{}{} {:.5g} {} ({:+.3g} % from the {:.5g} {} of the modal analysis, {:.3g} standard "
      "deviations)",
      text.empty() ? "" : ", ", what, shown * found, unit, 100.0 * (found / modal - 1.0), shown * modal, unit,
      apart);
}

std::string difference_text(const Comparison& comparison, const ComparedRun& run) {
  if (!run.mode) return {};
  const ModalEstimate& modal = *comparison.modal;
  std::string text;
  add_difference("frequency", run.mode->frequency_hz, run.mode->frequency_deviation_hz, modal.frequency_hz,
                 modal.frequency_standard_deviation_hz, 1.0, "Hz", text);
  add_difference("damping ratio", run.mode->damping_ratio, run.mode->damping_ratio_deviation,
                 modal.damping_ratio, modal.damping_ratio_standard_deviation, 100.0, "%", text);
  if (text.empty()) return {};
  return "The model and the modal analysis of the first channel DISAGREE: " + text +
         ". The modal analysis knows no model: trust it, or give the model the modes that it lacks.";
}

}  // namespace

void judge_runs(Comparison& comparison) {
  for (ComparedRun& run : comparison.runs) {
    if (run.status != ComparedRun::Status::converged) continue;
    // To a model that has the mode's companions, or a frequency that amplitude changes, they are no noise.
    const bool one_mode = run.coordinates == 1 || (comparison.modal && comparison.modal->companions.empty());
    if (comparison.modal && run.mode && one_mode) {
      widen(run, widening(comparison, run, comparison.compared.notes));
      if (const std::string text = difference_text(comparison, run); !text.empty())
        comparison.warnings.push_back(text);
    }
    if (run.diagnostics && run.diagnostics->consistency)
      if (const std::string text = innovations_text(*run.diagnostics->consistency); !text.empty())
        comparison.warnings.push_back(text);
  }
}

}  // namespace beamid::experiments
