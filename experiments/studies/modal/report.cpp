
#include "experiments/studies/modal/report.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "experiments/modal/ambient_mode.hpp"
#include "experiments/modal/amplitude_dependence.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/results/gnuplot_axes.hpp"
#include "experiments/results/result_directory.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// NaN for a deviation that is not known.
double known_or_nan(double deviation, double scale = 1) {
  return deviation > 0 && std::isfinite(deviation) ? scale * deviation : std::nan("");
}

std::string introduction(const ModalStudySettings& settings, const RecordModes& found) {
  const Record& record = found.record;
  std::string text = fmt::format(
      "{}: {} samples of {} channel{} from {:.4f} to {:.4f} s at {:.2f} Hz, taken as {}. Band {:.4g} to "
      "{:.4g} Hz, sampled at {:.4g} Hz for it. Method {}",
      found.name, record.size(), record.channels.size(), record.channels.size() > 1 ? "s" : "",
      record.time[0], record.time[record.size() - 1], 1 / record.interval(),
      found.free_decay ? "a free decay" : "random vibration", found.band_hz.first, found.band_hz.second,
      1 / found.interval, settings.method.name);
  if (found.mode_by_mode)
    text += ", at the peaks of the spectrum";
  else
    text += fmt::format(", model orders 2 to {}",
                        found.search.orders.empty() ? 0 : found.search.orders.back().order);
  text += found.polished ? ", all modes polished together by least squares." : ".";
  if (found.reproduced.size() > 0)
    text += fmt::format(" The modes do not explain {:.2g} % of the {}.", 100 * found.left(),
                        found.free_decay ? "motion in the band" : "autocorrelations");
  return text;
}

// Of random vibration: what no unbiased estimate falls below, in a band as wide as the neighbours leave it.
AmbientLaw bound_of_mode(const RecordModes& found, std::size_t m) {
  const Pole& pole = found.modes[m].pole;
  double kappa = 10.0;
  for (std::size_t other = 0; other < found.modes.size(); ++other)
    if (other != m)
      kappa = std::min(kappa, 0.5 * std::abs(found.modes[other].pole.frequency_hz() - pole.frequency_hz()) /
                                  (pole.damping_ratio() * pole.frequency_hz()));
  const double duration = found.record.interval() * static_cast<double>(found.record.size());
  return ambient_law(pole.damping_ratio(), pole.frequency_hz() * duration, std::max(kappa, 1.0));
}

Table mode_table(const RecordModes& found, const std::string& suffix) {
  const auto& channels = found.record.channels;
  const Index shown = std::min<Index>(static_cast<Index>(channels.size()), 6);
  Table table{"modes" + suffix, ""};
  table.column({"mode", "mode", "{:.0f}"})
      .column({"f [Hz]", "frequency_hz"})
      .column({"standard deviation", "frequency_standard_deviation_hz", "{:.2g}"})
      .column({"damping ratio [%]", "damping_ratio_percent"})
      .column({"standard deviation", "damping_ratio_standard_deviation_percent", "{:.2g}"});
  if (!found.free_decay)
    table.column({"f: over bound", "frequency_deviation_over_bound", "{:.2f}"})
        .column({"damping: over bound", "damping_ratio_deviation_over_bound", "{:.2f}"});
  if (!found.mode_by_mode) table.column({"stable at orders", "stable_orders"});
  for (Index i = 0; i < shown; ++i)
    table.column(
        {fmt::format("{}{} [{}]", found.free_decay ? "amplitude" : "rms",
                     channels.size() > 1 ? " " + channels[i].name : "", si_unit(channels[i].quantity)),
         fmt::format("amplitude_{}", i + 1), "{:.3g}"});
  if (channels.size() > 1) table.column({"phase collinearity", "phase_collinearity", "{:.3f}"});
  for (std::size_t m = 0; m < found.modes.size(); ++m) {
    const ModeEstimate& mode = found.modes[m];
    const Pole& pole = mode.pole;
    std::vector<Cell> row{static_cast<double>(m + 1),
                          Rounded{pole.frequency_hz(), pole.frequency_deviation_hz},
                          known_or_nan(pole.frequency_deviation_hz),
                          Rounded{100 * pole.damping_ratio(), 100 * pole.damping_ratio_deviation},
                          known_or_nan(pole.damping_ratio_deviation, 100)};
    if (!found.free_decay) {
      const AmbientLaw bound = bound_of_mode(found, m);
      row.emplace_back(pole.frequency_deviation_hz / (bound.frequency * pole.frequency_hz()));
      row.emplace_back(pole.damping_ratio_deviation / (bound.damping * pole.damping_ratio()));
    }
    if (!found.mode_by_mode)
      row.emplace_back(fmt::format("{} of {}", mode.orders.size(), found.search.orders.size()));
    for (Index i = 0; i < shown; ++i) row.emplace_back(mode.amplitude(i));
    if (channels.size() > 1) row.emplace_back(phase_collinearity(pole.shape));
    table.row(std::move(row));
  }
  table.note =
      found.free_decay
          ? "Amplitudes are those at the beginning. Standard deviations include the noise near each mode, "
            "not damping that depends on amplitude."
          : fmt::format(
                "Standard deviations {}. Over bound: divided by the lower bound of an unbiased estimate for "
                "this record length without noise.",
                found.mode_by_mode ? "from the likelihood of each mode's band"
                                   : "from the scatter of the correlations between parts of the record");
  if (const auto all = static_cast<Index>(channels.size()); shown < all)
    table.note +=
        fmt::format(" Channels 1 to {} of {} are shown; results.json (--json) has all.", shown, all);
  return table;
}

Table rejected_table(const RecordModes& found, const std::string& suffix) {
  Table table{"rejected" + suffix, "Rejected poles"};
  constexpr std::size_t telling = 2;  // stable orders; clusters with fewer are noise at first sight
  std::size_t noise = 0;
  table.column({"f [Hz]", "frequency_hz", "{:.4g}"})
      .column({"damping ratio [%]", "damping_ratio_percent", "{:.3g}"})
      .column({"why", "reason"});
  for (const PoleCluster& cluster : found.stabilisation.rejected)
    if (cluster.orders.size() < telling && !found.mode_by_mode)
      ++noise;
    else
      table.row({cluster.pole.frequency_hz(), 100 * cluster.pole.damping_ratio(), cluster.objection});
  if (noise > 0 && table.rows() > 0)
    table.note = fmt::format("{} more, stable at one order or none, in results.json.", noise);
  return table;
}

Table merged_table(const std::vector<MergedMode>& merged, std::size_t records) {
  Table table{"merged_modes", ""};
  table.column({"mode", "mode", "{:.0f}"})
      .column({"f [Hz]", "frequency_hz"})
      .column({"standard deviation", "frequency_standard_deviation_hz", "{:.2g}"})
      .column({"between records", "frequency_standard_deviation_between_records_hz", "{:.2g}"})
      .column({"damping ratio [%]", "damping_ratio_percent"})
      .column({"standard deviation", "damping_ratio_standard_deviation_percent", "{:.2g}"})
      .column({"between records", "damping_ratio_standard_deviation_between_records_percent", "{:.2g}"})
      .column({"records", "records"});
  for (std::size_t m = 0; m < merged.size(); ++m) {
    const MergedValue &f = merged[m].frequency_hz, &ratio = merged[m].damping_ratio;
    table.row({static_cast<double>(m + 1), Rounded{f.mean, std::fmax(f.deviation, f.scatter)},
               known_or_nan(f.deviation), known_or_nan(f.scatter),
               Rounded{100 * ratio.mean, 100 * std::fmax(ratio.deviation, ratio.scatter)},
               known_or_nan(ratio.deviation, 100), known_or_nan(ratio.scatter, 100),
               fmt::format("{} of {}", merged[m].records(), records)});
  }
  table.note =
      "Both standard deviations are those of the mean: from the records' own, and from their spread.";
  return table;
}

void add_merged(const std::vector<RecordModes>& records, const std::vector<MergedMode>& merged,
                Results& results) {
  results.heading(fmt::format("All {} records", records.size()));
  results.table(merged_table(merged, records.size()));
  std::string differing;
  for (std::size_t m = 0; m < merged.size(); ++m) {
    const bool f = merged[m].frequency_hz.scattered, ratio = merged[m].damping_ratio.scattered;
    if (f || ratio)
      differing += fmt::format("{}{} (mode {})", differing.empty() ? "" : ", ",
                               f && ratio ? "frequency and damping ratio"
                               : f        ? "frequency"
                                          : "damping ratio",
                               m + 1);
  }
  if (!differing.empty())
    results.limitation(
        "The records differ by more than their standard deviations allow (at 5 %) in " + differing +
        ". There the standard deviation between records is the one to trust; amplitude, temperature or "
        "clamping may have changed.");
}

/// Whether no number of the record stands: exit code 3.
bool refutes(const Objection& one, const RecordModes& found) {
  return one.name == "close_modes" || one.name == "no_mode" ||
         (!found.decays && (one.name == "no_decay" || one.name == "unexplained_motion"));
}

}  // namespace

Results report(const ModalStudySettings& settings, const std::vector<RecordModes>& records) {
  Results results;
  results.command = "modal";
  const std::vector<MergedMode> merged = merge_modes(records);
  results.configuration = configuration(settings, records);
  results.values = values(records, merged);
  for (std::size_t r = 0; r < records.size(); ++r) {
    const RecordModes& found = records[r];
    const std::string suffix = records.size() > 1 ? fmt::format("_{}", r + 1) : "";
    results.heading(found.name);
    for (const Objection& one : found.record.objections) results.object(one);
    results.paragraph(introduction(settings, found));
    results.notes(found.remarks);
    if (!found.modes.empty()) results.table(mode_table(found, suffix));
    for (const Objection& one : found.objections) results.object(one, {}, refutes(one, found));
    if (Table rejected = rejected_table(found, suffix); rejected.rows() > 0)
      results.table(std::move(rejected));
    results.draw([&] { return figures(found, suffix); });
    if (const auto shapes = measured_shapes(found))
      results.attachments.push_back(
          {{"modes" + suffix + ".glb", "modes" + suffix + ".uff"},
           [shapes, suffix](const std::filesystem::path& folder) {
             write_file(folder / ("modes" + suffix + ".glb"), binary_gltf(swing_model(*shapes)));
             write_file(folder / ("modes" + suffix + ".uff"), universal_file(*shapes));
           }});
  }
  if (records.size() > 1) add_merged(records, merged, results);
  return results;
}

namespace {

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
    if (one.points.empty())
      one.reason = "damping ratio uncertain by more than 20 % in the first half of the record";
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
            : "does not change beyond its standard deviations",
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
