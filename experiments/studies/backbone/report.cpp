#include "experiments/studies/backbone/report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "experiments/identify/backbone/secant_curve.hpp"
#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;
using std::numbers::pi;

Table window_table(const BackboneStudy& study) {
  Table table{"windows", "Windows of falling amplitude"};
  table.column({"from [s]", "from_s", "{:.3f}"})
      .column({"to [s]", "to_s", "{:.3f}"})
      .column({"amplitude [mm]", "amplitude_mm", "{:.4g}"})
      .column({"f [Hz]", "frequency_hz", "{:.4f}"})
      .column({"K [N/m]", "stiffness_n_per_m", "{:.5g}"})
      .column({"+- ", "stiffness_half_interval_n_per_m", "{:.2g}"})
      .column({"C [N s/m]", "damping_n_s_per_m", "{:.4g}"})
      .column({"+-", "damping_half_interval_n_s_per_m", "{:.2g}"})
      .column({"damping ratio [%]", "damping_ratio_percent", "{:.3f}"});
  for (const AmplitudeWindow& w : study.windows.windows)
    table.row({w.from, w.to, 1e3 * w.amplitude, w.frequency_hz, w.stiffness,
               quantile_95 * w.stiffness_deviation, w.damping, quantile_95 * w.damping_deviation,
               100 * w.damping_ratio});
  table.note =
      "By the linear joint filter in each; +- are half 95 % intervals. Amplitudes are largest displacements.";
  return table;
}

/// What the backbone is, for notes and results.json.
std::string backbone_source(const BackboneStudy& study) {
  return study.law() ? "record, " + study.law()->name : "windows, elastic";
}

Table backbone_table(const BackboneStudy& study) {
  Table table{"backbone", "Backbone"};
  table.column({"x [mm]", "displacement_mm", "{:.4g}"})
      .column({"F [N]", "force_n", "{:.5g}"})
      .column({"95 % from", "force_lower_95_n", "{:.5g}"})
      .column({"to", "force_upper_95_n", "{:.5g}"})
      .column({"F/x [N/m]", "secant_n_per_m", "{:.5g}"})
      .column({"secants [%]", "secants_over_percent", "{:+.2f}"})
      .column({"windows [%]", "inversion_over_percent", "{:+.2f}"})
      .column({"G/Gmax", "normalised_stiffness", "{:.4f}"});
  constexpr int rows = 10;
  const double low = study.smallest(), high = study.largest(), k0 = study.first_stiffness();
  const ForceLaw& windows = study.loop == LoopKind::masing ? study.masing : study.elastic;
  for (int i = 0; i <= rows; ++i) {
    const double x = low * std::pow(high / low, static_cast<double>(i) / rows),
                 secant = study.backbone.secant(x),
                 half = quantile_95 * x * study.backbone.secant_deviation(x);
    const bool seen = x <= study.windows.first_amplitude;
    table.row({1e3 * x, secant * x, secant * x - half, secant * x + half, secant,
               seen ? 100 * (study.secants.secant(x) / secant - 1) : std::nan(""),
               seen ? 100 * (windows.secant(x) / secant - 1) : std::nan(""), secant / k0});
  }
  table.note = fmt::format(
      "F by {}. Secants: what K(A) A, taken for the curve, is off; windows: their describing function "
      "inverted. G/Gmax: F/x over {:.5g} N/m, its value at {}.",
      study.law() ? "the whole record" : "the windows", k0, study.first_place());
  return table;
}

std::string model_remark(const RecordFits& record, std::size_t i) {
  const RecordFit& fit = record.fits[i];
  if (!fit.converged) return fit.reason.empty() ? "not determined by the record" : fit.reason;
  std::string text = static_cast<int>(i) == record.best ? "least BIC" : "";
  if (fit.name == "between")
    text += fmt::format("{}mu {:.3f} +- {:.3f}", text.empty() ? "" : ", ", fit.masing,
                        quantile_95 * fit.masing_deviation);
  return text;
}

Table model_table(const RecordFits& record) {
  Table table{"models", "Models of the whole record"};
  table.column({"model", "model"})
      .column({"unknowns", "unknowns", "{:.0f}"})
      .column({"log-likelihood", "log_likelihood", "{:.2f}"})
      .column({"BIC above the least", "bic_above", "{:.2f}"})
      .column({"residual [%]", "left_percent", "{:.3g}"})
      .column({"remark", "remark"});
  const double least = record.best >= 0 ? record.fits[static_cast<std::size_t>(record.best)].bic : 0;
  for (std::size_t i = 0; i < record.fits.size(); ++i) {
    const RecordFit& fit = record.fits[i];
    const bool any = fit.residuals.size() > 0;
    table.row({fit.name, static_cast<double>(fit.unknowns), fit.converged ? fit.log_likelihood : std::nan(""),
               fit.converged ? fit.bic - least : std::nan(""), any ? 100 * fit.left : std::nan(""),
               model_remark(record, i)});
  }
  table.note = fmt::format(
      "Gaussian output-error likelihood, all samples at once, no prior, one noise of {:.3g} (SI) for all: "
      "the residual of the best of them. Elastic, masing and between have a spring of any shape: mu is the "
      "part "
      "of it that is Masing's loop.",
      record.noise);
  return table;
}

Table loop_table(const BackboneStudy& study, double mass) {
  Table table{"energy", "Energy of a cycle"};
  table.column({"amplitude [mm]", "amplitude_mm", "{:.4g}"})
      .column({"windows [J]", "energy_j", "{:.4g}"})
      .column({"+-", "energy_half_interval_j", "{:.2g}"})
      .column({"law [J]", "law_energy_j", "{:.4g}"})
      .column({"if Masing [J]", "masing_energy_j", "{:.4g}"})
      .column({"windows' D [%]", "damping_ratio_of_windows_percent", "{:.3f}"})
      .column({"D of the law [%]", "damping_ratio_of_law_percent", "{:.3f}"});
  for (const AmplitudeWindow& w : study.windows.windows) {
    const double omega = 2 * pi * w.frequency_hz, ratio = w.fall / omega,
                 half = quantile_95 * w.damping_deviation / (2 * mass * omega),
                 elastic = 2 * pi * w.amplitude * study.backbone.force(w.amplitude),
                 law = study.energy(w.amplitude, omega);
    table.row({1e3 * w.amplitude, elastic * ratio, elastic * half, law,
               masing_energy(study.backbone.curve, w.amplitude).dot(study.backbone.coefficients), 100 * ratio,
               100 * law / elastic});
  }
  table.note =
      "Windows: what the backbone's energy loses while the amplitude falls. If Masing: the loop of the "
      "backbone alone, without viscous damping. D: energy over 2 pi F(A) A.";
  return table;
}

Json backbone_values(const BackboneSettings& settings, const Record& record, const std::string& name,
                     const BackboneStudy& study) {
  Json json{
      {"record", name},
      {"samples", record.size()},
      {"sampling_rate_hz", 1 / record.interval()},
      {"mass_kg", settings.windows.mass},
      {"mass_known", settings.mass_known},
      {"verdict", backbone_verdict(study)},
      {"spring", to_string(study.spring)},
      {"loop", to_string(study.loop)},
      {"relative_change_of_stiffness", study.change},
      {"relative_change_of_stiffness_standard_deviation", study.change_deviation},
      {"first_amplitude_m", study.windows.first_amplitude},
      {"last_amplitude_m", study.windows.last_amplitude},
      {"windows_count", study.windows.windows.size()},
      {"windows_ended", study.windows.ended},
      {"noise_si", study.windows.noise},
      {"first_stiffness_n_per_m", study.first_stiffness()},
      {"largest_displacement_m", study.largest()},
      {"backbone_by", backbone_source(study)},
      {"best_model",
       study.record.best >= 0 ? study.record.fits[static_cast<std::size_t>(study.record.best)].name : ""},
      {"residual_variance_ratio", study.record.lack},
      {"spline_terms", study.backbone.curve.terms()}};
  if (const RecordFit* const between = study.record.find("between")) {
    json["masing_part"] = between->masing;
    json["masing_part_standard_deviation"] = between->masing_deviation;
  }
  if (std::isfinite(study.linear_bic())) json["bic_of_linear_above_law"] = study.linear_bic();
  return json;
}

}  // namespace

Results report(const BackboneSettings& settings, const Record& record, const std::string& record_name,
               const BackboneStudy& study) {
  Results results;
  results.command = "backbone";
  results.configuration = {{"amplitude_ratio", settings.windows.amplitude_ratio},
                           {"fewest_cycles", settings.windows.fewest_cycles},
                           {"mass_kg", settings.windows.mass},
                           {"linear", settings.linear}};
  results.values = backbone_values(settings, record, record_name, study);
  const bool determined = study.spring != SpringKind::not_determined;
  if (determined && study.objections.empty())
    results.paragraph(backbone_verdict(study));
  else
    results.warning(backbone_verdict(study), !determined);
  for (const Objection& one : study.objections) results.object(one, {}, one.name == "close_modes");
  // A loop that is determined says itself what a cycle dissipates.
  if (study.loop != LoopKind::masing && study.loop != LoopKind::between)
    if (const std::string text =
            damping_trend_text(damping_trend(study.windows.windows), study.windows.windows);
        !text.empty())
      results.warning(text);
  if (!settings.mass_known)
    results.paragraph("No mass is given: forces, stiffnesses and dampings are those of 1 kg (--mass).");
  const double rate = 1 / record.interval();
  results.paragraph(
      fmt::format("{}: {} samples from {:.4f} to {:.4f} s, {} windows, after which {}. Sampled at {:.4g} Hz "
                  "for the windows and {:.4g} Hz for the whole record, of {:.4g} Hz.",
                  record_name, record.size(), record.time[0], record.time[record.size() - 1],
                  study.windows.windows.size(), study.windows.ended, rate / study.windows.decimation,
                  rate / study.record.decimation, rate));
  results.table(window_table(study));
  if (determined && study.spring != SpringKind::linear) {
    results.table(backbone_table(study));
    results.table(loop_table(study, settings.windows.mass));
  }
  if (!study.record.fits.empty()) results.table(model_table(study.record));
  results.figures.push_back(backbone_figure(study, settings.windows.mass));
  return results;
}

namespace {

using Eigen::Index, Eigen::VectorXd;
using std::numbers::pi;

template <typename Value>
VectorXd by_window(const BackboneStudy& study, const Value& value) {
  const auto& windows = study.windows.windows;
  VectorXd values(static_cast<Index>(windows.size()));
  for (Index i = 0; i < values.size(); ++i) values[i] = value(windows[static_cast<std::size_t>(i)]);
  return values;
}

}  // namespace

Figure backbone_figure(const BackboneStudy& study, double mass) {
  const VectorXd a = by_window(study, [](const auto&w) { return w.amplitude; }),
                 k = by_window(study, [](const auto&w) { return w.stiffness; }),
                 kd = by_window(study, [](const auto&w) { return quantile_95 * w.stiffness_deviation; }),
                 c = by_window(study, [](const auto&w) { return w.damping; }),
                 cd = by_window(study, [](const auto&w) { return quantile_95 * w.damping_deviation; });
  Panel stiffness{"stiffness of the windows", {"amplitude [mm]", true}, {"K(A) [N/m]"}};
  stiffness.bars("joint filter, 95 %", 1e3 * a, k, k - kd, k + kd, Colour::black);
  Panel damping{"damping of the windows", {"amplitude [mm]", true}, {"C(A) [N s/m]"}};
  damping.bars("joint filter, 95 %", 1e3 * a, c, c - cd, c + cd, Colour::black);
  constexpr Index points = 80;
  const double low = study.smallest(), high = study.largest(), k0 = study.first_stiffness();
  VectorXd x(points), force(points), half(points), naive(points), secant(points), energy(points);
  for (Index i = 0; i < points; ++i) {
    x[i] = low * std::pow(high / low, static_cast<double>(i) / (points - 1));
    secant[i] = study.backbone.secant(x[i]);
    force[i] = study.backbone.force(x[i]);
    half[i] = quantile_95 * x[i] * study.backbone.secant_deviation(x[i]);
    naive[i] = x[i] <= study.windows.first_amplitude ? x[i] * study.secants.secant(x[i]) : std::nan("");
    const double omega = std::sqrt(std::max(study.secants.secant(x[i]), 0.1 * secant[i]) / mass);
    energy[i] = study.energy(x[i], omega) / (2 * pi * x[i] * force[i]);
  }
  stiffness.line("F/x of the backbone", 1e3 * x, secant, Colour::blue);
  Panel backbone{"backbone", {"displacement [mm]"}, {"force [N]"}};
  backbone.band("95 %", 1e3 * x, force - half, force + half, Colour::blue)
      .line("backbone", 1e3 * x, force, Colour::blue)
      .dashed("secants K(A) A", 1e3 * x, naive, Colour::vermillion);
  Panel normalised{
      "stiffness over its value at " + study.first_place(), {"amplitude [mm]", true}, {"G/Gmax"}};
  normalised.line("backbone", 1e3 * x, secant / k0, Colour::blue);
  Panel ratios{"energy of a cycle over 2 pi F(A) A", {"amplitude [mm]", true}, {"D [%]"}};
  if (study.law()) ratios.line("law", 1e3 * x, 100 * energy, Colour::blue);
  VectorXd ratio(a.size()), half_ratio(a.size());
  for (Index i = 0; i < a.size(); ++i) {
    const AmplitudeWindow& window = study.windows.windows[static_cast<std::size_t>(i)];
    const double omega = 2 * pi * window.frequency_hz;
    ratio[i] = 100 * window.fall / omega;
    half_ratio[i] = 100 * cd[i] / (2 * mass * omega);
  }
  ratios.bars("windows, 95 %", 1e3 * a, ratio, ratio - half_ratio, ratio + half_ratio, Colour::black);
  Figure figure{"force_law", {stiffness, damping, backbone, normalised, ratios}, 3, 2};
  figure.width = 1100;
  figure.height = 1250;
  figure.caption =
      "Stiffness and damping of the windows by amplitude, the backbone with its 95 % band beside the "
      "secants, and what soil dynamics calls G/Gmax and D.";
  return figure;
}

}  // namespace beamid::experiments
