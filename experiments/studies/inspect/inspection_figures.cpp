#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/signal/amplitude_spectrum.hpp"
#include "experiments/studies/inspect/inspection_words.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

VectorXd figure_vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

void add_panels(const Inspection& found, const InspectedChannel& channel, Figure& figure) {
  const VectorXd time = figure_vector(found.time), samples = figure_vector(channel.samples);
  const std::string unit = channel.unit.empty() ? "" : " [" + channel.unit + "]";
  Panel history{title(channel), {found.has_time ? "time [s]" : "sample"}, {title(channel) + unit}, {}};
  history.title = "";
  history.curves.push_back({"", time, samples, CurveStyle::line, {}, {}, Colour::blue});
  if (!channel.events.empty() && !spiky(channel)) {
    VectorXd at(channel.events.size()), value(channel.events.size());
    for (Index k = 0; k < at.size(); ++k) {
      const SignalEvent& event = channel.events[static_cast<std::size_t>(k)];
      at[k] = time[event.sample], value[k] = channel.offset + event.size;
    }
    history.curves.push_back({"event", at, value, CurveStyle::open_points, {}, {}, Colour::vermillion});
  }
  history.x_axis.range = {time[0], time[time.size() - 1]};
  history.legend = Legend::none;
  figure.panels.push_back(std::move(history));

  VectorXd filled = samples;
  for (Index k = 0; k < filled.size(); ++k)
    if (!std::isfinite(filled[k])) filled[k] = channel.offset;
  const double interval = (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
  AmplitudeSpectrum spectrum = amplitude_spectrum(filled, interval > 0 ? interval : 1.0);
  const double top = spectrum.amplitude.maxCoeff();
  const Index kept = spectrum.amplitude.size() - 1;
  Panel panel{
      "", {found.has_time ? "frequency [Hz]" : "frequency [1/sample]"}, {"amplitude" + unit, true}, {}};
  panel.curves.push_back({"",
                          spectrum.frequency_hz.tail(kept),
                          spectrum.amplitude.tail(kept).cwiseMax(1e-6 * top),
                          CurveStyle::line,
                          {},
                          {},
                          Colour::black});
  panel.x_axis.range = {0.0, spectrum.frequency_hz[kept]};
  panel.legend = Legend::none;
  figure.panels.push_back(std::move(panel));
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
    for (std::size_t k = 0; k < count; ++k) add_panels(found, *shown[first + k], figure);
    all.push_back(std::move(figure));
  }
  return all;
}

}  // namespace beamid::experiments
