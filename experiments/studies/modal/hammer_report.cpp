
#include "experiments/studies/modal/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/modal/study/hammer_study.hpp"
#include "experiments/results/gnuplot_axes.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Json = nlohmann::ordered_json;

Json known_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Table mode_table(const HammerStudy& study) {
  Table table{"modes", ""};
  table.column({"mode", "mode", "{:.0f}"})
      .column({"f [Hz]", "frequency_hz", "{:.4f}"})
      .column({"standard deviation", "frequency_standard_deviation_hz", "{:.2g}"})
      .column({"damping ratio [%]", "damping_ratio_percent", "{:.4f}"})
      .column({"standard deviation", "damping_ratio_standard_deviation_percent", "{:.2g}"})
      .column({"stable at orders", "stable_orders"});
  const bool several = study.channels.size() > 1;
  for (std::size_t o = 0; o < study.channels.size(); ++o)
    table
        .column({fmt::format("modal mass {}[kg]", several ? study.channels[o].name + " " : ""),
                 fmt::format("modal_mass_{}_kg", o + 1), "{:.4g}"})
        .column({"standard deviation", fmt::format("modal_mass_{}_standard_deviation_kg", o + 1), "{:.2g}"})
        .column({"phase [deg]", fmt::format("residue_phase_{}_deg", o + 1), "{:.1f}"});
  const bool rebounded = !study.responses.objections.empty();
  const bool coarse = !study.responses.coarse.empty();
  const bool remarks = rebounded || coarse ||
                       std::any_of(study.modes.begin(), study.modes.end(),
                                   [](const HammerMode& mode) { return mode.complex; });
  if (remarks) table.column({"remark", "remark"});
  for (std::size_t m = 0; m < study.modes.size(); ++m) {
    const HammerMode& mode = study.modes[m];
    std::vector<Cell> row{static_cast<double>(m + 1),
                          mode.pole.frequency_hz(),
                          mode.pole.frequency_deviation_hz,
                          100 * mode.pole.damping_ratio(),
                          100 * mode.pole.damping_ratio_deviation,
                          mode.orders.empty()
                              ? std::string("its peak")
                              : fmt::format("{} of {}", mode.orders.size(), study.orders.size())};
    for (std::size_t o = 0; o < mode.mass.size(); ++o)
      row.insert(row.end(), {mode.mass[o], mode.deviation[o], mode.phase[o] * 180 / 3.14159265358979});
    if (remarks)
      row.emplace_back(std::string(mode.complex ? "phase"
                                   : rebounded  ? "hits disturbed"
                                   : coarse     ? "hits coarse"
                                                : ""));
    table.row(std::move(row));
  }
  table.note =
      "The modal mass is 1 / phi^2 where the sensor sits at the point that is struck; elsewhere it is "
      "1 / (phi_sensor phi_hammer). Phases near 0 or 180 degrees belong to real modes, 180 to a sensor that "
      "points against the force. Standard deviations include neither the calibration nor damping that "
      "depends on amplitude.";
  return table;
}

Json hammer_values(const HammerStudy& study) {
  Json json{{"records", study.names},
            {"hits", study.responses.averages},
            {"block_s", study.responses.duration},
            {"window_rate_per_s", study.responses.window_rate},
            {"response_error_percent", study.modes.empty() ? Json(nullptr) : Json(100 * study.misfit)},
            {"band_hz", {study.band_hz.first, study.band_hz.second}}};
  json["modes"] = Json::array();
  for (const HammerMode& mode : study.modes) {
    Json one{{"frequency_hz", mode.pole.frequency_hz()},
             {"frequency_standard_deviation_hz", known_or_null(mode.pole.frequency_deviation_hz)},
             {"damping_ratio", mode.pole.damping_ratio()},
             {"damping_ratio_standard_deviation", known_or_null(mode.pole.damping_ratio_deviation)},
             {"stable_orders", mode.orders}};
    one["channels"] = Json::array();
    for (std::size_t o = 0; o < mode.mass.size(); ++o)
      one["channels"].push_back({{"channel", study.channels[o].name},
                                 {"modal_mass_kg", known_or_null(mode.mass[o])},
                                 {"modal_mass_standard_deviation_kg", known_or_null(mode.deviation[o])},
                                 {"residue_phase_rad", mode.phase[o]}});
    json["modes"].push_back(std::move(one));
  }
  for (std::size_t o = 0; o < study.channels.size() && !study.modes.empty() && !study.responses.masses_lost;
       ++o)
    json["residual_terms"].push_back({{"channel", study.channels[o].name},
                                      {"upper_m_per_n", study.fit.upper[static_cast<Index>(o)]},
                                      {"lower_per_kg", study.fit.lower[static_cast<Index>(o)]}});
  return json;
}

/// The phase [degrees] without jumps from line to line.
VectorXd unwrapped_degrees(const Eigen::VectorXcd& h) {
  VectorXd phase(h.size());
  double turns = 0;
  for (Index i = 0; i < h.size(); ++i) {
    const double now = std::arg(h[i]) * 180 / std::numbers::pi;
    if (i > 0) turns = 360 * std::round((phase[i - 1] - now) / 360);
    phase[i] = now + turns;
  }
  return phase;
}

/// The phase [degrees] on the turn nearest to a reference, so that +179 and -179 degrees are drawn together.
VectorXd near_degrees(const Eigen::VectorXcd& h, const VectorXd& reference) {
  VectorXd phase(h.size());
  for (Index i = 0; i < h.size(); ++i) {
    const double now = std::arg(h[i]) * 180 / std::numbers::pi;
    phase[i] = now + 360 * std::round((reference[i] - now) / 360);
  }
  return phase;
}

/// Ticks of 90 degrees, or of 360 over many turns, and an axis that ends on them.
void show_degrees(Panel& panel) {
  Extent extent;
  for (const Curve& curve : panel.curves) extent.add(curve.y, false);
  if (extent.empty()) return;
  panel.y_axis.tick = extent.high - extent.low > 900 ? 360 : 90;
  panel.up(std::floor(extent.low / 90) * 90,
           std::max(std::ceil(extent.high / 90), std::floor(extent.low / 90) + 1) * 90);
}

std::vector<Figure> hammer_figures(const HammerStudy& study) {
  const VectorXd f = study.responses.frequency_hz.segment(study.first, study.lines);
  const Index shown = std::min<Index>(static_cast<Index>(study.channels.size()), 3);
  const bool averaged = study.responses.averages > 1;
  Figure figure{"frequency_responses", {}, averaged ? 3 : 2, static_cast<int>(shown), 0};
  figure.width = 200 + 600 * static_cast<int>(shown);
  figure.height = 60 + 280 * figure.rows;
  const auto row = [&](int kind) {
    for (Index o = 0; o < shown; ++o) {
      const auto part = [&](const Eigen::MatrixXcd& h) {
        return Eigen::VectorXcd(h.row(o).segment(study.first, study.lines).transpose());
      };
      const VectorXd reference = unwrapped_degrees(part(study.responses.h1));
      const auto of = [&](const Eigen::VectorXcd& h) -> VectorXd {
        return kind == 0 ? VectorXd(h.cwiseAbs()) : near_degrees(h, reference);
      };
      const std::string unit = fmt::format("({})/N", si_unit(study.channels[o].quantity));
      Panel panel{kind == 0 ? study.channels[o].name : "",
                  {"frequency [Hz]"},
                  kind == 0   ? Axis{"|H| [" + unit + "]", true}
                  : kind == 1 ? Axis{"phase [degrees]"}
                              : Axis{"coherence"}};
      if (kind == 2) {
        panel.line("", f, study.responses.coherence.row(o).segment(study.first, study.lines).transpose())
            .up(0, 1)
            .key(Legend::none);
      } else {
        panel.line("H_{1}", f, of(part(study.responses.h1)), Colour::grey);
        if (averaged) panel.add(CurveStyle::dotted, "H_{2}", f, of(part(study.responses.h2)), Colour::orange);
        if (!study.modes.empty())
          panel.dashed("modal fit", f, of(study.fit.reproduced.row(o).transpose()), Colour::blue);
        if (kind == 1) show_degrees(panel);
        if (kind == 0) panel.legend = Legend::none;
      }
      figure.panels.push_back(std::move(panel));
    }
  };
  for (int kind = 0; kind < figure.rows; ++kind) row(kind);
  Panel diagram{"", {"frequency [Hz]"}, {"model order"}};
  add_channels(diagram, study.channels);
  add_poles(diagram, study.stabilisation.poles, Stability::unstable, "not stable");
  add_poles(diagram, study.stabilisation.poles, Stability::frequency, "stable in frequency");
  add_poles(diagram, study.stabilisation.poles, Stability::full, "stable");
  diagram.x_axis.range = study.band_hz;
  figure.caption = "Frequency responses to the hammer: magnitude, phase and coherence, with the modal fit.";
  std::vector<Figure> all{std::move(figure)};
  if (!diagram.curves.empty()) {
    all.push_back({"stabilisation", {std::move(diagram)}});
    all.back().caption = "Stabilisation diagram: poles by model order.";
  }
  return all;
}

}  // namespace

Results report(const ModalStudySettings& settings, const HammerStudy& study) {
  Results results;
  results.command = "modal";
  results.configuration = configuration(settings, {});
  results.configuration["records"] = study.names;
  results.values = hammer_values(study);
  std::string names;
  for (const std::string& name : study.names) names += (names.empty() ? "" : ", ") + name;
  results.heading(names);
  for (const auto* objections : {&study.record_objections, &study.responses.objections})
    for (const Objection& one : *objections) results.object(one);
  if (!study.responses.coarse.empty()) results.warning(study.responses.coarse, study.responses.masses_lost);
  if (study.responses.masses_lost) results.values["status"] = "contradicted";
  std::string text = fmt::format(
      "Frequency responses of {} hit{} of {:.4g} s, {}. Band {:.4g} to {:.4g} Hz, {} lines. Method {}",
      study.responses.averages, study.responses.averages > 1 ? "s" : "", study.responses.duration,
      study.estimator == "h2" ? "H2" : "H1", study.band_hz.first, study.band_hz.second, study.lines,
      settings.method.name);
  if (!study.orders.empty() && study.orders.back().order > 0)
    text += fmt::format(", model orders 2 to {}", study.orders.back().order);
  if (study.responses.window_rate > 0)
    text += fmt::format(
        ". The exponential window adds {:.4g} 1/s to every damping rate ({:.3g} % to a damping ratio at "
        "{:.4g} Hz), taken off again",
        study.responses.window_rate,
        study.modes.empty() ? 0 : 100 * study.responses.window_rate / std::abs(study.modes[0].pole.rate),
        study.modes.empty() ? 0 : study.modes[0].pole.frequency_hz());
  if (!study.modes.empty())
    text += fmt::format(". The modes do not explain {:.2g} % of the responses", 100 * study.misfit);
  results.paragraph(text + ".");
  results.notes(study.remarks);
  results.notes(study.responses.remarks);
  if (study.responses.averages == 1)
    results.paragraph("One hit: H1 and H2 are the same and the coherence is 1, whatever the noise.");
  if (study.modes.empty())
    results.object({"no_mode",
                    "No mode: no pole of the responses is stable over the model orders. Another --band or "
                    "--order may show one; force and motion of different structures or sensors show none.",
                    0.0, 1.0},
                   {}, true);
  else
    results.table(mode_table(study));
  for (const Objection& one : study.objections) results.object(one);
  results.draw([&] { return hammer_figures(study); });
  return results;
}

}  // namespace beamid::experiments
