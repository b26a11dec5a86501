
#include "experiments/studies/continuum/report.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/config/description.hpp"
#include "experiments/config/experiment.hpp"
#include "experiments/config/structure_description.hpp"
#include "experiments/record/record.hpp"
#include "experiments/record/units.hpp"
#include "experiments/results/figure.hpp"
#include "experiments/results/mode_figure.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/results/vtk/field_history.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {
namespace {

// How `beamid simulate` says what sensors and logger did to the readings.

std::string sentence(const std::string& subject, const std::vector<std::string>& parts) {
  if (parts.empty()) return "";
  std::string text = subject + ": ";
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i ? ", " : "") + parts[i];
  return text + ". ";
}

std::vector<std::string> parts_of(const Acquisition& a) {
  std::vector<std::string> parts;
  if (a.pretrigger > 0) parts.push_back(fmt::format("{:g} s before the excitation", a.pretrigger));
  if (a.jitter > 0) parts.push_back(fmt::format("intervals with a jitter of {:g} %", 100 * a.jitter));
  if (a.median_shortfall > 0)
    parts.push_back(fmt::format("their median {:g} % below their mean", 100 * a.median_shortfall));
  if (a.gaps > 0)
    parts.push_back(
        fmt::format("{} gap{} of {:g} to {:g} s", a.gaps, a.gaps == 1 ? "" : "s", a.gap.first, a.gap.second));
  if (a.repeated > 0) parts.push_back(fmt::format("{:g} % of the samples repeated", 100 * a.repeated));
  if (!a.force) parts.emplace_back("the force not measured");
  return parts;
}

std::vector<std::string> parts_of(const SensorDefects& s) {
  if (s.dead) return {"dead"};
  std::vector<std::string> parts;
  if (s.clipping > 0) parts.push_back(fmt::format("clipped at {:g}", s.clipping));
  if (s.resolution > 0) parts.push_back(fmt::format("in steps of {:g}", s.resolution));
  if (s.offset != 0) parts.push_back(fmt::format("offset {:g}", s.offset));
  if (s.drift != 0) parts.push_back(fmt::format("drifting by {:g}", s.drift));
  if (s.startup != 0)
    parts.push_back(fmt::format("start-up of {:g} fading in {:g} s", s.startup, s.startup_time));
  if (s.rattle > 0) parts.push_back(fmt::format("rattle of {:g} above {:g}", s.rattle, s.rattle_above));
  return parts;
}

/// A sentence for the logger and one for every sensor with a defect; empty where all is as it should be.
std::string acquisition_text(const SimulatedTest& test) {
  std::string text = sentence("Logger", parts_of(test.acquisition));
  for (std::size_t i = 0; i < test.sensors.size(); ++i)
    text += sentence("Sensor " + test.sensors[i].name + ", in shares of its largest true reading",
                     parts_of(test.acquisition.of(i)));
  if (!text.empty()) text.pop_back();
  return text;
}

using Eigen::Index, Eigen::VectorXd;
using Json = nlohmann::ordered_json;

/// What one channel of the record shows.
struct HistoryPeak {
  double value = 0.0, time = 0.0, root_mean_square = 0.0, frequency_hz = std::nan("");
};

HistoryPeak peak_of(const SimulatedTest& test, Index channel) {
  const Record& record = test.record;
  const VectorXd signal = record.samples.row(channel);
  Index at = 0;
  HistoryPeak peak;
  peak.value = signal.cwiseAbs().maxCoeff(&at);
  peak.time = record.time[at];
  peak.root_mean_square = std::sqrt(signal.squaredNorm() / static_cast<double>(signal.size()));
  if (test.acquisition.even() && signal.size() >= 16 && signal.maxCoeff() > signal.minCoeff())
    peak.frequency_hz = strongest_frequency(signal, record.interval());
  return peak;
}

Table sensor_table(const SimulatedTest& test) {
  Table table{"sensors", ""};
  table.column({"sensor", "sensor"})
      .column({"quantity", "quantity"})
      .column({"at [m]", "position_m", "{:g}"})
      .column({"unit", "unit"})
      .column({"peak", "peak", "{:.6g}"})
      .column({"at [s]", "time_of_peak_s", "{:g}"})
      .column({"rms", "root_mean_square", "{:.6g}"})
      .column({"strongest f [Hz]", "strongest_frequency_hz", "{:.6g}"})
      .column({"noise", "noise", "{:g}"});
  for (std::size_t i = 0; i < test.sensors.size(); ++i) {
    const Sensor& sensor = test.sensors[i];
    const HistoryPeak peak = peak_of(test, static_cast<Index>(i));
    table.row({sensor.name, to_string(sensor.quantity), sensor.position.value_or(std::nan("")),
               si_unit(sensor.quantity), peak.value, peak.time, peak.root_mean_square, peak.frequency_hz,
               sensor.noise});
  }
  return table;
}

std::string excitation_text(const Excitation& e) {
  using Kind = Excitation::Kind;
  const std::string where = at_place_text(e.position, e.at);
  switch (e.kind) {
    case Kind::release:
      return fmt::format(
          "{} a static deflection of {:g} m{}.",
          e.duration > 0.0 ? fmt::format("Let go within {:g} s from", e.duration) : "Released from",
          e.deflection.value_or(0.012), where);
    case Kind::free:
      return fmt::format("Set free with {:g} m and {:g} m/s{}, in {}.", e.deflection.value_or(0.0),
                         e.velocity, where, e.mode ? fmt::format("mode {}", *e.mode) : "the static shape");
    case Kind::step:
      return fmt::format("A force of {:g} N{} from t = 0 on.", e.force, where);
    case Kind::impulse:
      return fmt::format(
          "An impulse of {:g} N s{}, {}.", e.momentum, where,
          e.duration > 0.0 ? fmt::format("half a sine of {:g} s", e.duration) : "in an instant");
    case Kind::harmonic:
      return fmt::format("A force of {:g} N at {:g} Hz{}.", e.amplitude, e.frequency_hz, where);
    case Kind::random:
      return fmt::format("A random force of {:g} N root mean square, up to {:g} Hz{}.", e.amplitude,
                         e.frequency_hz, where);
    case Kind::table:
      return fmt::format("The force of {}{}.", *e.file, where);
    case Kind::base:
      break;
  }
  return e.file ? fmt::format("The base accelerated as in {}.", *e.file)
                : fmt::format("The base accelerated by {:g} m/s2 at {:g} Hz.", e.amplitude, e.frequency_hz);
}

std::string excitations_text(const std::vector<Excitation>& all) {
  std::string text;
  for (const Excitation& one : all) text += (text.empty() ? "" : " ") + excitation_text(one);
  return text;
}

Json simulation_values(const Experiment& experiment, const SimulatedTest& test) {
  const Simulation& settings = experiment.simulation;
  Json json{{"samples", test.record.size()},
            {"sampling_rate_hz", settings.sampling_rate},
            {"duration_s", test.record.time[test.record.size() - 1]},
            {"method", test.method.name},
            {"steps", test.response.time.size() - 1},
            {"time_step_s", test.step},
            {"elements", test.system.mesh.elements.size()},
            {"degrees_of_freedom", test.system.size()},
            {"frames", test.response.frames.size()},
            {"sensors", Json::array()},
            {"channels", channel_values(test.record)}};
  const std::vector<std::string> columns = column_names(test.record);
  for (std::size_t i = 0; i < test.sensors.size(); ++i) {
    const Sensor& sensor = test.sensors[i];
    const std::string unit = "_" + units(sensor.quantity).front().suffix;
    const HistoryPeak peak = peak_of(test, static_cast<Index>(i));
    json["sensors"].push_back({{"name", sensor.name},
                               {"column", columns[i + 1]},
                               {"quantity", to_string(sensor.quantity)},
                               {"position_m", number_or_null(sensor.position.value_or(std::nan("")))},
                               {"noise" + unit, sensor.noise},
                               {"peak" + unit, peak.value},
                               {"time_of_peak_s", peak.time},
                               {"root_mean_square" + unit, peak.root_mean_square},
                               {"strongest_frequency_hz", number_or_null(peak.frequency_hz)}});
  }
  return json;
}

// History above, spectrum below.
Figure sensor_figure(const SimulatedTest& test, std::size_t i, const std::string& name) {
  const Sensor& sensor = test.sensors[i];
  const VectorXd signal = test.record.samples.row(static_cast<Index>(i));
  const std::string label = axis_label(sensor.quantity);
  Figure figure{name, {}, 1, 1};
  figure.panels.push_back(Panel{sensor.name, {"time [s]"}, {label}}
                              .line("", test.record.time, signal, Colour::blue)
                              .across(test.record.time[0], test.record.time[test.record.size() - 1])
                              .key(Legend::none));
  if (test.acquisition.even())
    if (auto spectrum = spectrum_panel({{"", signal}}, test.record.interval(), label, 8)) {
      figure.panels.push_back(std::move(*spectrum));
      figure.rows = 2;
    }
  figure.caption =
      fmt::format("Simulated reading of the sensor '{}', and its amplitude spectrum.", sensor.name);
  return figure;
}

}  // namespace

Results report(const Experiment& experiment, const std::shared_ptr<const SimulatedTest>& test, bool surface,
               const std::shared_ptr<const WholeMotion>& motion) {
  const Simulation& settings = experiment.simulation;
  Results results;
  results.command = "simulate";
  results.seed = settings.seed;
  results.configuration = describe(experiment, {"excitation", "simulation"});
  results.configuration["simulation"] = {{"method", test->method.name}};
  for (const auto& [option, value] : test->method.options)
    results.configuration["simulation"][option] = value;
  results.values = simulation_values(experiment, *test);
  results.heading(experiment.title.empty() ? "Simulated response" : experiment.title);
  results.paragraph(structure_text(experiment, static_cast<Eigen::Index>(test->system.mesh.elements.size()),
                                   test->system.size()));
  results.paragraph(fmt::format(
      "{} Damping: {}. Method {}: {} steps of {:g} s; {} samples at {:g} Hz.",
      excitations_text(test->excitations), damping_text(experiment.damping, test->system), test->method.name,
      test->response.time.size() - 1, test->step, test->record.size(), settings.sampling_rate));
  results.table(sensor_table(*test));
  if (const std::string text = acquisition_text(*test); !text.empty()) results.paragraph(text);
  if (test->record.channels.size() > test->sensors.size())
    results.paragraph(test->record.channels.back().quantity == Quantity::force
                          ? "The record holds the force, too: " + channel_text(test->record.channels.back()) +
                                "."
                          : "The record holds the acceleration of the base, too.");
  results.notes(test->notes);

  results.attachments.push_back({{"record.csv", "record.toml"}, [test](const std::filesystem::path& folder) {
                                   write_record(test->record, folder / "record.csv");
                                   write_file(folder / "record.toml",
                                              places_text(test->record, "record.csv"));
                                 }});
  const std::vector<std::string> columns = column_names(test->record);
  for (std::size_t i = 0; i < test->sensors.size(); ++i)
    results.figures.push_back(sensor_figure(*test, i, columns[i + 1]));
  if (motion && motion->time.size() > 1)
    results.attachments.push_back(
        {{"motion.glb"},
         [test, motion, structure = experiment.structure](const std::filesystem::path& folder) {
           const auto [model, history] =
               motion_model(Picture(structure, test->system), motion->time, motion->displacement);
           write_file(folder / "motion.glb", binary_gltf(model, history));
         }});
  if (!test->response.frames.empty() && !test->system.mesh.nodes.empty())
    results.attachments.push_back(
        {field_history_files(static_cast<Index>(test->response.frames.size())),
         [test, structure = experiment.structure, surface](const std::filesystem::path& folder) {
           write_field_history(folder, Picture(structure, test->system, surface), test->response);
         }});
  return results;
}

}  // namespace beamid::experiments
