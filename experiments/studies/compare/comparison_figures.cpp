#include "experiments/studies/compare/comparison_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/model_setting.hpp"
#include "experiments/record/axis_label.hpp"
#include "experiments/results/forest_plot.hpp"
#include "experiments/results/signal_panels.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Runs = std::vector<const ComparedRun*>;

constexpr double shown_periods = 10.0;
constexpr std::size_t most_residuals = 8;  // of which each has a panel

Runs reproduced_runs(const Comparison& comparison) {
  Runs runs;
  for (const ComparedRun& run : comparison.runs)
    if (run.reproduced.size() > 0) runs.push_back(&run);
  return runs;
}

// A row for each run: error in per cent where the truth is known, else the estimate.
Panel parameter_panel(const Comparison& comparison, const Runs& runs, std::size_t j) {
  const ComparedParameter& first = runs.front()->parameters[j];
  const std::string unit = first.estimate.unit.empty() ? "" : " [" + first.estimate.unit + "]";
  const bool relative = first.error_percent().has_value();
  std::string title = first.estimate.name;
  std::replace(title.begin(), title.end(), '_', ' ');
  ForestPlot plot{
      title, relative ? "error [%], 95 % intervals" : "estimate" + unit + ", 95 % intervals", {}, {{}}};
  for (const ComparedRun* run : runs) {
    const ComparedParameter& p = run->parameters[j];
    const auto shown = [&](double value) { return relative ? 100.0 * (value / *p.truth - 1.0) : value; };
    const double ends[] = {shown(p.estimate.lower_95), shown(p.estimate.upper_95)};
    plot.names.push_back(name_of(comparison, *run));
    plot.series[0].value.push_back(shown(p.estimate.value));
    plot.series[0].lower.push_back(std::min(ends[0], ends[1]));
    plot.series[0].upper.push_back(std::max(ends[0], ends[1]));
  }
  if (relative) plot.reference = ForestReference{"true value", 0.0};
  return forest_panel(plot);
}

Figure parameter_figure(const Comparison& comparison, const Runs& runs) {
  Figure figure{"parameters", {}, 0, 1, 900};
  for (std::size_t j = 0; j < runs.front()->parameters.size(); ++j)
    figure.panels.push_back(parameter_panel(comparison, runs, j));
  figure.rows = static_cast<int>(figure.panels.size());
  figure.height = forest_height(runs.size(), figure.panels.size());
  figure.caption =
      "Estimates of all runs with their 95 % intervals; an arrow: beyond the axis, the number at the right.";
  return figure;
}

// Record with the runs nearest to it and farthest from it, then what each run leaves, on one scale.
Figure motion_figure(const Comparison& comparison, const Runs& runs, Index channel) {
  const Record& record = comparison.compared.record;
  const auto row = output_channels(record)[static_cast<std::size_t>(channel)];
  const Channel& shown = record.channels[static_cast<std::size_t>(row)];
  const VectorXd measured = record.samples.row(row);
  const std::string label = axis_label(shown.quantity);
  const auto [best, worst] = std::minmax_element(runs.begin(), runs.end(), [](const auto* a, const auto* b) {
    return a->response_error_percent < b->response_error_percent;
  });
  std::vector<DrawnSignal> drawn{
      {name_of(comparison, **best), (*best)->reproduced.row(channel), Colour::sky}};
  if (*best != *worst)
    drawn.insert(drawn.begin(),
                 {name_of(comparison, **worst), (*worst)->reproduced.row(channel), Colour::vermillion});
  const double begin = record.time[0], end = record.time[record.size() - 1];
  const double frequency = (*best)->frequency_hz.value_or(shown_periods / (end - begin));
  const double last = std::min(end, begin + shown_periods / frequency);
  Figure figure{channel == 0 ? "reproduction" : fmt::format("reproduction_{}", channel + 1), {}, 0, 1, 900};
  figure.panels.push_back(
      reproduction_panel(channel_title(shown) + ", the first ten periods: nearest and farthest run",
                         record.time, measured, drawn, label)
          .across(begin, last));
  const Index inside = (record.time.array() <= last).count();
  std::vector<VectorXd> residuals;
  double largest = 0;
  for (std::size_t i = 0; i < std::min(runs.size(), most_residuals); ++i) {
    residuals.emplace_back(measured - runs[i]->reproduced.row(channel).transpose());
    for (const double value : residuals.back().head(inside))
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    figure.panels.push_back(
        residual_panel(fmt::format("{} leaves {:.3g} {} (rms)", name_of(comparison, *runs[i]),
                                   root_mean_squares(residuals[i].transpose())[0], si_unit(shown.quantity)),
                       record.time, residuals[i], label, largest)
            .across(begin, last));
    figure.panels.back().y_axis.label = std::string("[") + si_unit(shown.quantity) + "]";
    figure.panels.back().x_axis.label = "";
  }
  figure.panels.back().x_axis.label = "time [s]";
  figure.rows = static_cast<int>(figure.panels.size());
  figure.height = 340 + 120 * (figure.rows - 1);
  figure.caption =
      fmt::format("{}: record, its nearest and farthest reproduction, and what each run leaves of it.",
                  channel_title(shown));
  return figure;
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
  const Runs runs = reproduced_runs(comparison);
  if (runs.empty()) return {};
  std::vector<Figure> all;
  for (Index channel = 0; channel < runs.front()->reproduced.rows(); ++channel)
    all.push_back(motion_figure(comparison, runs, channel));
  Runs alike;  // the models may differ in what they ask about
  for (const ComparedRun* run : runs)
    if (run->parameters.size() == runs.front()->parameters.size() && run->answers()) alike.push_back(run);
  if (!alike.empty() && !alike.front()->parameters.empty())
    all.push_back(parameter_figure(comparison, alike));
  return all;
}

}  // namespace beamid::experiments
