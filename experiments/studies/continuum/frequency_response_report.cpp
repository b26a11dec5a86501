#include "experiments/studies/continuum/frequency_response_report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "experiments/config/description.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/results/file.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Json = nlohmann::ordered_json;
constexpr double degrees_per_radian = 180.0 / std::numbers::pi;

Table resonance_table(const Experiment& experiment, const FrequencyResponses& found) {
  const auto kind = experiment.frequency_response.kind;
  Table table{"resonances", ""};
  table.column({"pair", "pair"})
      .column({"what", "what"})
      .column({"f [Hz]", "frequency_hz", "{:.8g}"})
      .column({fmt::format("magnitude [{}]", unit_of(kind)), std::string("magnitude_") + suffix_of(kind),
               "{:.6g}"})
      .column({"phase [deg]", "phase_deg", "{:.2f}"});
  for (const PairResponse& pair : found.pairs)
    for (const Extremum& extremum : pair.extrema) {
      const bool finite = std::isfinite(std::abs(extremum.response));
      table.row({pair.name, to_string(extremum.kind), extremum.frequency_hz,
                 finite ? std::abs(extremum.response) : std::nan(""),
                 finite ? degrees_per_radian * std::arg(extremum.response) : std::nan("")});
    }
  return table;
}

std::string column_name(const std::string& pair) {
  std::string name;
  for (const char letter : pair) {
    const bool plain = std::isalnum(static_cast<unsigned char>(letter)) != 0;
    if (plain)
      name += letter;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  return name;
}

// Every frequency and every pair: real and imaginary part, magnitude, phase.
Table response_table(const Experiment& experiment, const FrequencyResponses& found) {
  const std::string unit = suffix_of(experiment.frequency_response.kind);
  Table table{"frf", ""};
  const auto add = [&](const std::string& key, const VectorXd& frequency_response_values) {
    Column column{key, key};
    column.cells.assign(frequency_response_values.begin(), frequency_response_values.end());
    table.column(std::move(column));
  };
  add("frequency_hz", found.frequency_hz);
  for (const PairResponse& pair : found.pairs) {
    const std::string name = found.pairs.size() == 1 ? "" : column_name(pair.name) + "_";
    add(name + "real_" + unit, pair.response.real());
    add(name + "imaginary_" + unit, pair.response.imag());
    add(name + "magnitude_" + unit, pair.response.cwiseAbs());
    add(name + "phase_rad", pair.response.cwiseArg().real());
  }
  return table;
}

// "x0.55m to tip" as "0.55 m to tip".
std::string readable_pair(std::string pair) {
  for (std::size_t at = pair.find('x'); at != std::string::npos; at = pair.find('x', at + 1)) {
    const std::size_t end = pair.find_first_not_of("0123456789.", at + 1);
    if ((at > 0 && pair[at - 1] != ' ') || end == std::string::npos || end == at + 1 || pair[end] != 'm')
      continue;
    pair.insert(end, " ").erase(at, 1);
  }
  return pair;
}

Figure response_figure(const Experiment& experiment, const FrequencyResponses& found) {
  const auto& settings = experiment.frequency_response;
  const double from = found.frequency_hz[0], to = found.frequency_hz[found.frequency_hz.size() - 1];
  const Axis frequency{"frequency [Hz]", settings.logarithmic, std::pair{from, to}};
  Panel magnitude{
      "", frequency, {fmt::format("{} [{}]", to_string(settings.kind), unit_of(settings.kind)), true}};
  Panel phase{"", frequency, {"phase [deg]", false, std::pair{-185.0, 185.0}, 90.0}};
  magnitude.legend = Legend::none;
  if (found.pairs.size() == 1) phase.legend = Legend::none;
  for (const PairResponse& pair : found.pairs) {
    magnitude.line(readable_pair(pair.name), found.frequency_hz, pair.response.cwiseAbs());
    phase.line(readable_pair(pair.name), found.frequency_hz,
               degrees_per_radian * pair.response.cwiseArg().real());
  }
  Figure figure{"frf_plot", {magnitude, phase}, 2, 1};
  figure.caption = fmt::format("Magnitude and phase of the {}.", to_string(settings.kind));
  return figure;
}

Json frequency_response_values(const Experiment& experiment, const FrequencyResponses& found) {
  const std::string unit = std::string("_") + suffix_of(experiment.frequency_response.kind);
  Json json{{"kind", to_string(experiment.frequency_response.kind)},
            {"method", found.method.name},
            {"points", found.frequency_hz.size()},
            {"from_hz", found.frequency_hz[0]},
            {"to_hz", found.frequency_hz[found.frequency_hz.size() - 1]},
            {"elements", found.system.mesh.elements.size()},
            {"degrees_of_freedom", found.system.size()},
            {"natural_frequencies_hz",
             std::vector<double>(found.natural_frequencies_hz.begin(), found.natural_frequencies_hz.end())},
            {"pairs", Json::array()}};
  for (const PairResponse& pair : found.pairs) {
    Json one{
        {"name", pair.name},           {"input_m", pair.input.position},   {"output_m", pair.output.position},
        {"resonances", Json::array()}, {"anti_resonances", Json::array()}, {"minima", Json::array()}};
    for (const Extremum& extremum : pair.extrema) {
      const char* const list = extremum.kind == Extremum::Kind::resonance        ? "resonances"
                               : extremum.kind == Extremum::Kind::anti_resonance ? "anti_resonances"
                                                                                 : "minima";
      one[list].push_back(
          {{"frequency_hz", extremum.frequency_hz},
           {"magnitude" + unit, number_or_null(std::abs(extremum.response))},
           {"phase_rad", number_or_null(std::abs(extremum.response) < INFINITY ? std::arg(extremum.response)
                                                                               : std::nan(""))}});
    }
    json["pairs"].push_back(std::move(one));
  }
  return json;
}

}  // namespace

Results report(const Experiment& experiment, const FrequencyResponses& found) {
  const auto& settings = experiment.frequency_response;
  Results results;
  results.command = "frf";
  results.configuration = describe(experiment, {"frequency_response"});
  results.configuration["frequency_response"].update(
      {{"from_hz", found.frequency_hz[0]},
       {"to_hz", found.frequency_hz[found.frequency_hz.size() - 1]},
       {"method", found.method.name},
       {"modes", found.method.modes}});
  results.values = frequency_response_values(experiment, found);
  results.heading(experiment.title.empty() ? "Frequency response" : experiment.title);
  results.paragraph(structure_text(experiment, static_cast<Eigen::Index>(found.system.mesh.elements.size()),
                                   found.system.size()));
  results.paragraph(fmt::format("{} at {} frequencies from {:.6g} to {:.6g} Hz, {}. Damping: {}.",
                                to_string(settings.kind), settings.points, found.frequency_hz[0],
                                found.frequency_hz[found.frequency_hz.size() - 1], found.method.name,
                                damping_text(experiment.damping, found.system)));
  for (const std::string& warning : found.warnings) results.warning(warning);
  results.table(resonance_table(experiment, found));
  results.notes(found.notes);
  results.attachments.push_back(
      {{"frf.csv"}, [csv = to_csv(response_table(experiment, found))](const std::filesystem::path& folder) {
         write_file(folder / "frf.csv", csv);
       }});
  results.figures.push_back(response_figure(experiment, found));
  return results;
}

}  // namespace beamid::experiments
