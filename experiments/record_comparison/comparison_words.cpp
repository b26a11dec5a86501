#include "experiments/record_comparison/comparison_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/model_setting.hpp"
#include "experiments/record_comparison/comparison_figures.hpp"

namespace beamid::experiments {
namespace {

// "bending_stiffness -2.72 % (interval +-0.01 %)", or how far from the reference where there is no truth.
std::string parameter_text(const ComparedRun& run, const ComparedRun& reference, std::size_t j) {
  const ComparedParameter& p = run.parameters[j];
  const Estimate& e = p.estimate;
  const double half = 100.0 * quantile_95 * e.deviation / std::abs(e.value);
  if (const auto error = p.error_percent())
    return fmt::format("{} {:+.3g} % (interval +-{:.2g} %)", e.name, *error, half);
  const std::string text = fmt::format("{} {:.5g}{}{} (interval +-{:.2g} %)", e.name, e.value,
                                       e.unit.empty() ? "" : " ", e.unit, half);
  if (&run == &reference) return text;
  const double other = reference.parameters[j].estimate.value;
  return text + fmt::format(", {:+.3g} % from the reference", 100.0 * (e.value / other - 1.0));
}

std::string time_text(const ComparedRun& run, const ComparedRun& reference) {
  const double ratio = reference.seconds / run.seconds;
  if (&run == &reference) return fmt::format("{:.2g} s", run.seconds);
  return ratio >= 1.0 ? fmt::format("{:.2g} s, {:.3g} times faster", run.seconds, ratio)
                      : fmt::format("{:.2g} s, {:.3g} times slower", run.seconds, 1.0 / ratio);
}

std::string run_text(const Comparison& comparison, const ComparedRun& run, const ComparedRun& reference) {
  const bool alone = comparison.runs.size() == 1;
  std::string text = fmt::format("{}{} ({} coordinate{}): ", name_of(comparison, run),
                                 &run == &reference && !alone ? ", the reference" : "", run.coordinates,
                                 run.coordinates == 1 ? "" : "s");
  for (std::size_t j = 0; j < run.parameters.size(); ++j)
    text += (j ? "; " : "") + parameter_text(run, reference, j);
  return text + fmt::format(". It reproduces the record to {:.3g} % and took {}.", run.response_error_percent,
                            time_text(run, reference));
}

// An error many times its own deviation is not noise: the model is at fault.
std::string bias_text(const Comparison& comparison) {
  constexpr double surely = 4.0;
  std::string biased;
  for (const ComparedRun& run : comparison.runs)
    for (const ComparedParameter& p : run.parameters)
      if (run.status == ComparedRun::Status::converged && p.truth &&
          std::abs(p.estimate.value - *p.truth) > surely * p.estimate.deviation)
        biased += fmt::format("{}{} of {} ({:.0f} deviations)", biased.empty() ? "" : ", ", p.estimate.name,
                              name_of(comparison, run),
                              std::abs(p.estimate.value - *p.truth) / p.estimate.deviation);
  if (biased.empty()) return {};
  return "Beyond their own intervals are " + biased +
         ": an error of the model or of its discretisation, which no interval of a filter shows.";
}

// Whether a smaller model, otherwise identified alike, leaves less of the record: impossible on the right
// branch.
bool worse_than_smaller(const Comparison& comparison, const ComparedRun& run) {
  constexpr double clearly = 1.25;
  return std::any_of(comparison.runs.begin(), comparison.runs.end(), [&](const ComparedRun& smaller) {
    return smaller.status == ComparedRun::Status::converged && smaller.coordinates < run.coordinates &&
           smaller.filter == run.filter && smaller.discretisation == run.discretisation &&
           clearly * smaller.response_error_percent < run.response_error_percent;
  });
}

// A model that leaves much of the record is blind to some of its modes, or the filter has settled on a wrong
// branch: both are told from each other by what a larger model leaves.
std::string misfit_text(const Comparison& comparison) {
  constexpr double much = 20.0;
  std::string poor, wrong;
  for (const ComparedRun& run : comparison.runs) {
    if (run.status != ComparedRun::Status::converged) continue;
    const bool worse = worse_than_smaller(comparison, run);
    if (!worse && run.response_error_percent <= much) continue;
    std::string& list = worse ? wrong : poor;
    list += fmt::format("{}{} ({:.3g} %)", list.empty() ? "" : ", ", name_of(comparison, run),
                        run.response_error_percent);
  }
  std::string text;
  if (!poor.empty())
    text =
        "Much of the record is left by " + poor +
        ": modes that the model does not have, or guesses so far off that the filter has settled on a wrong "
        "answer. If a larger model leaves as much, start from nearer guesses or smaller deviations.";
  if (!wrong.empty())
    text += (text.empty() ? "" : " ") + std::string("More of the record than a smaller model is left by ") +
            wrong +
            ": the filter has settled on a wrong answer. Start from nearer guesses or smaller deviations.";
  return text;
}

// A deviation below the bound, by more than what was believed beforehand explains: the filter was sure before
// it was right, and the next pass would move.
std::string surer_text(const Comparison& comparison) {
  constexpr double clearly = 0.8;
  std::string surer;
  for (const ComparedRun& run : comparison.runs)
    for (const ComparedParameter& p : run.parameters) {
      if (run.status != ComparedRun::Status::converged || !p.bound) continue;
      const double least = 1.0 / std::hypot(1.0 / *p.bound, 1.0 / p.estimate.prior_deviation);
      if (p.estimate.deviation < clearly * least)
        surer += fmt::format("{}{} of {} ({:.2g} of the bound)", surer.empty() ? "" : ", ", p.estimate.name,
                             name_of(comparison, run), p.estimate.deviation / least);
    }
  if (surer.empty()) return {};
  return "Surer than the record allows is the filter of " + surer +
         ": it was linearised too far from what it found. Filter more often ([compare] passes), or start "
         "from "
         "nearer guesses.";
}

// How far the best model is from a sensor's own noise, where that is known.
std::string excess_text(const Comparison& comparison, const ComparedRun& reference) {
  constexpr double far = 2.0;
  const Eigen::VectorXd& sensors = comparison.compared.sensor_noise;
  double excess = 0.0;
  const std::vector<Eigen::Index> channels = output_channels(comparison.compared.record);
  for (std::size_t i = 0; i < channels.size() && sensors.size() > 0; ++i)
    if (const double own = sensors[channels[i]]; own > 0.0)
      excess = std::max(excess, reference.noise[static_cast<Eigen::Index>(i)] / own);
  if (excess < far) return {};
  return fmt::format(
      "Even the reference leaves {:.3g} times the noise of a sensor: there is motion in the record "
      "that no model of this comparison has, or the reference is wrong.",
      excess);
}

}  // namespace

const ComparedRun* reference_run(const Comparison& comparison) {
  const ComparedRun* best = nullptr;
  for (const ComparedRun& run : comparison.runs) {
    if (run.status != ComparedRun::Status::converged) continue;
    const bool whole = run.reduction == "none";
    if (!best || (whole && best->reduction != "none") ||
        (whole == (best->reduction == "none") && run.coordinates > best->coordinates))
      best = &run;
  }
  return best;
}

std::vector<std::string> words(const Comparison& comparison) {
  const ComparedRun* reference = reference_run(comparison);
  if (!reference) return {"No run converged."};
  std::vector<std::string> paragraphs;
  paragraphs.push_back(run_text(comparison, *reference, *reference));
  for (const ComparedRun& run : comparison.runs) {
    if (&run == reference) continue;
    if (run.status != ComparedRun::Status::converged)
      paragraphs.push_back(
          fmt::format("{}: {}, {}.", name_of(comparison, run), to_string(run.status), run.reason));
    else if (run.parameters.size() == reference->parameters.size())
      paragraphs.push_back(run_text(comparison, run, *reference));
  }
  if (const std::string text = bias_text(comparison); !text.empty()) paragraphs.push_back(text);
  for (const std::string& text :
       {misfit_text(comparison), surer_text(comparison), excess_text(comparison, *reference)})
    if (!text.empty()) paragraphs.push_back(text);
  return paragraphs;
}

}  // namespace beamid::experiments
