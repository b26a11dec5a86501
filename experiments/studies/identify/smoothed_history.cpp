#include "experiments/studies/identify/smoothed_history.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "experiments/models/estimates.hpp"
#include "experiments/results/csv.hpp"
#include "experiments/results/file.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

// "stiffness" and "N/m" give "stiffness_n_per_m".
std::string column(const std::string& name, const std::string& unit) {
  std::string key = name + "_";
  for (const char letter : unit) {
    if (letter == '/')
      key += "_per_";
    else
      key += letter == ' ' ? '_' : static_cast<char>(std::tolower(letter));
  }
  return key;
}

struct History {
  VectorXd mean, deviation;
};

History history(const std::vector<filters::Gaussian>& beliefs, Index state) {
  const auto samples = static_cast<Index>(beliefs.size());
  History result{VectorXd(samples), VectorXd(samples)};
  for (Index k = 0; k < samples; ++k) {
    const filters::Gaussian& belief = beliefs[static_cast<std::size_t>(k)];
    result.mean[k] = belief.mean[state];
    result.deviation[k] = std::sqrt(std::max(0.0, belief.marginal(state, 1)(0, 0)));
  }
  return result;
}

Panel panel_of(const VectorXd& time, const RecordIdentification& found, Index state) {
  const filters::Label label = found.model.motion->state_labels()[static_cast<std::size_t>(state)];
  const History filtered = history(found.identification.run.filtered, state),
                after = history(found.smoothed, state);
  const VectorXd wide = quantile_95 * filtered.deviation, narrow = quantile_95 * after.deviation;
  return Panel{"", {"time [s]"}, {label.name + " [" + label.unit + "]"}}
      .band("filter, 95 %", time, filtered.mean - wide, filtered.mean + wide, Colour::grey)
      .dashed("filter", time, filtered.mean, Colour::black)
      .band("smoother, 95 %", time, after.mean - narrow, after.mean + narrow, Colour::sky)
      .line("smoother", time, after.mean, Colour::blue);
}

}  // namespace

Attachment smoothed_history(const Record& record, const RecordIdentification& found) {
  const auto labels = found.model.motion->state_labels();
  std::string text = "time_s";
  for (const filters::Label& label : labels)
    text += "," + column(label.name, label.unit) + "," + column(label.name + "_deviation", label.unit);
  text += "\n";
  for (std::size_t k = 0; k < found.smoothed.size(); ++k) {
    const VectorXd deviation = found.smoothed[k].deviations();
    text += csv_field(record.time[static_cast<Index>(k)]);
    for (Index i = 0; i < deviation.size(); ++i)
      text += "," + csv_field(found.smoothed[k].mean[i]) + "," + csv_field(deviation[i]);
    text += "\n";
  }
  return {{"smoothed.csv"},
          [text](const std::filesystem::path& folder) { write_file(folder / "smoothed.csv", text); }};
}

Figure smoothed_figure(const Record& record, const RecordIdentification& found) {
  const VectorXd time = record.time.head(static_cast<Index>(found.smoothed.size()));
  const double begin = time[0], end = time[time.size() - 1];
  Figure figure{"smoothed_history", {}, 3, 1};
  for (const Index state : {0, 2, 3}) {
    Panel panel = panel_of(time, found, state);
    panel.x_axis.range = {begin, end};
    if (state == 0)
      panel.x_axis.range = {begin, std::min(end, begin + 6.0 / found.identification.found.frequency_hz())};
    else {  // the start of a filter is as wide as the prior, and would hide all the rest
      const double last = found.smoothed.back().mean[state];
      const double half = 20.0 * found.smoothed.back().deviations()[state];
      if (half > 0.0) panel.y_axis.range = {last - half, last + half};
    }
    figure.panels.push_back(panel);
  }
  figure.caption = "Filtered and smoothed displacement, stiffness and damping.";
  return figure;
}

}  // namespace beamid::experiments
