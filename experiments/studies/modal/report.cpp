#include "experiments/studies/modal/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/modal/ambient_mode.hpp"
#include "experiments/results/file.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

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
    text += fmt::format(" The modes leave {:.2g} % of the {}.", 100 * found.left(),
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
                "Standard deviations {}. Over bound: divided by what no unbiased estimate of so long a "
                "record falls below, however little noise it has.",
                found.mode_by_mode ? "from the likelihood of each mode's band"
                                   : "from the scatter of the correlations between parts of the record");
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
      "Both deviations are those of the mean: what the records' own leave, and what their spread leaves.";
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
    results.paragraph("The records differ by more than their standard deviations allow (at 5 %) in " +
                      differing +
                      ". There the deviation between records is the one to trust; amplitude, temperature or "
                      "clamping may have changed.");
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
    for (const std::string& warning : found.record.warnings) results.warning(warning);
    results.paragraph(introduction(settings, found));
    results.notes(found.remarks);
    if (found.modes.empty())
      results.paragraph(
          found.mode_by_mode
              ? "No mode: no peak of the spectrum gave one. Another --band or --window may show one."
              : "No mode: no cluster of poles was stable over enough model orders. Another --band, --window "
                "or --order may show one.");
    else
      results.table(mode_table(found, suffix));
    for (const std::string& warning : found.warnings) results.warning(warning);
    if (Table rejected = rejected_table(found, suffix); rejected.rows() > 0)
      results.table(std::move(rejected));
    for (Figure& figure : figures(found, suffix)) results.figures.push_back(std::move(figure));
    if (const auto model = measured_shapes(found))
      results.attachments.push_back(
          {{"modes" + suffix + ".glb"}, [model, suffix](const std::filesystem::path& folder) {
             write_file(folder / ("modes" + suffix + ".glb"), binary_gltf(*model));
           }});
  }
  if (records.size() > 1) add_merged(records, merged, results);
  return results;
}

}  // namespace beamid::experiments
