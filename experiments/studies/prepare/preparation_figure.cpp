#include "experiments/studies/prepare/preparation_figure.hpp"

#include <optional>
#include <stdexcept>

#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/amplitude_spectrum.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

std::string axis_label(const Channel& channel) {
  return std::string(to_string(channel.quantity)) + " [" + si_unit(channel.quantity) + "]";
}

Panel time_panel(const Record& record, const std::string& title, Colour colour) {
  const Eigen::Index row = motion_row(record);
  Panel panel{title, {"time [s]"}, {axis_label(record.channels[row])}, {}, Legend::none};
  panel.curves = {{"", record.time, record.samples.row(row).transpose(), CurveStyle::line, {}, {}, colour}};
  return panel;
}

std::optional<Panel> spectrum_panel(const Record& record, const std::string& title, Colour colour) {
  double interval = 0;
  try {
    interval = even_interval(record);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  const Eigen::Index row = motion_row(record);
  const AmplitudeSpectrum spectrum =
      amplitude_spectrum(bridged_straight(record.samples.row(row).transpose()), interval);
  const Eigen::Index bins = spectrum.frequency_hz.size() - 1;
  const double highest = spectrum.amplitude.tail(bins).maxCoeff();
  if (!(highest > 0)) return std::nullopt;
  constexpr double shown = 1e-5;
  Panel panel{title, {"frequency [Hz]"}, {axis_label(record.channels[row]), true}, {}, Legend::none};
  panel.curves = {{"",
                   spectrum.frequency_hz.tail(bins),
                   spectrum.amplitude.tail(bins).cwiseMax(shown * highest),
                   CurveStyle::line,
                   {},
                   {},
                   colour}};
  panel.y_axis.range = {shown * highest, 2 * highest};
  return panel;
}

}  // namespace

Eigen::Index motion_row(const Record& record) {
  for (std::size_t i = 0; i < record.channels.size(); ++i)
    if (record.channels[i].quantity != Quantity::force) return static_cast<Eigen::Index>(i);
  return 0;
}

Figure preparation_figure(const PreparedRecord& prepared) {
  Figure figure{"before_and_after", {}};
  figure.panels.push_back(time_panel(prepared.raw, "as the file holds it", Colour::grey));
  auto raw = spectrum_panel(prepared.raw, "its spectrum", Colour::grey);
  const auto after = spectrum_panel(prepared.record, "its spectrum", Colour::blue);
  const bool both = raw && after;
  if (raw && after &&
      prepared.raw.channels[motion_row(prepared.raw)].quantity ==
          prepared.record.channels[motion_row(prepared.record)].quantity)
    raw->x_axis.range = {0, 0.5 / prepared.raw.interval()};
  if (raw) figure.panels.push_back(*raw);
  figure.panels.push_back(time_panel(prepared.record, "prepared", Colour::blue));
  if (after) figure.panels.push_back(*after);
  figure.rows = both ? 2 : static_cast<int>(figure.panels.size());
  figure.columns = both ? 2 : 1;
  figure.width = both ? 1100 : 800;
  return figure;
}

}  // namespace beamid::experiments
