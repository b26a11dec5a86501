#include "experiments/config/read_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/key_tables.hpp"
#include "experiments/text/memory_need.hpp"
#include "experiments/text/method_choice.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

std::vector<std::string> response_names() {
  std::vector<std::string> names;
  for (const auto& method : fem::response_methods()) names.push_back(method.name);
  return names;
}

const Schema<Simulation>& simulation_keys() {
  using S = Simulation;
  constexpr int most_steps = 1000, most_frames = 100000, largest_seed = 2147483647;
  static const Schema<S> keys =
      Schema<S>("simulation")
          .with_options()
          .key("duration_s", &S::duration, positive, "of the record", "25")
          .key("sampling_rate_hz", &S::sampling_rate, positive, "of the record", "1000")
          .key("steps_per_sample", &S::steps_per_sample, {1, most_steps},
               "steps of integration between two samples", "4")
          .key(
              "method", [](S& s) -> std::string& { return s.method.name; },
              "a name from `beamid list responses`", "\"newmark\"")
          .one_of(response_names())
          .values("text")
          .key("frames", &S::frames, {0, most_frames},
               "pictures of the whole beam for ParaView, evenly spread", "200")
          .key("seed", &S::seed, {0, largest_seed}, "of the sensors' noise", "7");
  return keys;
}

const bool simulation_keys_registered = register_keys([]() -> const KeyTable& { return simulation_keys(); });

}  // namespace

Simulation read_simulation(const TomlTable& table) {
  constexpr double most_samples = 2e7;
  Simulation simulation = simulation_keys().read(table);
  const double samples = simulation.duration * simulation.sampling_rate;
  if (samples < 1.0 || samples > most_samples)
    throw InputError(table.place(),
                     fmt::format("{} s at {} Hz make {:.6g} samples; expected 1 to {:g}", simulation.duration,
                                 simulation.sampling_rate, samples, most_samples));
  constexpr double sample = 170;  // [bytes], of one sensor: its responses and what is reported, measured
  at_place(table.place(), [&] { require_memory(samples, "samples of a simulated record", sample); });
  const auto methods = fem::response_methods();
  const auto method = std::find_if(methods.begin(), methods.end(),
                                   [&](const auto& m) { return m.name == simulation.method.name; });
  std::vector<std::string> options;
  for (const auto& option : method->options) options.push_back(option.name);
  for (const std::string& key : table.keys()) {
    if (simulation_keys().find(key) != nullptr) continue;
    if (std::find(options.begin(), options.end(), key) == options.end())
      throw InputError(table.key_place(key),
                       fmt::format("unknown option '{}' of response method '{}'; known: {}", key,
                                   method->name, options.empty() ? "none" : joined(options)));
    simulation.method.options[key] = table.number(key);
  }
  return simulation;
}

}  // namespace beamid::experiments
