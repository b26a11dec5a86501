#include "experiments/identify/compare/against_modal_analysis.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace beamid::experiments {
namespace {

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

std::string difference_text(const ModalEstimate& modal, const ComparedRun& run) {
  std::string text;
  add_difference("frequency", run.mode->frequency_hz, run.mode->frequency_deviation_hz, modal.frequency_hz,
                 modal.frequency_standard_deviation_hz, 1.0, "Hz", text);
  add_difference("damping ratio", run.mode->damping_ratio, run.mode->damping_ratio_deviation,
                 modal.damping_ratio, modal.damping_ratio_standard_deviation, 100.0, "%", text);
  if (text.empty()) return {};
  return "The model and the modal analysis of the first channel DISAGREE: " + text +
         ". The modal analysis knows no model: trust it, or give the model the modes that it lacks.";
}

// As K and C of one degree of freedom are judged (record_identification.cpp): damping that is not the
// record's is no estimate.
bool has_another_damping(const ModalEstimate& modal, const ComparedRun& run) {
  constexpr double twice = 2.0, many = 3.0;
  const FoundMode& mode = *run.mode;
  const double apart = std::abs(mode.damping_ratio - modal.damping_ratio) /
                       std::hypot(mode.damping_ratio_deviation, modal.damping_ratio_standard_deviation);
  return apart > many && !(mode.damping_ratio < twice * modal.damping_ratio &&
                           twice * mode.damping_ratio > modal.damping_ratio);
}

}  // namespace

void judge_against_modal_analysis(const RunContext& context, ComparedRun& run) {
  const auto& modal = context.analysis.modal;
  // A model that has the mode's companions does not have its frequency alone, and an aliased one has another.
  const bool one_mode =
      !context.analysis.aliased && (run.coordinates == 1 || (modal && modal->companions.empty()));
  if (!modal || !run.mode || !one_mode) return;
  const std::string text = difference_text(*modal, run);
  if (text.empty()) return;
  run.warnings.push_back(text);
  if (!has_another_damping(*modal, run)) return;
  run.status = ComparedRun::Status::contradicted;
  run.reason = fmt::format("damping ratio {:.3g} %, where the modal analysis of the record has {:.3g} %",
                           100.0 * run.mode->damping_ratio, 100.0 * modal->damping_ratio);
}

}  // namespace beamid::experiments
