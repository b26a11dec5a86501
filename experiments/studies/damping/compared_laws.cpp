#include "experiments/studies/damping/compared_laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/identify/damping_law/law_sections.hpp"
#include "experiments/studies/damping/law_words.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

/// What a law says at the ends of the amplitudes that two records have in common.
std::string common_text(const DampingLawStudy& a, const DampingLawStudy& b) {
  const double from = std::min(a.first_amplitude, b.first_amplitude),
               to = std::max(a.last_amplitude, b.last_amplitude);
  if (!(from > to))
    return fmt::format("no amplitude in common ({:.3g} to {:.3g} mm, {:.3g} to {:.3g} mm)",
                       1e3 * a.first_amplitude, 1e3 * a.last_amplitude, 1e3 * b.first_amplitude,
                       1e3 * b.last_amplitude);
  return fmt::format("{:.3g} to {:.3g} mm", 1e3 * from, 1e3 * to);
}

Table record_table(const std::vector<StudiedRecord>& records) {
  Table table{"damping_law_records", "Records"};
  table.column({"record", "record"})
      .column({"law", "law"})
      .column({"from [mm]", "first_amplitude_mm", "{:.3g}"})
      .column({"to [mm]", "last_amplitude_mm", "{:.3g}"})
      .column({"ratio from", "first_damping_ratio", "{:.5f}"})
      .column({"to", "last_damping_ratio", "{:.5f}"})
      .column({"fits", "fits"});
  for (const StudiedRecord& one : records) {
    const DampingLawStudy& study = one.study;
    const FittedLaw& law = study.supported();
    table.row({one.name, law.name, 1e3 * study.first_amplitude, 1e3 * study.last_amplitude,
               law.damping_ratio(study.first_amplitude), law.damping_ratio(study.last_amplitude),
               std::string(!study.misfit.tested ? "not tested"
                           : study.misfit.lacks ? "lack of fit"
                                                : "yes")});
  }
  return table;
}

Table compared_table(const std::vector<StudiedRecord>& records, const std::vector<ComparedLaw>& compared) {
  Table table{"compared_laws", "Every law against the other records, at amplitudes that both show"};
  table.column({"law of", "law_of"})
      .column({"record", "record"})
      .column({"amplitudes", "amplitudes"})
      .column({"ratio off by [%]", "damping_ratio_off_percent", "{:+.2g}"})
      .column({"chi^2", "chi_square", "{:.3g}"})
      .column({"of", "freedom", "{:.0f}"})
      .column({"holds", "holds"});
  for (const ComparedLaw& one : compared) {
    const StudiedRecord &law = records[one.law], &other = records[one.sections];
    table.row({law.name, other.name, common_text(law.study, other.study),
               one.misfit.tested ? 100 * one.misfit.largest : std::nan(""), one.misfit.chi_square,
               static_cast<double>(one.misfit.freedom),
               std::string(!one.misfit.tested ? "not tested"
                           : one.misfit.lacks ? "no"
                                              : "yes")});
  }
  return table;
}

std::string conclusion(const std::vector<StudiedRecord>& records, const std::vector<ComparedLaw>& compared) {
  const ComparedLaw* worst = nullptr;
  bool tested = false;
  for (const ComparedLaw& one : compared) {
    tested = tested || one.misfit.tested;
    if (one.misfit.lacks && (!worst || std::abs(one.misfit.largest) > std::abs(worst->misfit.largest)))
      worst = &one;
  }
  if (!tested)
    return "The records have no sections at the same amplitudes: nothing says whether one law holds for all.";
  if (!worst)
    return "One law holds: what each record says of its damping, the others show at the same amplitudes.";
  return fmt::format(
      "The records disagree at the same amplitude: the law of {} is {:+.2g} % off in {} at {:.3g} mm. "
      "Damping is not a function of amplitude alone here; temperature, clamping or time have changed it, "
      "and no law of one record is that of the beam.",
      records[worst->law].name, 100 * worst->misfit.largest, records[worst->sections].name,
      1e3 * worst->misfit.at_amplitude);
}

}  // namespace

std::vector<ComparedLaw> compared_laws(const std::vector<StudiedRecord>& records) {
  std::vector<ComparedLaw> compared;
  for (std::size_t a = 0; a < records.size(); ++a)
    for (std::size_t b = 0; b < records.size(); ++b) {
      const DampingLawStudy &law = records[a].study, &other = records[b].study;
      if (a == b || law.sections.empty()) continue;
      const AmplitudePoint& like = law.sections.front();
      std::vector<AmplitudePoint> common;
      for (AmplitudePoint section : other.sections) {
        if (section.amplitude > law.first_amplitude || section.amplitude < law.last_amplitude) continue;
        const double share = like.amplitude / section.amplitude;
        section.damping_ratio_deviation =
            std::hypot(section.damping_ratio_deviation, share * like.damping_ratio_deviation);
        section.frequency_deviation_hz =
            std::hypot(section.frequency_deviation_hz, share * like.frequency_deviation_hz);
        common.push_back(section);
      }
      compared.push_back({a, b, misfit_of(law.supported(), common, 0)});
    }
  return compared;
}

Results report(const Experiment& experiment, const std::vector<StudiedRecord>& records) {
  const std::vector<ComparedLaw> compared = compared_laws(records);
  Results results;
  Json values = Json::array();
  for (std::size_t r = 0; r < records.size(); ++r) {
    Results one = report(experiment, records[r].record, records[r].name, records[r].study);
    if (r == 0) results.configuration = one.configuration;
    values.push_back(one.values);
    for (Figure& figure : one.figures) {
      figure.name += fmt::format("_{}", r + 1);
      results.figures.push_back(std::move(figure));
    }
  }
  results.command = "identify";
  results.heading(experiment.title.empty() ? "Damping law of several records" : experiment.title);
  for (const StudiedRecord& one : records)
    for (const std::string& warning : one.study.warnings) results.paragraph(one.name + ": " + warning);
  results.paragraph(conclusion(records, compared));
  for (const StudiedRecord& one : records) results.paragraph(one.name + ": " + law_words(one.study));
  results.table(record_table(records));
  results.table(compared_table(records, compared));
  results.values = {{"records", values}, {"compared_laws", Json::array()}};
  for (const ComparedLaw& one : compared)
    results.values["compared_laws"].push_back({{"law_of", records[one.law].name},
                                               {"record", records[one.sections].name},
                                               {"tested", one.misfit.tested},
                                               {"holds", one.misfit.tested && !one.misfit.lacks},
                                               {"chi_square", one.misfit.chi_square},
                                               {"freedom", one.misfit.freedom},
                                               {"largest_relative_damping_ratio", one.misfit.largest}});
  return results;
}

}  // namespace beamid::experiments
