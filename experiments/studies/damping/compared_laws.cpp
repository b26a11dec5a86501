
#include "experiments/studies/damping/report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/identify/damping_law/damping_law.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/record.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Json = nlohmann::ordered_json;

double least_bic(const DampingLawStudy& study) {
  double least = study.supported().bic;
  for (const FittedLaw& law : study.laws)
    if (law.possible) least = std::min(least, law.bic);
  return least;
}

Table law_table(const DampingLawStudy& study) {
  Table table{"damping_laws", "Damping laws"};
  table.column({"law", "law"})
      .column({"unknowns", "unknowns", "{:.0f}"})
      .column({"log-likelihood", "log_likelihood", "{:.2f}"})
      .column({"AIC above the least", "aic_above", "{:.2f}"})
      .column({"BIC above the least", "bic_above", "{:.2f}"})
      .column({"remark", "remark"});
  const double bic = least_bic(study);
  double aic = study.supported().aic;
  for (const FittedLaw& law : study.laws)
    if (law.possible) aic = std::min(aic, law.aic);
  for (const FittedLaw& law : study.laws) {
    const std::string remark = &law == &study.supported() ? (study.named ? "as specified" : "supported")
                               : law.possible             ? ""
                                                          : law.reason;
    table.row({law_title(law.name), static_cast<double>(law.unknowns), law.log_likelihood, law.aic - aic,
               law.bic - bic, remark});
  }
  table.note =
      "All laws have a cubic spring beside the linear one, and the same noise. Least: among the laws that "
      "are possible.";
  return table;
}

Table estimate_table(const DampingLawStudy& study) {
  Table table{"damping_law_parameters", "Parameters"};
  table.column({"law", "law"})
      .column({"parameter", "parameter"})
      .column({"unit", "unit"})
      .column({"estimate", "estimate", "{:.5g}"})
      .column({"95 % from", "lower_95", "{:.5g}"})
      .column({"to", "upper_95", "{:.5g}"});
  for (const FittedLaw& law : study.laws)
    for (const Estimate& e : law.estimates)
      table.row({law.name, e.name, e.unit, e.value, e.lower_95, e.upper_95});
  table.note = fmt::format(
      "Forces and stiffnesses are those of one coordinate of mass {:.4f} kg at the first sensor; a mass "
      "wrong by 1 % makes them wrong by 1 %.",
      study.supported().model.equivalent_mass);
  return table;
}

Table amplitude_table(const DampingLawStudy& study) {
  Table table{"damping_by_amplitude", "Frequency and damping ratio by amplitude"};
  table.column({"amplitude [mm]", "amplitude_mm", "{:.4g}"});
  for (const FittedLaw& law : study.laws)
    if (law.state.size() > 0) table.column({"ratio, " + law.name, "damping_ratio_" + law.name, "{:.5f}"});
  table.column({"frequency [Hz]", "frequency_hz", "{:.4f}"});
  const double ratio = study.last_amplitude / study.first_amplitude;
  for (int i = 0; i <= 4; ++i) {
    const double a = study.first_amplitude * std::pow(ratio, 0.25 * i);
    std::vector<Cell> row{1e3 * a};
    for (const FittedLaw& law : study.laws)
      if (law.state.size() > 0) row.emplace_back(law.damping_ratio(a));
    row.emplace_back(study.supported().frequency_hz(a));
    table.row(row);
  }
  table.note =
      fmt::format("Of the viscous damping that dissipates as much in a cycle. Frequency by the law {}.",
                  study.supported().name);
  return table;
}

Colour law_colour(const FittedLaw& law) {
  return law.name == "viscous"     ? Colour::blue
         : law.name == "coulomb"   ? Colour::vermillion
         : law.name == "quadratic" ? Colour::green
                                   : Colour::purple;
}

void add_sections(const DampingLawStudy& study, Panel& panel) {
  const auto count = static_cast<Index>(study.sections.size());
  VectorXd a(count), xi(count), half(count);
  for (Index i = 0; i < count; ++i) {
    const AmplitudePoint& section = study.sections[static_cast<std::size_t>(i)];
    a[i] = 1e3 * section.amplitude;
    xi[i] = 100.0 * section.damping_ratio;
    half[i] = 100.0 * quantile_95 * section.damping_ratio_deviation;
  }
  panel.bars("sections of the decay, 95 %", a, xi, xi - half, xi + half, Colour::black);
}

// One colour for each law in both panels; the law that is supported is the full line.
Figure figure(const Record& record, const DampingLawStudy& study) {
  Panel ratios{"damping ratio by amplitude", {"amplitude [mm]", true}, {"damping ratio [%]"}};
  constexpr Index points = 60;
  for (const FittedLaw& law : study.laws) {
    if (law.state.size() == 0) continue;
    VectorXd a(points), xi(points);
    for (Index i = 0; i < points; ++i) {
      const double part = static_cast<double>(i) / (points - 1);
      a[i] = study.first_amplitude * std::pow(study.last_amplitude / study.first_amplitude, part);
      xi[i] = 100.0 * law.damping_ratio(a[i]);
    }
    ratios.add(&law == &study.supported() ? CurveStyle::line : CurveStyle::dashed, law_title(law.name),
               1e3 * a, xi, law_colour(law));
  }
  if (!study.sections.empty()) add_sections(study, ratios);
  const Channel& channel = record.channels[static_cast<std::size_t>(output_channels(record)[0])];
  Panel left{"residuals of the laws", {"time [s]"}, {axis_label(channel.quantity)}};
  for (const FittedLaw* law : {&study.laws.front(), &study.supported()})
    if (law->left.size() > 0 && (left.curves.empty() || law != &study.laws.front()))
      left.line(law_title(law->name), study.time, law->left.row(0), law_colour(*law));
  Figure both{"damping_law", {ratios, left}, 2, 1};
  both.height = 720;
  both.caption =
      "Damping ratio by amplitude for each law and for sections of the decay, and the residual of the laws.";
  return both;
}

Json damping_law_values(const FittedLaw& law) {
  Json json{{"law", law.name},
            {"possible", law.possible},
            {"remark", law.reason},
            {"unknowns", law.unknowns},
            {"log_likelihood", law.log_likelihood},
            {"aic", law.aic},
            {"bic", law.bic},
            {"parameters", Json::object()}};
  for (const Estimate& e : law.estimates)
    json["parameters"][e.name] = {{"unit", e.unit},
                                  {"estimate", e.value},
                                  {"standard_deviation", e.deviation},
                                  {"lower_95", e.lower_95},
                                  {"upper_95", e.upper_95}};
  return json;
}

}  // namespace

Results report(const Experiment& experiment, const Record& record, const std::string& record_name,
               const DampingLawStudy& study) {
  Results results;
  results.command = "identify";
  results.configuration = describe(experiment);
  results.configuration["damping_law"] = study.named ? study.supported().name : "auto";
  results.values = {{"record", record_name},
                    {"samples", record.size()},
                    {"sampling_rate_hz", 1.0 / record.interval()},
                    {"samples_used", study.samples.cols()},
                    {"decimation", study.decimation},
                    {"noise", std::vector<double>(study.noise.begin(), study.noise.end())},
                    {"friction_velocity_m_per_s", study.friction_velocity},
                    {"first_amplitude_m", study.first_amplitude},
                    {"last_amplitude_m", study.last_amplitude},
                    {"supported", study.supported().name},
                    {"lack_of_fit",
                     {{"tested", study.misfit.tested},
                      {"lacks", study.misfit.lacks},
                      {"sections", study.misfit.sections},
                      {"freedom", study.misfit.freedom},
                      {"chi_square", study.misfit.chi_square},
                      {"largest_relative_damping_ratio", study.misfit.largest}}},
                    {"laws", Json::array()}};
  for (const FittedLaw& law : study.laws) results.values["laws"].push_back(damping_law_values(law));
  results.heading(experiment.title.empty() ? record_name : experiment.title);
  for (const Objection& one : study.objections) results.object(one);
  results.paragraph(
      fmt::format("{}: {} samples from {:.4f} to {:.4f} s at {:.2f} Hz; mode at {:.4f} Hz. Low-passed and "
                  "decimated by {} to {} samples for the fits.",
                  record_name, record.size(), record.time[0], record.time[record.size() - 1],
                  1.0 / record.interval(), study.modal.frequency_hz, study.decimation, study.samples.cols()));
  results.notes(study.remarks);
  if (const auto inputs = record_inputs(record)) {
    results.values["inputs_between_samples"] = to_string(inputs->path);
    results.paragraph(words(*inputs));
  }
  if (study.misfit.lacks) results.warning(law_fit_words(study));
  results.paragraph(law_verdict(study));
  if (!study.misfit.lacks) results.paragraph(law_fit_words(study));
  results.table(law_table(study));
  results.table(estimate_table(study));
  results.table(amplitude_table(study));
  const Channel& channel = record.channels[output_channels(record)[0]];
  results.paragraph(fmt::format(
      "Noise assumed of {}: {:.4g} {}, as dense as the residual of the richest law near the mode. The sign "
      "of "
      "the velocity is smoothed over {:.3g} m/s.",
      to_string(channel.quantity), study.noise[0], si_unit(channel.quantity), study.friction_velocity));
  for (const CompanionMode& mode : study.modal.companions)
    results.paragraph(
        fmt::format("Beside the mode there is another at {:.2f} Hz with {:.0f} % of its amplitude; a law of "
                    "one mode may take its beat for damping.",
                    mode.frequency_hz, 100.0 * mode.amplitude / study.modal.amplitude));
  results.figures.push_back(figure(record, study));
  return results;
}

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
    return "The records have no sections at the same amplitudes: whether one law holds for all is not "
           "determined.";
  if (!worst)
    return "One law holds: what each record shows of its damping, the others show at the same amplitudes.";
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
    for (const Objection& objection : one.study.objections)
      results.paragraph(one.name + ": " + objection.text);
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
