#include "experiments/studies/modal/amplitude_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/results/cell_text.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// One mode of one record.
struct Dependence {
  std::size_t record = 0, mode = 0;  ///< mode: in the merged ones
  Index channel = 0;
  std::vector<AmplitudePoint> points;
  std::string reason;  ///< why there are none
};

Index largest_channel(const RecordModes& found, const Pole& pole) {
  Index channel = 0;
  (found.record.samples.rowwise().norm().cwiseMax(1e-300).cwiseInverse().asDiagonal() * pole.shape.cwiseAbs())
      .maxCoeff(&channel);
  return channel;
}

Dependence dependence_of(const RecordModes& found, std::size_t at) {
  Dependence one;
  const Pole& pole = found.modes[at].pole;
  one.channel = largest_channel(found, pole);
  std::vector<std::complex<double>> others;
  for (const ModeEstimate& mode : found.modes) others.push_back(mode.pole.rate);
  try {
    one.points = amplitude_dependence(found.record.samples.row(one.channel).transpose(),
                                      found.record.interval(), pole.rate, others);
    for (AmplitudePoint& point : one.points) point.time += found.record.time[0];
    if (one.points.empty()) one.reason = "damping ratio uncertain by more than 20 % from the first window on";
  } catch (const std::invalid_argument& error) {
    one.reason = error.what();
  }
  return one;
}

Table table_of(const std::vector<Dependence>& all, const std::vector<RecordModes>& records) {
  constexpr std::size_t most_rows = 8;
  Table table{"amplitude", "Frequency and damping ratio against amplitude"};
  if (records.size() > 1) table.column({"record", "record"});
  table.column({"mode", "mode", "{:.0f}"})
      .column({"time [s]", "time_s", "{:.3f}"})
      .column({"amplitude", "amplitude", "{:.3g}"})
      .column({"unit", "unit"})
      .column({"f [Hz]", "frequency_hz"})
      .column({"standard deviation", "frequency_standard_deviation_hz", "{:.2g}"})
      .column({"damping ratio [%]", "damping_ratio_percent"})
      .column({"standard deviation", "damping_ratio_standard_deviation_percent", "{:.2g}"});
  bool thinned = false;
  for (const Dependence& one : all) {
    const std::size_t step = (one.points.size() + most_rows - 1) / most_rows;
    thinned = thinned || step > 1;
    for (std::size_t k = 0; k < one.points.size(); k += step) {
      const AmplitudePoint& point = one.points[k];
      std::vector<Cell> row;
      if (records.size() > 1) row.emplace_back(records[one.record].name);
      row.insert(row.end(),
                 {static_cast<double>(one.mode + 1), point.time, point.amplitude,
                  std::string(si_unit(records[one.record].record.channels[one.channel].quantity)),
                  Rounded{point.frequency_hz, point.frequency_deviation_hz}, point.frequency_deviation_hz,
                  Rounded{100 * point.damping_ratio, 100 * point.damping_ratio_deviation},
                  100 * point.damping_ratio_deviation});
      table.row(std::move(row));
    }
  }
  table.note = fmt::format(
      "Windows overlap by half.{}",
      thinned ? " More points than are shown here lie in amplitude_dependence of results.json and in the "
                "figure."
              : "");
  return table;
}

/// "Mode 1: damping ratio 1.54 to 1.21 %, frequency 11.139 to 11.250 Hz as the amplitude falls from ..."
std::string sentence(const Dependence& one, const RecordModes& found) {
  if (one.points.size() < 2)
    return fmt::format("Mode {} of {}: one window only, before the noise hides it.", one.mode + 1,
                       found.name);
  const AmplitudePoint &first = one.points.front(), &last = one.points.back();
  const auto differ = [](double a, double b, double da, double db) {
    return std::abs(a - b) > 2 * std::hypot(da, db);
  };
  const bool f = differ(first.frequency_hz, last.frequency_hz, first.frequency_deviation_hz,
                        last.frequency_deviation_hz),
             ratio = differ(first.damping_ratio, last.damping_ratio, first.damping_ratio_deviation,
                            last.damping_ratio_deviation);
  return fmt::format(
      "Mode {} of {}: as the amplitude falls from {:.3g} to {:.3g} {}, the damping ratio {} and the "
      "frequency {}.",
      one.mode + 1, found.name, first.amplitude, last.amplitude,
      si_unit(found.record.channels[one.channel].quantity),
      ratio ? fmt::format("goes from {} to {} %",
                          rounded_text({100 * first.damping_ratio, 100 * first.damping_ratio_deviation}),
                          rounded_text({100 * last.damping_ratio, 100 * last.damping_ratio_deviation}))
            : "does not change beyond its deviations",
      f ? fmt::format("from {} to {} Hz", rounded_text({first.frequency_hz, first.frequency_deviation_hz}),
                      rounded_text({last.frequency_hz, last.frequency_deviation_hz}))
        : "does not");
}

Curve curve_of(const Dependence& one, const std::string& label, bool damping) {
  const auto count = static_cast<Index>(one.points.size());
  VectorXd x(count), y(count), deviation(count);
  for (Index k = 0; k < count; ++k) {
    const AmplitudePoint& point = one.points[k];
    x[k] = point.amplitude;
    y[k] = damping ? 100 * point.damping_ratio : point.frequency_hz;
    deviation[k] =
        quantile_95 * (damping ? 100 * point.damping_ratio_deviation : point.frequency_deviation_hz);
  }
  return {label, x, y, CurveStyle::points, y - deviation, y + deviation};
}

Figure figure_of(const std::vector<Dependence>& all, const std::vector<RecordModes>& records,
                 std::size_t modes) {
  constexpr std::size_t most_modes = 6;
  Figure figure{"amplitude_dependence", {}, 0, 2, 1000};
  for (std::size_t m = 0; m < modes && figure.rows < static_cast<int>(most_modes); ++m) {
    std::vector<const Dependence*> shown;
    for (const Dependence& one : all)
      if (one.mode == m && one.points.size() > 1) shown.push_back(&one);  // the table has the single points
    if (shown.empty()) continue;
    const auto& channel = records[shown[0]->record].record.channels[shown[0]->channel];
    const std::string amplitude =
        fmt::format("amplitude of {} [{}]", to_string(channel.quantity), si_unit(channel.quantity));
    Panel frequency{fmt::format("mode {}", m + 1), {amplitude, true}, {"frequency [Hz], bars: 95 %"}},
        damping{fmt::format("mode {}", m + 1), {amplitude, true}, {"damping ratio [%], bars: 95 %"}};
    for (const Dependence* one : shown) {
      const std::string label = records.size() > 1 ? records[one->record].name : "";
      frequency.curves.push_back(curve_of(*one, label, false));
      damping.curves.push_back(curve_of(*one, label, true));
    }
    if (records.size() == 1) frequency.legend = damping.legend = Legend::none;
    figure.panels.push_back(std::move(frequency));
    figure.panels.push_back(std::move(damping));
    ++figure.rows;
  }
  figure.height = 60 + 320 * figure.rows;
  figure.caption = "Frequency and damping ratio of each mode against its amplitude, with 95 % intervals.";
  return figure;
}

nlohmann::ordered_json amplitude_values_of(const std::vector<Dependence>& all,
                                           const std::vector<RecordModes>& records) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Dependence& one : all) {
    const Channel& channel = records[one.record].record.channels[one.channel];
    nlohmann::ordered_json entry{{"record", records[one.record].name},
                                 {"mode", one.mode + 1},
                                 {"channel", channel.name},
                                 {"unit", si_unit(channel.quantity)}};
    entry["points"] = nlohmann::ordered_json::array();
    for (const AmplitudePoint& point : one.points)
      entry["points"].push_back({{"time_s", point.time},
                                 {"amplitude", point.amplitude},
                                 {"frequency_hz", point.frequency_hz},
                                 {"frequency_standard_deviation_hz", point.frequency_deviation_hz},
                                 {"damping_ratio", point.damping_ratio},
                                 {"damping_ratio_standard_deviation", point.damping_ratio_deviation}});
    if (!one.reason.empty()) entry["reason"] = one.reason;
    json.push_back(std::move(entry));
  }
  return json;
}

}  // namespace

void add_amplitude(const std::vector<RecordModes>& records, const std::vector<MergedMode>& merged,
                   Results& results) {
  std::vector<Dependence> all;
  for (std::size_t m = 0; m < merged.size(); ++m)
    for (std::size_t r = 0; r < records.size(); ++r) {
      if (!records[r].free_decay)
        throw std::invalid_argument(
            "--amplitude follows a free decay; the method takes the record for random "
            "vibration");
      if (merged[m].places[r] < 0) continue;
      all.push_back(dependence_of(records[r], static_cast<std::size_t>(merged[m].places[r])));
      all.back().record = r;
      all.back().mode = m;
    }
  results.values["amplitude_dependence"] = amplitude_values_of(all, records);
  results.heading("Amplitude");
  Table table = table_of(all, records);
  if (table.rows() > 0) {
    results.table(std::move(table));
    if (Figure figure = figure_of(all, records, merged.size()); !figure.panels.empty())
      results.figures.push_back(std::move(figure));
  }
  for (const Dependence& one : all)
    results.paragraph(one.points.empty() ? fmt::format("Mode {} of {} is not followed: {}.", one.mode + 1,
                                                       records[one.record].name, one.reason)
                                         : sentence(one, records[one.record]));
}

}  // namespace beamid::experiments
