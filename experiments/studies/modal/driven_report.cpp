
#include "experiments/studies/modal/report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "experiments/modal/study/hammer_study.hpp"

namespace beamid::experiments {

void add_masses(const std::vector<std::string>& names, const std::vector<Record>& records,
                const std::vector<std::vector<std::complex<double>>>& rates, Results& results,
                bool coarse_reported) {
  Table table{"hammer_mass", "Mass from the hammer's impulse and the velocity step of the mode"};
  table.column({"record", "record"})
      .column({"mode", "mode", "{:.0f}"})
      .column({"f [Hz]", "frequency_hz", "{:.4g}"})
      .column({"impulse [N s]", "impulse_n_s", "{:.4g}"})
      .column({"velocity step [m/s]", "velocity_step_m_per_s", "{:.4g}"})
      .column({"mass [kg]", "mass_kg", "{:.4g}"})
      .column({"standard deviation", "mass_standard_deviation_kg", "{:.2g}"})
      .column({"remark", "remark"});
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  std::string rebounds, coarse, missing;
  std::size_t told = 0;  // record whose rebound is
  for (std::size_t r = 0; r < records.size(); ++r)
    for (std::size_t m = 0; m < rates[r].size(); ++m) {
      std::string reason;
      Pole pole{rates[r][m], {}};
      const auto found = hammer_mass(records[r], pole, rates[r], reason);
      if (!found) {
        missing += fmt::format(" Mode {} of {}: {}.", m + 1, names[r], reason);
        continue;
      }
      const bool rebounded = found->pulses_s.size() > 1;
      table.row({names[r], static_cast<double>(m + 1), pole.frequency_hz(), found->impulse,
                 found->velocity_step, found->mass, found->deviation,
                 std::string(rebounded                ? "hammer rebounded"
                             : !found->coarse.empty() ? "hit coarse"
                                                      : "")});
      json.push_back({{"record", names[r]},
                      {"mode", m + 1},
                      {"impulse_n_s", found->impulse},
                      {"velocity_step_m_per_s", found->velocity_step},
                      {"mass_kg", found->mass},
                      {"mass_standard_deviation_kg", found->deviation},
                      {"pulses_s", found->pulses_s}});
      if (coarse.empty() && !coarse_reported && !found->coarse.empty())
        coarse = names[r] + ": " + found->coarse;
      if (rebounded && std::exchange(told, r + 1) != r + 1)
        rebounds += fmt::format(
            "{}: the hammer rebounded, {} pulses within {:.3g} ms. All of them are in the impulse, but what "
            "it touches in between is no free beam: its masses are not to be trusted. ",
            names[r], found->pulses_s.size(), 1000 * (found->pulses_s.back() - found->pulses_s.front()));
    }
  if (table.rows() == 0) return;
  table.note =
      "The first motion counts, taken to be where the hammer hits. The standard deviation is that of the "
      "amplitude "
      "taken back to the hit and of the hit's sampling; calibration is not in it.";
  results.values["hammer_mass"] = std::move(json);
  results.table(std::move(table));
  if (!rebounds.empty()) results.paragraph(rebounds);
  if (!coarse.empty()) results.warning(coarse);
  if (!missing.empty()) results.paragraph("Without a mass:" + missing);
}

namespace {

using Eigen::Index, Eigen::VectorXd;
using Json = nlohmann::ordered_json;

constexpr Index most_shown = 6;  // channels in a table

const char* participation_unit(const Channel& input) {
  return input.quantity == Quantity::force ? "1/kg" : "-";
}

Table driven_mode_table(const DrivenStudy& study, const std::string& suffix) {
  const auto p = static_cast<Index>(study.outputs.size());
  const bool one_input = study.inputs.size() == 1;
  Table table{"modes" + suffix, ""};
  table.column({"mode", "mode", "{:.0f}"})
      .column({"f [Hz]", "frequency_hz"})
      .column({"standard deviation", "frequency_standard_deviation_hz", "{:.2g}"})
      .column({"damping ratio [%]", "damping_ratio_percent"})
      .column({"standard deviation", "damping_ratio_standard_deviation_percent", "{:.2g}"})
      .column({"stable at orders", "stable_orders"});
  for (Index i = 0; i < std::min(p, most_shown); ++i)
    if (one_input)
      table.column({fmt::format("participation {} [{}]", study.outputs[static_cast<std::size_t>(i)].name,
                                participation_unit(study.inputs[0])),
                    fmt::format("participation_{}", i + 1), "{:.3g}"});
    else
      table.column({fmt::format("shape {}", study.outputs[static_cast<std::size_t>(i)].name),
                    fmt::format("shape_{}", i + 1), "{:.3f}"});
  if (p > 1) table.column({"phase collinearity", "phase_collinearity", "{:.3f}"});
  for (std::size_t m = 0; m < study.modes.size(); ++m) {
    const DrivenMode& mode = study.modes[m];
    const Pole& pole = mode.pole;
    std::vector<Cell> row{static_cast<double>(m + 1),
                          Rounded{pole.frequency_hz(), pole.frequency_deviation_hz},
                          pole.frequency_deviation_hz,
                          Rounded{100 * pole.damping_ratio(), 100 * pole.damping_ratio_deviation},
                          100 * pole.damping_ratio_deviation,
                          mode.orders.empty()
                              ? std::string("its peak")
                              : fmt::format("{} of {}", mode.orders.size(), study.orders.size())};
    for (Index i = 0; i < std::min(p, most_shown); ++i) {
      const std::complex<double> part = one_input ? mode.participation[i] : pole.shape[i];
      row.emplace_back(std::copysign(std::abs(part), part.real()));
    }
    if (p > 1) row.emplace_back(phase_collinearity(pole.shape));
    table.row(std::move(row));
  }
  table.note = one_input && study.inputs[0].quantity == Quantity::force
                   ? "The participation is phi_channel phi_force / modal mass."
               : one_input
                   ? "Participation: displacement of the mode at the channel relative to the base. Over all "
                     "modes they sum to 1."
                   : "Shapes are those of the input to which a mode answers most; results.json has "
                     "the participations of all.";
  if (p > most_shown)
    table.note +=
        fmt::format(" Channels 1 to {} of {} are shown; results.json (--json) has all.", most_shown, p);
  return table;
}

Json describe(const DrivenStudy& study) {
  const auto p = static_cast<Index>(study.outputs.size());
  Json json{{"record", study.name},
            {"samples", study.record.size()},
            {"window_s", {study.record.time[0], study.record.time[study.record.size() - 1]}},
            {"band_hz", {study.band_hz.first, study.band_hz.second}},
            {"lines", study.lines.omega.size()},
            {"averages", study.responses.averages},
            {"sections", study.sections}};
  json["explained"] = study.modes.empty() ? Json(nullptr) : Json(study.explained());
  json["modes"] = Json::array();
  for (const DrivenMode& mode : study.modes) {
    Json one{{"frequency_hz", mode.pole.frequency_hz()},
             {"frequency_standard_deviation_hz", mode.pole.frequency_deviation_hz},
             {"damping_ratio", mode.pole.damping_ratio()},
             {"damping_ratio_standard_deviation", mode.pole.damping_ratio_deviation},
             {"stable_orders", mode.orders},
             {"share_of_motion", mode.share}};
    one["shape"] = Json::array();
    for (Index i = 0; i < p; ++i)
      one["shape"].push_back({{"channel", study.outputs[static_cast<std::size_t>(i)].name},
                              {"amplitude", std::abs(mode.pole.shape[i])},
                              {"phase_rad", std::arg(mode.pole.shape[i])}});
    one["participation"] = Json::array();
    for (Index j = 0; j < static_cast<Index>(study.inputs.size()); ++j)
      for (Index i = 0; i < p; ++i)
        one["participation"].push_back(
            {{"channel", study.outputs[static_cast<std::size_t>(i)].name},
             {"input", study.inputs[static_cast<std::size_t>(j)].name},
             {"unit", participation_unit(study.inputs[static_cast<std::size_t>(j)])},
             {"value", std::abs(mode.participation[i + p * j])},
             {"phase_rad", std::arg(mode.participation[i + p * j])}});
    if (p > 1) one["phase_collinearity"] = phase_collinearity(mode.pole.shape);
    json["modes"].push_back(std::move(one));
  }
  json["rejected"] = rejected_values(study.stabilisation);
  return json;
}

std::string driven_introduction(const ModalStudySettings& settings, const DrivenStudy& study) {
  const Record& record = study.record;
  std::string inputs;
  for (const Channel& input : study.inputs) inputs += (inputs.empty() ? "" : ", ") + input.name;
  std::string text = fmt::format(
      "{}: {} samples of {} channel{} from {:.4f} to {:.4f} s at {:.2f} Hz, driven by {}. Band {:.4g} to "
      "{:.4g} Hz, {} lines. Method {}, poles of the mean of {} blocks of {:.3g} s at model orders 2 to {}, "
      "then of all lines by least squares.",
      study.name, record.size(), study.outputs.size(), study.outputs.size() > 1 ? "s" : "", record.time[0],
      record.time[record.size() - 1], 1 / record.interval(), inputs, study.band_hz.first,
      study.band_hz.second, study.lines.omega.size(), settings.method.name, study.responses.averages,
      study.responses.duration, study.orders.empty() ? 0 : study.orders.back().order);
  if (!study.modes.empty())
    text += fmt::format(" The modes explain {:.3g} % of the motion.", 100.0 * study.explained());
  if (study.sections > 0)
    text +=
        fmt::format(" Standard deviations hold the scatter of {} sections of the record.", study.sections);
  return text;
}

Figure response_figure(const DrivenStudy& study, const std::string& suffix) {
  const VectorXd& f = study.responses.frequency_hz;
  const Index first = std::lower_bound(f.begin(), f.end(), study.band_hz.first) - f.begin(),
              count = std::upper_bound(f.begin(), f.end(), study.band_hz.second) - f.begin() - first;
  const auto shown = std::min<Index>(static_cast<Index>(study.outputs.size()), 3);
  Figure figure{"frequency_responses" + suffix, {}, 2, static_cast<int>(shown), 0};
  figure.width = 200 + 600 * static_cast<int>(shown);
  figure.height = 620;
  figure.caption =
      "Frequency responses to the first input, as the mean of blocks, and the modal fit of all lines; "
      "coherence.";
  for (Index o = 0; o < shown; ++o) {
    const Channel& output = study.outputs[static_cast<std::size_t>(o)];
    Panel panel{
        output.name,
        {"frequency [Hz]"},
        {fmt::format("|H| [({})/({})]", si_unit(output.quantity), si_unit(study.inputs[0].quantity)), true}};
    panel.line("H_{1}", f.segment(first, count),
               study.responses.h1.row(o).segment(first, count).cwiseAbs().transpose(), Colour::grey);
    if (!study.modes.empty())
      panel.dashed("modal fit", study.lines.omega / (2.0 * std::numbers::pi),
                   study.fit.transfer.row(o).cwiseAbs().transpose(), Colour::blue);
    figure.panels.push_back(std::move(panel));
  }
  for (Index o = 0; o < shown; ++o)
    figure.panels.push_back(Panel{"", {"frequency [Hz]"}, {"coherence"}}
                                .line("", f.segment(first, count),
                                      study.responses.coherence.row(o).segment(first, count).transpose())
                                .up(0, 1)
                                .key(Legend::none));
  return figure;
}

}  // namespace

Results report(const ModalStudySettings& settings, const std::vector<DrivenStudy>& studies) {
  Results results;
  results.command = "modal";
  results.configuration = configuration(settings, {});
  results.values["records"] = Json::array();
  results.configuration["records"] = Json::array();
  for (std::size_t r = 0; r < studies.size(); ++r) {
    const DrivenStudy& study = studies[r];
    const std::string suffix = studies.size() > 1 ? fmt::format("_{}", r + 1) : "";
    results.configuration["records"].push_back(study.name);
    results.values["records"].push_back(describe(study));
    results.heading(study.name);
    for (const Objection& one : study.objections) results.object(one);
    results.paragraph(driven_introduction(settings, study));
    results.notes(study.remarks);
    if (study.modes.empty())
      results.object(
          {"no_mode",
           "No mode: no pole was stable over enough model orders and more than the noise around it. "
           "Another --band, --window or --order may show one.",
           0.0, 1.0},
          {}, true);
    else
      results.table(driven_mode_table(study, suffix));
    results.figures.push_back(response_figure(study, suffix));
  }
  return results;
}

}  // namespace beamid::experiments
