#include "experiments/config/read_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiments/config/read_attachments.hpp"
#include "experiments/config/read_gauge.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

using Kind = Excitation::Kind;

/// What a kind reads beside `kind`, and which of that it needs.
struct KindKeys {
  Kind kind;
  std::vector<std::string> useful, needed;
};

const std::vector<KindKeys>& kinds() {
  static const std::vector<KindKeys> all{
      {Kind::release, {"position_m", "deflection_m", "duration_s"}, {}},
      {Kind::step, {"position_m", "force_n"}, {"force_n"}},
      {Kind::impulse, {"position_m", "momentum_n_s", "duration_s"}, {"momentum_n_s"}},
      {Kind::harmonic, {"position_m", "amplitude_n", "frequency_hz"}, {"amplitude_n", "frequency_hz"}},
      {Kind::base, {"amplitude_m_per_s2", "frequency_hz", "file"}, {}},
      {Kind::table, {"position_m", "file"}, {"file"}},
      {Kind::free, {"position_m", "deflection_m", "velocity_m_per_s", "mode"}, {}}};
  return all;
}

const char* expected(const std::string& key) {
  return key == "file" ? "the name of a file" : key == "frequency_hz" ? "a positive number" : "a number";
}

void check_keys(const TomlTable& table, Kind kind) {
  const auto known =
      std::find_if(kinds().begin(), kinds().end(), [&](const KindKeys& k) { return k.kind == kind; });
  const std::string circumstance = fmt::format("with kind = \"{}\"", to_string(kind));
  std::vector<std::string> useful = known->useful;
  useful.insert(useful.begin(), "kind");
  refuse_all_but(table, useful, circumstance);
  for (const std::string& key : known->needed)
    if (!table.contains(key)) table.miss(key, expected(key));
  if (kind != Kind::base) return;
  if (table.contains("file"))
    refuse_useless(table, {"amplitude_m_per_s2", "frequency_hz"}, "beside file", "one or the other");
  else
    for (const std::string key : {"amplitude_m_per_s2", "frequency_hz"})
      if (!table.contains(key)) table.miss(key, std::string(expected(key)) + ", or a file");
}

}  // namespace

Excitation read_excitation(const TomlTable& table, double length) {
  constexpr int most_modes = 1000;
  std::vector<std::string> names;
  for (const KindKeys& known : kinds()) names.emplace_back(to_string(known.kind));
  Excitation excitation;
  excitation.place = table.place();
  const std::string name = table.find_text("kind", names).value_or("release");
  for (const KindKeys& known : kinds())
    if (name == to_string(known.kind)) excitation.kind = known.kind;
  if (table.contains("position_m")) excitation.position = position_on_beam(table, "position_m", length);
  excitation.deflection = table.find_number("deflection_m");
  excitation.velocity = table.find_number("velocity_m_per_s").value_or(0.0);
  excitation.mode = table.find_whole_number("mode", 1, most_modes);
  excitation.force = table.find_number("force_n").value_or(0.0);
  excitation.momentum = table.find_number("momentum_n_s").value_or(0.0);
  excitation.duration = table.find_number("duration_s", Sign::not_negative).value_or(0.0);
  const auto force = table.find_number("amplitude_n"), acceleration = table.find_number("amplitude_m_per_s2");
  excitation.amplitude = force ? *force : acceleration.value_or(0.0);
  excitation.frequency_hz = table.find_number("frequency_hz", Sign::positive).value_or(0.0);
  excitation.file = table.find_text("file");
  if (excitation.file && excitation.file->empty()) table.refuse("file", "the name of a file");
  check_keys(table, excitation.kind);
  return excitation;
}

std::vector<Sensor> read_sensors(const TomlTable& table, const fem::Beam& beam) {
  const std::vector<std::string> quantities{"displacement", "velocity", "acceleration", "strain"};
  std::vector<Sensor> sensors;
  for (const TomlTable& one : table.find_tables("sensors")) {
    Sensor sensor;
    sensor.name = one.find_text("name").value_or("");
    if (sensor.name.size() > 100) one.refuse("name", "at most 100 letters, as files are named after it");
    sensor.quantity = *find_quantity(one.find_text("quantity", quantities).value_or("acceleration"));
    sensor.position = read_position(one, beam, sensor.quantity);
    sensor.distance = read_distance(one, beam, sensor.quantity, sensor.position);
    for (const std::string& quantity : quantities) {
      const std::string key = "noise_" + units(*find_quantity(quantity)).front().suffix;
      const auto noise = one.find_number(key, Sign::not_negative);
      if (noise && quantity != to_string(sensor.quantity))
        refuse_useless(one, {key}, fmt::format("for a sensor of {}", to_string(sensor.quantity)),
                       "noise_" + units(sensor.quantity).front().suffix);
      if (noise) sensor.noise = *noise;
    }
    sensors.push_back(sensor);
  }
  return sensors;
}

Simulation read_simulation(const TomlTable& table) {
  constexpr int most_steps = 1000, most_frames = 100000, largest_seed = 2147483647;
  constexpr double most_samples = 2e7;
  Simulation simulation;
  simulation.duration = table.find_number("duration_s", Sign::positive).value_or(simulation.duration);
  simulation.sampling_rate =
      table.find_number("sampling_rate_hz", Sign::positive).value_or(simulation.sampling_rate);
  const double samples = simulation.duration * simulation.sampling_rate;
  if (samples < 1.0 || samples > most_samples)
    throw InputError(table.place(),
                     fmt::format("{} s at {} Hz make {:.6g} samples; expected 1 to {:g}", simulation.duration,
                                 simulation.sampling_rate, samples, most_samples));
  simulation.steps_per_sample = table.find_whole_number("steps_per_sample", 1, most_steps).value_or(1);
  simulation.frames = table.find_whole_number("frames", 0, most_frames).value_or(simulation.frames);
  simulation.seed = static_cast<std::uint64_t>(table.find_whole_number("seed", 0, largest_seed).value_or(1));

  const auto methods = fem::response_methods();
  std::vector<std::string> names, options;
  for (const auto& method : methods) names.push_back(method.name);
  simulation.method.name = table.find_text("method", names).value_or(simulation.method.name);
  const auto method = std::find_if(methods.begin(), methods.end(),
                                   [&](const auto& m) { return m.name == simulation.method.name; });
  for (const auto& option : method->options) options.push_back(option.name);
  const std::vector<std::string> own{"duration_s", "sampling_rate_hz", "steps_per_sample", "frames", "seed",
                                     "method"};
  for (const std::string& key : table.keys()) {
    if (std::find(own.begin(), own.end(), key) != own.end()) continue;
    if (std::find(options.begin(), options.end(), key) == options.end())
      throw InputError(table.key_place(key),
                       fmt::format("unknown option '{}' of response method '{}'; known: {}", key,
                                   method->name, options.empty() ? "none" : joined(options)));
    simulation.method.options[key] = table.number(key);
  }
  return simulation;
}

}  // namespace beamid::experiments
