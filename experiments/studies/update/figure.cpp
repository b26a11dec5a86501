#include <fmt/format.h>

#include <cmath>

#include "experiments/results/forest_plot.hpp"
#include "experiments/studies/update/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

constexpr Colour set_colours[] = {Colour::blue,   Colour::vermillion, Colour::green,
                                  Colour::purple, Colour::orange,     Colour::sky};

}  // namespace

// A row for each parameter: the sets that fit as well, in parts of the description.
Figure update_figure(const UpdateStudy& study, const std::string& name) {
  ForestPlot plot{"", "parameter / described, 95 % intervals", {}, {}};
  for (const Unknown& unknown : study.unknowns()) plot.names.push_back(unknown.name);
  std::size_t number = 0;
  for (const ParameterSet& set : study.updating.sets) {
    if (!set.as_well || number >= std::size(set_colours)) continue;
    ForestSeries series{fmt::format("set {}", number + 1), {}, {}, {}, set_colours[number]};
    for (std::size_t j = 0; j < study.unknowns().size(); ++j) {
      const double described = study.unknowns()[j].guess,
                   value = set.values[static_cast<Index>(j)] / described;
      const UpdatedParameter& one = study.updating.parameters[j];
      const bool interval = number == 0 && one.determined;
      series.value.push_back(described != 0.0 ? value : std::nan(""));
      series.lower.push_back(interval ? one.lower_95 / described : value);
      series.upper.push_back(interval ? one.upper_95 / described : value);
    }
    plot.series.push_back(std::move(series));
    ++number;
  }
  if (number == 1) plot.series[0].label.clear();
  plot.reference = ForestReference{"as described", 1.0};
  Figure figure{name, {forest_panel(plot)}};
  figure.height = forest_height(plot.names.size() * std::max<std::size_t>(1, plot.series.size() / 2), 1);
  figure.caption = "Updated parameters over those described; every set that fits as well.";
  return figure;
}

}  // namespace beamid::experiments
