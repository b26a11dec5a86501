#include "experiments/studies/identify/smoothed_history.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/models/estimates.hpp"
#include "experiments/results/file.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

struct History {
  VectorXd mean, deviation;
};

History history(const std::vector<filters::Gaussian>& estimates, Index state) {
  const auto samples = static_cast<Index>(estimates.size());
  History result{VectorXd(samples), VectorXd(samples)};
  for (Index k = 0; k < samples; ++k) {
    const filters::Gaussian& estimate = estimates[static_cast<std::size_t>(k)];
    result.mean[k] = estimate.mean[state];
    result.deviation[k] = std::sqrt(std::max(0.0, estimate.marginal(state, 1)(0, 0)));
  }
  return result;
}

Panel panel_of(const SmoothedRecord& record, Index state) {
  const filters::Label label = record.model.motion->state_labels()[static_cast<std::size_t>(state)];
  const auto samples = static_cast<Index>(record.smoothed.size());
  const VectorXd time = record.time.head(samples);
  const History filtered = history(record.filtered, state), after = history(record.smoothed, state);
  const VectorXd wide = quantile_95 * filtered.deviation, narrow = quantile_95 * after.deviation;
  return Panel{"", {"time [s]"}, {label.name + (label.unit.empty() ? "" : " [" + label.unit + "]")}}
      .band("filter, 95 %", time, filtered.mean - wide, filtered.mean + wide, Colour::grey)
      .dashed("filter", time, filtered.mean, Colour::black)
      .band("smoother, 95 %", time, after.mean - narrow, after.mean + narrow, Colour::sky)
      .line("smoother", time, after.mean, Colour::blue);
}

}  // namespace

Attachment smoothed_history(const SmoothedRecord& record) {
  const auto labels = record.model.motion->state_labels();
  std::string text = "time_s";
  for (const filters::Label& label : labels)
    text +=
        "," + column_key(label.name, label.unit) + "," + column_key(label.name + "_deviation", label.unit);
  text += "\n";
  for (std::size_t k = 0; k < record.smoothed.size(); ++k) {
    const VectorXd deviation = record.smoothed[k].deviations();
    text += csv_field(record.time[static_cast<Index>(k)]);
    for (Index i = 0; i < deviation.size(); ++i)
      text += "," + csv_field(record.smoothed[k].mean[i]) + "," + csv_field(deviation[i]);
    text += "\n";
  }
  return {{"smoothed.csv"},
          [text](const std::filesystem::path& folder) { write_file(folder / "smoothed.csv", text); }};
}

Figure smoothed_figure(const SmoothedRecord& record, double frequency_hz) {
  constexpr std::size_t most_unknowns = 3;
  constexpr double cycles = 6.0, deviations = 20.0;
  const double begin = record.time[0], end = record.time[static_cast<Index>(record.smoothed.size()) - 1];
  Figure figure{"smoothed_history", {}, 0, 1};
  figure.panels.push_back(panel_of(record, 0));
  figure.panels.back().x_axis.range = {begin, std::min(end, begin + cycles / frequency_hz)};
  const auto& unknowns = record.model.unknown_places;
  for (std::size_t j = 0; j < std::min(most_unknowns, unknowns.size()); ++j) {
    Panel panel = panel_of(record, unknowns[j]);
    panel.x_axis.range = {begin, end};
    // the start of a filter is as wide as the prior, and would hide all the rest
    const double last = record.smoothed.back().mean[unknowns[j]],
                 half = deviations * record.smoothed.back().deviations()[unknowns[j]];
    if (half > 0.0) panel.y_axis.range = {last - half, last + half};
    figure.panels.push_back(panel);
  }
  figure.rows = static_cast<int>(figure.panels.size());
  figure.caption = "Filtered and smoothed motion and unknowns.";
  return figure;
}

}  // namespace beamid::experiments
