#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "experiments/record/record.hpp"
#include "experiments/studies/efficiency/laboratory_records.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array outcomes{LaboratoryOutcome::right, LaboratoryOutcome::refused,
                              LaboratoryOutcome::unexplained, LaboratoryOutcome::wrong};

std::string kinds_text(const LaboratoryTest& test) {
  std::string text;
  for (const LaboratoryKind kind : test.kinds)
    text += (text.empty() ? "" : ", ") + std::string(to_string(kind));
  return text;
}

double count(const LaboratoryRecords& all, LaboratoryOutcome outcome) {
  return static_cast<double>(std::count_if(
      all.tests.begin(), all.tests.end(), [&](const IdentifiedTest& one) { return one.outcome == outcome; }));
}

Table kind_table(const LaboratoryRecords& all) {
  Table table{"kinds", "What came out of records with only the beam specified"};
  table.column({"first kind", "first_kind"}).column({"records", "records", "{:.0f}"});
  for (const LaboratoryOutcome outcome : outcomes)
    table.column({to_string(outcome), to_string(outcome), "{:.0f}"});
  for (int k = 0; k < laboratory_kinds; ++k) {
    const auto kind = static_cast<LaboratoryKind>(k);
    std::array<double, outcomes.size()> counts{};
    double records = 0;
    for (const IdentifiedTest& one : all.tests) {
      if (one.test.kinds[0] != kind) continue;
      ++records;
      ++counts[static_cast<std::size_t>(one.outcome)];
    }
    if (records > 0) table.row({to_string(kind), records, counts[0], counts[1], counts[2], counts[3]});
  }
  table.row({"all", static_cast<double>(all.tests.size()), count(all, outcomes[0]), count(all, outcomes[1]),
             count(all, outcomes[2]), count(all, outcomes[3])});
  table.note =
      "right: frequency within 0.5 % or 1.5 half widths of its interval (5 % at most), damping ratio within "
      "15 % or 1.5 half widths (itself at most) of what it was over the window. refused: no number, or one "
      "that is off under a first line that names the cause. unexplained: the same without the cause. wrong: "
      "off, without any remark.";
  return table;
}

double percent_off(double found, double truth) {
  return 100 * (found / truth - 1);
}

double or_nan(const IdentifiedTest& one, double value) {
  return one.identified ? value : std::nan("");
}

std::string sentence_beginning(const std::string& text, std::size_t most) {
  return text.size() <= most ? text : fmt::format("{:.{}}...", text, most);
}

Table record_table(const LaboratoryRecords& all, bool every) {
  constexpr std::size_t most = 160;
  Table table{every ? "all_records" : "not_right", every ? "" : "Records that did not come out right"};
  table.column({"no.", "number", "{:.0f}"})
      .column({"kinds", "kinds"})
      .column({"outcome", "outcome"})
      .column({"f [Hz]", "frequency_hz", "{:.4g}"})
      .column({"off [%]", "frequency_error_percent", "{:+.3f}"})
      .column({"+- [%]", "frequency_half_width_percent", "{:.3f}"})
      .column({"xi [%]", "least_damping_percent", "{:.3f}"})
      .column({"to", "greatest_damping_percent", "{:.3f}"})
      .column({"found", "damping_percent", "{:.3f}"})
      .column({"+-", "damping_half_width_percent", "{:.3f}"})
      .column({"reported", "said"});
  for (const IdentifiedTest& one : all.tests) {
    if (!every && one.outcome == LaboratoryOutcome::right) continue;
    const double f = one.test.frequency_hz;
    table.row({static_cast<double>(one.test.number), kinds_text(one.test), to_string(one.outcome), f,
               or_nan(one, percent_off(one.frequency.estimate, f)),
               or_nan(one, 100 * one.frequency.half_width / f), or_nan(one, 100 * one.least_damping),
               or_nan(one, 100 * one.greatest_damping), or_nan(one, 100 * one.ratio.estimate),
               or_nan(one, 100 * one.ratio.half_width),
               every ? one.said : sentence_beginning(one.said, most)});
  }
  return table;
}

/// How often the plain 95 % intervals hold the truth, of records with numbers and one damping ratio.
std::string coverage_text(const LaboratoryRecords& all) {
  int records = 0, frequency = 0, ratio = 0;
  for (const IdentifiedTest& one : all.tests) {
    if (!one.identified || one.outcome != LaboratoryOutcome::right || one.test.damping_per_metre > 0)
      continue;
    ++records;
    frequency += std::abs(one.frequency.estimate - one.test.frequency_hz) <= one.frequency.half_width;
    ratio += std::abs(one.ratio.estimate - one.test.least_damping) <= one.ratio.half_width;
  }
  return fmt::format(
      "Of the {} right ones whose damping does not depend on amplitude the 95 % interval holds the frequency "
      "in {} and the damping ratio in {}.",
      records, frequency, ratio);
}

Json value_of(const IdentifiedTest& one) {
  Json json{{"number", one.test.number}, {"kinds", Json::array()}, {"outcome", to_string(one.outcome)}};
  for (const LaboratoryKind kind : one.test.kinds) json["kinds"].push_back(to_string(kind));
  json["true_frequency_hz"] = one.test.frequency_hz;
  if (one.identified) {
    json["window_s"] = {one.from, one.to};
    json["true_damping_ratio"] = {one.least_damping, one.greatest_damping};
    json["frequency_hz"] = {{"estimate", one.frequency.estimate},
                            {"half_width_95", one.frequency.half_width}};
    json["damping_ratio"] = {{"estimate", one.ratio.estimate}, {"half_width_95", one.ratio.half_width}};
  }
  json["said"] = one.said;
  return json;
}

Attachment text_file(const std::string& name, const std::string& text) {
  return {{name},
          [name, text](const std::filesystem::path& folder) { std::ofstream(folder / name) << text; }};
}

}  // namespace

Results report(const LaboratoryRecords& all) {
  Results results;
  results.command = "efficiency";
  results.seed = all.settings.seed;
  results.configuration = {{"study", "records"}, {"records", all.settings.records}};
  for (const LaboratoryOutcome outcome : outcomes)
    results.values[to_string(outcome)] = static_cast<int>(count(all, outcome));
  results.values["records"] = Json::array();
  for (const IdentifiedTest& one : all.tests) results.values["records"].push_back(value_of(one));
  results.heading("With only the beam specified");
  results.paragraph(fmt::format(
      "{} simulated laboratory records: cantilevers of 0.25 to 1.2 m with tip masses, released, hit or let "
      "go by hand, damping ratio 0.2 to 2 %, 50 to 2000 Hz, noise of 0.05 to 2 % of the first mode, what "
      "cheap sensors do on top. Each written to a file and identified as `beamid identify` does with an "
      "experiment file that specifies only the beam, whose stiffness there is up to 12 % wrong.",
      all.settings.records));
  results.table(kind_table(all));
  results.paragraph(coverage_text(all));
  if (const Table table = record_table(all, false); table.rows() > 0) results.table(table);
  results.paragraph("One of them, with its files: beamid efficiency --study records --only NUMBER --out DIR");
  results.attachments.push_back(text_file("all_records.csv", to_csv(record_table(all, true))));
  return results;
}

Results examine(const LaboratorySettings& settings, int number) {
  if (number < 0 || number >= settings.records)
    throw std::invalid_argument(
        fmt::format("record {}; expected one from 0 to {}", number, settings.records - 1));
  const LaboratoryIdentification one = identify_laboratory_test(laboratory_test(settings.seed, number));
  const IdentifiedTest& found = one.found;
  Results results = one.results;
  results.command = "efficiency";
  results.seed = settings.seed;
  results.configuration = {{"study", "records"}, {"only", number}};
  results.values = value_of(found);
  results.heading(fmt::format("Record {} of seed {}: {}", number, settings.seed, to_string(found.outcome)));
  std::string text =
      fmt::format("Kinds: {}. First mode at {:.5g} Hz", kinds_text(found.test), found.test.frequency_hz);
  text += found.identified
              ? fmt::format(", damping ratio {:.4g} to {:.4g} % from {:.4g} to {:.4g} s.",
                            100 * found.least_damping, 100 * found.greatest_damping, found.from, found.to)
              : fmt::format(", damping ratio from {:.4g} %.", 100 * found.test.least_damping);
  results.paragraph(text);
  if (!found.said.empty()) results.paragraph("Reported: " + found.said);
  results.attachments.push_back(text_file("rig.toml", found.test.rig));
  results.attachments.push_back(text_file("beam.toml", found.test.beam));
  results.attachments.push_back(
      {{"record.csv"}, [record = one.record.record](const std::filesystem::path& folder) {
         write_record(record, folder / "record.csv");
       }});
  return results;
}

}  // namespace beamid::experiments
