#include "experiments/studies/steps/scheme_at_step.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

std::optional<FoundMode> predicted_mode(const std::string& scheme, const FoundMode& exact, double interval) {
  try {
    const Oscillator seen = seen_through(
        scheme,
        Oscillator::from_frequency(1.0, 2.0 * std::numbers::pi * exact.frequency_hz, exact.damping_ratio),
        interval);
    return FoundMode{seen.frequency_hz(), seen.damping_ratio()};
  } catch (const std::runtime_error&) {  // no motion of the scheme is like it
    return {};
  } catch (const std::invalid_argument&) {
    return {};
  }
}

// The closed form holds for a record without noise; with noise, scheme and exact motion weigh it alike but
// for a small part.
bool is_as_predicted(const FoundMode& found, const FoundMode& predicted, const FoundMode& exact) {
  constexpr double of_bias = 0.01, of_deviation = 0.1;
  return std::abs(found.damping_ratio - predicted.damping_ratio) <=
         of_bias * std::abs(predicted.damping_ratio - exact.damping_ratio) +
             of_deviation * exact.damping_ratio_deviation;
}

SchemeAtStep::Verdict verdict_on(const SchemeAtStep& one, const FoundMode& exact) {
  if (!one.predicted || !is_as_predicted(*one.found, *one.predicted, exact))
    return SchemeAtStep::Verdict::unexplained;
  const double shift = std::abs(one.found->damping_ratio - exact.damping_ratio);
  return shift <= quantile_95 * exact.damping_ratio_deviation ? SchemeAtStep::Verdict::harmless
                                                              : SchemeAtStep::Verdict::biased;
}

SchemeAtStep of_run(const ComparedRun& run, const SchemeAtStep* exact, double interval) {
  SchemeAtStep one;
  one.discretisation = run.discretisation;
  one.reason = run.reason;
  if (run.diagnostics && run.diagnostics->consistency)
    one.mean_nis = run.diagnostics->consistency->mean_normalised_square;
  if (exact && exact->is_valid()) one.predicted = predicted_mode(run.discretisation, *exact->found, interval);
  // A ratio that the modal analysis contradicts is what is looked for, but of the reference.
  const bool usable = exact ? run.has_estimate() : run.answers();
  if (run.has_estimate()) one.found = run.mode;
  if (!usable || !one.found) {
    if (one.reason.empty()) one.reason = to_string(run.status);
  } else if (!exact) {
    one.verdict = SchemeAtStep::Verdict::exact;
  } else if (!exact->is_valid()) {
    one.reason = "the exact discretisation has no estimate here";
  } else {
    one.verdict = verdict_on(one, *exact->found);
  }
  return one;
}

}  // namespace

const char* to_string(SchemeAtStep::Verdict verdict) {
  switch (verdict) {
    case SchemeAtStep::Verdict::exact:
      return "reference";
    case SchemeAtStep::Verdict::harmless:
      return "harmless";
    case SchemeAtStep::Verdict::biased:
      return "biased";
    case SchemeAtStep::Verdict::unexplained:
      return "UNPREDICTED";
    case SchemeAtStep::Verdict::invalid:
      return "INVALID";
  }
  return "";
}

RecordAtStep record_at_step(const Comparison& comparison, int factor) {
  const Record& record = comparison.analysis.record;
  RecordAtStep step{factor, record.interval(), record.size(), record.time[0], record.time[record.size() - 1],
                    {}};
  for (const ComparedRun& run : comparison.runs)
    step.found.push_back(of_run(run, step.found.empty() ? nullptr : step.found.data(), step.interval));
  return step;
}

}  // namespace beamid::experiments
