#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/results/figure.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/studies/inspect/inspection_report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

VectorXd figure_vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

void add_panels(const Inspection& found, const InspectedChannel& channel, Figure& figure) {
  const VectorXd time = figure_vector(found.time), samples = figure_vector(channel.samples);
  const std::string unit = channel.unit.empty() ? "" : " [" + channel.unit + "]";
  Panel history{"", {found.has_time ? "time [s]" : "sample"}, {title(channel) + unit}};
  history.line("", time, samples, Colour::blue).across(time[0], time[time.size() - 1]).key(Legend::none);
  if (!channel.events.empty() && !spiky(channel)) {
    VectorXd at(channel.events.size()), value(channel.events.size());
    for (Index k = 0; k < at.size(); ++k) {
      const SignalEvent& event = channel.events[static_cast<std::size_t>(k)];
      at[k] = time[event.sample], value[k] = channel.offset + event.size;
    }
    history.open_points("event", at, value, Colour::vermillion);
  }
  figure.panels.push_back(thinned(std::move(history)));

  VectorXd filled = samples;
  for (Index k = 0; k < filled.size(); ++k)
    if (!std::isfinite(filled[k])) filled[k] = channel.offset;
  const double interval = (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
  Panel spectrum = spectrum_panel({{"", filled}}, interval > 0 ? interval : 1.0, title(channel) + unit)
                       .value_or(Panel{"", {"frequency [Hz]"}, {"no motion"}});
  if (!found.has_time) spectrum.x_axis.label = "frequency [1/sample]";
  figure.panels.push_back(thinned(std::move(spectrum)));
}

}  // namespace

std::vector<Figure> inspection_figures(const Inspection& found) {
  constexpr std::size_t rows = 4;
  std::vector<Figure> all;
  std::vector<const InspectedChannel*> shown;
  for (const InspectedChannel& channel : found.channels)
    if (channel.greatest > channel.least && found.time.size() >= 16) shown.push_back(&channel);
  for (std::size_t first = 0; first < shown.size(); first += rows) {
    const std::size_t count = std::min(rows, shown.size() - first);
    Figure figure{
        first == 0 ? "record" : fmt::format("record_{}", first / rows + 1), {}, static_cast<int>(count), 2};
    figure.width = 1000;
    figure.caption = "The channels as the file holds them, and their amplitude spectra.";
    for (std::size_t k = 0; k < count; ++k) add_panels(found, *shown[first + k], figure);
    all.push_back(std::move(figure));
  }
  return all;
}

}  // namespace beamid::experiments
