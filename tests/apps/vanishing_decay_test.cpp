// Records with next to nothing in them, such as a dead channel with one spike: every command ends by itself.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::vanishing_decay_test {
namespace {

std::string record(int count, const std::function<double(int)>& value) {
  std::string text = "time_s,acceleration_m_per_s2\n";
  for (int k = 0; k < count; ++k) text += std::to_string(0.01 * k) + "," + std::to_string(value(k)) + "\n";
  return text;
}

// Oracle: a process that ends by itself has an exit code; a signal has none. All poles of such a record are
// over within a sample, so that no mode and no column of any least squares is left.
TEST(VanishingDecay, EndsNoCommandBySignal) {
  const std::pair<const char*, std::string> records[] = {
      {"one reading and zeros", record(13, [](int k) { return k == 0 ? 1.0 : 0.0; })},
      {"a spike in a dead channel", record(600, [](int k) { return k == 250 ? 1.0 : 0.0; })},
      {"three readings and zeros", record(100, [](int k) { return k < 3 ? 1.0 + k : 0.0; })},
      {"over within a few samples", record(600, [](int k) { return 1e3 * std::exp(-2.0 * k); })}};
  Workplace place;
  place.write("beam.toml",
              "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\n"
              "mass_kg = 3.055\ntip_mass_kg = 0.36\n");
  for (const auto& [name, text] : records) {
    place.write("a.csv", text);
    for (const char* words : {"modal a.csv", "modal a.csv --method damped_sine",
                              "identify a.csv --config beam.toml", "check a.csv --config beam.toml",
                              "compare a.csv --config beam.toml", "track a.csv --config beam.toml"}) {
      const Outcome outcome = place.run(words);
      EXPECT_GE(outcome.code, 0) << words << ": " << name;
      EXPECT_LE(outcome.code, 3) << words << ": " << name << "\n" << outcome.err;
    }
  }
}

}  // namespace
}  // namespace beamid::apps::vanishing_decay_test
