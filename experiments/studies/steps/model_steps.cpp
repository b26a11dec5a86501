// One record at longer and longer steps, all unknowns of a model of many degrees of freedom.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "experiments/config/description.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/studies/steps/steps.hpp"
#include "filters/continuous_model.hpp"
#include "filters/scheme.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Complex = std::complex<double>;

FoundMode mode_of(Complex pole) {
  const Oscillator one = Oscillator::from_eigenvalue(1.0, pole);
  return FoundMode{one.frequency_hz(), one.damping_ratio()};
}

// The oscillating poles of the motion at the estimate, ascending [rad/s].
std::vector<Complex> poles_of(const ComparedRun& run) {
  std::vector<Complex> found;
  const auto* const motion = dynamic_cast<const filters::LinearMotion*>(run.model->motion.get());
  if (!motion || run.run.last.mean.size() == 0 || !run.run.last.mean.allFinite()) return found;
  Eigen::MatrixXd matrix;
  motion->motion_matrix(run.run.last.mean, matrix);
  const Eigen::VectorXcd poles = matrix.eigenvalues();
  std::copy_if(poles.begin(), poles.end(), std::back_inserter(found),
               [](Complex pole) { return pole.imag() > 0.0; });
  std::sort(found.begin(), found.end(), [](Complex a, Complex b) { return std::abs(a) < std::abs(b); });
  return found;
}

ModelAtStep of_run(const ComparedRun& run, int factor, double interval) {
  ModelAtStep one{run.discretisation, factor, interval, run.status, run.reason, {}, {}, {}};
  if (!run.has_estimate() || !run.model) return one;
  for (const ComparedParameter& parameter : run.parameters) one.parameters.push_back(parameter.estimate);
  const auto scheme = filters::scheme_registry().make(run.discretisation, {});
  for (const Complex pole : poles_of(run)) {
    one.modes.push_back(mode_of(pole));
    const Complex behind = std::log(scheme->amplification(pole * interval).value) / interval;
    one.behind.push_back(behind.imag() > 0.0 ? mode_of(behind) : FoundMode{});
  }
  return one;
}

std::string ratios(const std::vector<FoundMode>& modes) {
  std::string text;
  for (const FoundMode& mode : modes)
    text += fmt::format("{}{:.4g}", text.empty() ? "" : ", ", 100.0 * mode.damping_ratio);
  return text;
}

}  // namespace

std::optional<VectorXd> ModelSteps::extrapolated(std::size_t discretisation) const {
  constexpr std::size_t most = 4;
  constexpr double largest_step = 1.0;  // [rad]
  std::vector<double> intervals;
  std::vector<VectorXd> found;
  for (const std::vector<ModelAtStep>& step : steps) {
    const ModelAtStep& one = step.at(discretisation);
    if (one.parameters.empty() || one.modes.empty() || found.size() == most ||
        2.0 * std::numbers::pi * one.modes.back().frequency_hz * one.interval > largest_step)
      continue;
    VectorXd values(static_cast<Index>(one.parameters.size()));
    std::transform(one.parameters.begin(), one.parameters.end(), values.begin(),
                   [](const Estimate& estimate) { return estimate.value; });
    intervals.push_back(one.interval);
    found.push_back(std::move(values));
  }
  const int order = order_of(discretisations.at(discretisation));
  if (found.size() < 2 || order == 0) return {};
  return carried_to_zero(intervals, found, order);
}

ModelSteps study_model_steps(const StepsSettings& settings, const IdentificationRequest& one,
                             const std::filesystem::path& folder, const Progress& progress) {
  constexpr double fewest_a_period = 10.0 / 3.0;
  constexpr Index fewest = 100;
  constexpr int usual_steps = 4;
  Experiment experiment = one.experiment;
  experiment.reductions = {experiment.reduction};
  experiment.filters = {experiment.filter};
  experiment.discretisations = {exact_discretisation};
  for (const std::string& scheme : settings.discretisations)
    if (scheme != exact_discretisation) experiment.discretisations.push_back(scheme);
  ModelSteps study{one.file.filename().string(), experiment.discretisations, {}, {}};
  const Record whole = prepare(one.prepared.raw, experiment.format.preparation, experiment.format.window);
  const int wanted = settings.steps.value_or(usual_steps);
  for (int factor = 1; static_cast<int>(study.steps.size()) < wanted; factor *= 2) {
    if (factor > 1) {
      const ModelAtStep& exact = study.reference();
      const double highest_hz = exact.modes.back().frequency_hz, interval = factor * exact.interval;
      if (highest_hz * interval * fewest_a_period > 1.0 || one.prepared.record.size() / factor < fewest) {
        study.notes.push_back(
            fmt::format("{} step{}: at the next the mode at {:.4g} Hz would have {:.2g} samples a period and "
                        "the record {}.",
                        study.steps.size(), study.steps.size() == 1 ? "" : "s", highest_hz,
                        1.0 / (highest_hz * interval), one.prepared.record.size() / factor));
        break;
      }
      progress(fmt::format("steps of {:.4g} ms", 1e3 * interval));
    }
    try {
      const Record record = at_step(one, whole, factor);
      const Comparison found = compare(experiment, measured_record(one.file.filename().string(), record),
                                       folder, factor == 1 ? progress : unwatched);
      study.steps.emplace_back();
      for (const ComparedRun& run : found.runs)
        study.steps.back().push_back(of_run(run, factor, record.interval()));
    } catch (const std::invalid_argument& error) {
      if (factor == 1) throw;
      study.notes.push_back(fmt::format("No longer step: {}.", error.what()));
      break;
    }
    if (study.reference().modes.empty()) break;
  }
  return study;
}

namespace {

Table mode_table(const ModelSteps& study) {
  Table table{"modes", "Modes of the model at longer and longer steps"};
  table.column({"discretisation", "discretisation"})
      .column({"step [ms]", "step_ms", "{:.4g}"})
      .column({"mode", "mode", "{:.0f}"})
      .column({"f [Hz]", "frequency_hz", "{:.4f}"})
      .column({"f behind [Hz]", "behind_frequency_hz", "{:.4f}"})
      .column({"xi [%]", "damping_ratio_percent", "{:.4f}"})
      .column({"xi behind [%]", "behind_damping_ratio_percent", "{:.4f}"})
      .column({"exact xi [%]", "exact_damping_ratio_percent", "{:.4f}"})
      .column({"status", "status"});
  for (std::size_t d = 0; d < study.discretisations.size(); ++d)
    for (const std::vector<ModelAtStep>& step : study.steps) {
      const ModelAtStep &one = step[d], &exact = step.front();
      if (one.modes.empty())
        table.row({one.discretisation, 1e3 * one.interval, std::nan(""), std::nan(""), std::nan(""),
                   std::nan(""), std::nan(""), std::nan(""), to_string(one.status)});
      for (std::size_t m = 0; m < one.modes.size(); ++m)
        table.row({one.discretisation, 1e3 * one.interval, static_cast<double>(m + 1),
                   one.modes[m].frequency_hz, one.behind[m].frequency_hz, 100.0 * one.modes[m].damping_ratio,
                   100.0 * one.behind[m].damping_ratio,
                   m < exact.modes.size() ? 100.0 * exact.modes[m].damping_ratio : std::nan(""),
                   to_string(one.status)});
    }
  table.note =
      "Behind: the motion whose samples the scheme turns into the mode found, log(g(lambda dt)) / dt. Where "
      "the "
      "law holds it is that of the exact discretisation.";
  return table;
}

Table parameter_table(const ModelSteps& study) {
  Table table{"parameters", "Parameters at longer and longer steps, and carried on to a step of zero"};
  table.column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"discretisation", "discretisation"});
  for (const std::vector<ModelAtStep>& step : study.steps)
    table.column({fmt::format("{:.4g} ms", 1e3 * step.front().interval),
                  fmt::format("at_step_{}", step.front().factor), "{:.6g}"});
  table.column({"0 ms", "at_step_0", "{:.6g}"});
  const std::vector<Estimate>& parameters = study.reference().parameters;
  for (std::size_t j = 0; j < parameters.size(); ++j)
    for (std::size_t d = 0; d < study.discretisations.size(); ++d) {
      std::vector<Cell> row{parameters[j].name, parameters[j].unit, study.discretisations[d]};
      for (const std::vector<ModelAtStep>& step : study.steps)
        row.emplace_back(j < step[d].parameters.size() ? step[d].parameters[j].value : std::nan(""));
      const auto limit = study.extrapolated(d);
      row.emplace_back(limit ? (*limit)[static_cast<Index>(j)] : std::nan(""));
      table.row(std::move(row));
    }
  table.note = "0 ms: by the powers of the step that the scheme's error has, without the law.";
  return table;
}

}  // namespace

Results report(const Experiment& experiment, const ModelSteps& study) {
  Results results;
  results.command = "steps";
  results.configuration = describe(experiment, {"filter"});
  results.configuration.update(
      {{"record", study.record}, {"discretisations", study.discretisations}, {"passes", experiment.passes}});
  const ModelAtStep& exact = study.reference();
  results.values = {{"status", to_string(exact.status)}};
  results.heading(experiment.title.empty() ? study.record : experiment.title);
  if (exact.modes.empty()) {
    results.warning(fmt::format("NO REFERENCE: the exact discretisation has no estimate on {} ({}).",
                                study.record, exact.reason.empty() ? to_string(exact.status) : exact.reason),
                    true);
    return results;
  }
  for (std::size_t d = 1; d < study.discretisations.size(); ++d) {
    const ModelAtStep& one = study.steps.front()[d];
    if (one.modes.empty()) {
      results.warning(fmt::format("{} at steps of {:.4g} ms has no estimate: {}.", one.discretisation,
                                  1e3 * one.interval, one.reason));
      continue;
    }
    results.paragraph(fmt::format(
        "At steps of {:.4g} ms {} finds damping ratios of {} %, the exact discretisation {} %. The law puts "
        "{} % behind those of {}.",
        1e3 * one.interval, one.discretisation, ratios(one.modes), ratios(exact.modes), ratios(one.behind),
        one.discretisation));
  }
  results.table(mode_table(study));
  results.table(parameter_table(study));
  for (const std::string& text : study.notes) results.paragraph(text);
  results.paragraph(fmt::format("{}: {} on {}, {} passes, model {}.", study.record, experiment.filter.name,
                                experiment.reduction.name, experiment.passes, experiment.model.name));
  return results;
}

}  // namespace beamid::experiments
