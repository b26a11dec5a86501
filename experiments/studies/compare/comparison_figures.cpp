#include "experiments/studies/compare/comparison_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/model_setting.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double shown_periods = 10.0;
constexpr std::size_t most_curves = 6;  // that can be told apart

std::vector<const ComparedRun*> reproduced_runs(const Comparison& comparison) {
  std::vector<const ComparedRun*> runs;
  for (const ComparedRun& run : comparison.runs)
    if (run.reproduced.size() > 0) runs.push_back(&run);
  return runs;
}

// Points with 95 % bars: error in per cent where the truth is known, else the estimate.
Panel parameter_panel(const Comparison& comparison, const std::vector<const ComparedRun*>& runs,
                      std::size_t j) {
  const ComparedParameter& first = runs.front()->parameters[j];
  const std::string unit = first.estimate.unit.empty() ? "" : " [" + first.estimate.unit + "]";
  const bool relative = first.error_percent().has_value();
  Panel panel{first.estimate.name,
              {"coordinates of the model", true},
              {relative ? "error [%], bars of 95 %" : "estimate" + unit + ", bars of 95 %"},
              {}};
  double fewest = 1e9, most = 0.0;
  for (const ComparedRun* run : runs) {
    const ComparedParameter& p = run->parameters[j];
    const auto shown = [&](double value) { return relative ? 100.0 * (value / *p.truth - 1.0) : value; };
    const auto r = static_cast<double>(run->coordinates);
    fewest = std::min(fewest, r);
    most = std::max(most, r);
    panel.curves.push_back({name_of(comparison, *run), VectorXd::Constant(1, r),
                            VectorXd::Constant(1, shown(p.estimate.value)), CurveStyle::points,
                            VectorXd::Constant(1, shown(p.estimate.lower_95)),
                            VectorXd::Constant(1, shown(p.estimate.upper_95))});
  }
  panel.x_axis.range = {0.6 * fewest, 1.7 * most};
  if (relative)
    panel.curves.push_back({"truth",
                            Eigen::Vector2d(0.6 * fewest, 1.7 * most),
                            Eigen::Vector2d::Zero(),
                            CurveStyle::dashed,
                            {},
                            {},
                            Colour::black});
  return panel;
}

Panel motion_panel(const Comparison& comparison, const std::vector<const ComparedRun*>& runs, bool left) {
  const Record& record = comparison.compared.record;
  const Index channel = output_channels(record)[0];
  const Quantity quantity = record.channels[channel].quantity;
  const VectorXd measured = record.samples.row(channel);
  Panel panel{left ? "what the model leaves" : "record and reproduction, the first ten periods",
              {"time [s]"},
              {fmt::format("{} [{}]", to_string(quantity), si_unit(quantity))},
              {}};
  if (!left)
    panel.curves.push_back({"record", record.time, measured, CurveStyle::line, {}, {}, Colour::grey});
  for (const ComparedRun* run : runs) {
    const VectorXd reproduced = run->reproduced.row(0);
    panel.curves.push_back({name_of(comparison, *run), record.time,
                            left ? VectorXd(measured - reproduced) : reproduced,
                            left ? CurveStyle::line : CurveStyle::dashed});
  }
  const double begin = record.time[0], end = record.time[record.size() - 1];
  const double frequency = runs.front()->frequency_hz.value_or(shown_periods / (end - begin));
  panel.x_axis.range = {begin, std::min(end, begin + shown_periods / frequency)};
  return panel;
}

}  // namespace

std::string name_of(const Comparison& comparison, const ComparedRun& run) {
  const auto differs = [&](auto part) {
    return std::any_of(comparison.runs.begin(), comparison.runs.end(),
                       [&](const ComparedRun& other) { return other.*part != run.*part; });
  };
  std::string name = run.reduction;
  if (differs(&ComparedRun::filter)) name += ", " + run.filter;
  if (differs(&ComparedRun::discretisation)) name += ", " + run.discretisation;
  return name;
}

std::vector<Figure> figures(const Comparison& comparison) {
  std::vector<const ComparedRun*> runs = reproduced_runs(comparison);
  if (runs.empty()) return {};
  const auto count = runs.front()->parameters.size();
  Figure errors{"parameters", {}, 1, 1};
  std::vector<const ComparedRun*> alike;  // the models may differ in what they ask about
  for (const ComparedRun* run : runs)
    if (run->parameters.size() == count && run->status == ComparedRun::Status::converged)
      alike.push_back(run);
  for (std::size_t j = 0; !alike.empty() && j < count; ++j)
    errors.panels.push_back(parameter_panel(comparison, alike, j));
  errors.columns = errors.panels.size() > 1 ? 2 : 1;
  errors.rows = static_cast<int>((errors.panels.size() + errors.columns - 1) / errors.columns);
  if (runs.size() > most_curves) runs.resize(most_curves);
  Figure motion{
      "reproduction", {motion_panel(comparison, runs, false), motion_panel(comparison, runs, true)}, 2, 1};
  std::vector<Figure> all{motion};
  if (!errors.panels.empty()) all.push_back(errors);
  return all;
}

}  // namespace beamid::experiments
