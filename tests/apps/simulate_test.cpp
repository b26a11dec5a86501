// Oracles: the closed form of a decaying mode; the static stiffness 3 E I / L^3; identification of what was
// simulated.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::simulate_test {
namespace {

using nlohmann::json, std::numbers::pi, testing::HasSubstr, testing::StartsWith;

/// Rows of numbers below a header.
std::vector<std::vector<double>> rows(const fs::path& file) {
  std::istringstream text(contents(file));
  std::string line, field;
  std::getline(text, line);
  std::vector<std::vector<double>> result;
  while (std::getline(text, line)) {
    std::istringstream fields(line);
    result.emplace_back();
    while (std::getline(fields, field, ',')) result.back().push_back(std::stod(field));
  }
  return result;
}

const std::string study =
    "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = "
    "3.055\n";

TEST(Simulate, ReleasesTheStudysBeamByDefault) {
  Workplace place;
  const Outcome outcome = place.run("simulate --damping-ratio 0.002 --duration 1 --out results");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto record = rows(place.folder() / "results" / "record.csv");
  EXPECT_THAT(contents(place.folder() / "results" / "record.csv"),
              StartsWith("time_s,displacement_tip_m,acceleration_tip_m_per_s2\n"));
  ASSERT_EQ(record.size(), 1001u);
  EXPECT_NEAR(record[0][1], 0.012, 2e-6);  // the modes above half the sampling rate are left out
  for (const char* file : {"response.pvd", "frame_0000.vtu", "frame_0099.vtu", "displacement_tip_m.svg",
                           "acceleration_tip_m_per_s2.png", "sensors.csv", "results.json"})
    EXPECT_TRUE(fs::exists(place.folder() / "results" / file)) << file;
}

// d e^(-xi w t) (cos w_d t + xi w / w_d sin w_d t), w = b^2 sqrt(EI / (m L^4)); 40 elements err by 3e-9 in w
TEST(Simulate, LetsOneModeDecayAsItsClosedForm) {
  Workplace place;
  place.write("mode.toml",
              study +
                  "[damping]\nratio = 0.01\n[excitation]\nkind = \"none\"\ndeflection_m = 0.01\nmode = "
                  "1\n[[sensors]]\nquantity = \"displacement\"\n[[sensors]]\nquantity = \"velocity\"\n"
                  "[simulation]\nduration_s = 2\nsampling_rate_hz = 200\nframes = 0\n");
  ASSERT_EQ(place.run("simulate --config mode.toml --out results").code, 0);
  const double w = std::pow(1.875104068711961, 2) * std::sqrt(228.96 / (3.055 / 1.1 * std::pow(1.1, 4)));
  const double xi = 0.01, wd = w * std::sqrt(1 - xi * xi);
  for (const auto& row : rows(place.folder() / "results" / "record.csv")) {
    const double t = row[0], decay = 0.01 * std::exp(-xi * w * t);
    EXPECT_NEAR(row[1], decay * (std::cos(wd * t) + xi * w / wd * std::sin(wd * t)), 1e-8);
    EXPECT_NEAR(row[2], -decay * w * w / wd * std::sin(wd * t), 1e-6);
  }
  EXPECT_FALSE(fs::exists(place.folder() / "results" / "response.pvd"));
}

TEST(Simulate, SettlesAtTheStaticDeflection) {
  Workplace place;
  place.write(
      "step.toml",
      study +
          "[damping]\nlaw = \"rayleigh\"\nanchors = [{ frequency_hz = 4, ratio = 0.5 }, { frequency_hz = "
          "30, ratio = 0.5 }]\n[excitation]\nkind = \"static\"\nforce_n = 5.16063\n[[sensors]]\nquantity = "
          "\"displacement\"\n[simulation]\nmethod = \"newmark\"\nduration_s = 4\n");
  ASSERT_EQ(place.run("simulate --config step.toml --out results").code, 0);
  const double stiffness = 3 * 228.96 / std::pow(1.1, 3);
  EXPECT_NEAR(rows(place.folder() / "results" / "record.csv").back()[1], 5.16063 / stiffness, 1e-9);
}

TEST(Simulate, TakesAForceFromAFile) {
  Workplace place;
  place.write("force.csv", "time_s,force_n\n0,5\n0.5,5\n1,5\n");
  place.write("table.toml",
              study + "[damping]\nratio = 0.01\n[excitation]\nkind = \"table\"\nfile = \"force.csv\"\n");
  place.write("step.toml", study + "[damping]\nratio = 0.01\n[excitation]\nkind = \"static\"\nforce_n = 5\n");
  const Outcome table = place.run("simulate --config table.toml --duration 1 --out table");
  ASSERT_EQ(table.code, 0) << table.err;
  ASSERT_EQ(place.run("simulate --config step.toml --duration 1 --out step").code, 0);
  EXPECT_TRUE(contents(place.folder() / "table" / "record.csv") ==
              contents(place.folder() / "step" / "record.csv"));
  place.write("motion.csv", "time_s,displacement_m\n0,5\n1,5\n2,5\n");
  place.write("wrong.toml", study + "[excitation]\nkind = \"table\"\nfile = \"motion.csv\"\n");
  const Outcome wrong = place.run("simulate --config wrong.toml");
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, StartsWith("motion.csv: "));
}

// Slowly moved, the beam follows its base: absolute acceleration like the base's times 1 / (1 - (f / f1)^2),
// nearly.
TEST(Simulate, MeasuresAbsoluteAcceleration) {
  Workplace place;
  place.write(
      "base.toml",
      study +
          "[damping]\nratio = 0.3\n[excitation]\nkind = \"base\"\namplitude_m_per_s2 = 2\nfrequency_hz = "
          "0.05\n[[sensors]]\n[simulation]\nduration_s = 40\nsampling_rate_hz = 100\nframes = 0\n");
  ASSERT_EQ(place.run("simulate --config base.toml --out results").code, 0);
  for (const auto& row : rows(place.folder() / "results" / "record.csv"))
    if (row[0] > 5) {
      EXPECT_NEAR(row[1], 2 * std::sin(2 * pi * 0.05 * row[0]), 0.03);
    }
}

TEST(Simulate, IsReproducible) {
  Workplace place;
  place.write("noisy.toml",
              study + "[[sensors]]\nnoise_m_per_s2 = 0.05\n[simulation]\nduration_s = 0.5\nseed = 3\n");
  const Outcome one = place.run("simulate --config noisy.toml --json"),
                other = place.run("simulate --config noisy.toml --json");
  EXPECT_EQ(one.out, other.out);
  EXPECT_EQ(json::parse(one.out)["seed"], 3);
}

// The record is written as `identify` reads it, and holds what it was made of.
TEST(Simulate, MakesRecordsThatAreIdentified) {
  Workplace place;
  place.write("rig.toml",
              study +
                  "tip_mass_kg = 0.36049\n[damping]\nratio = 0.0045\n[[sensors]]\nnoise_m_per_s2 = "
                  "0.05\n[simulation]\nduration_s = 10\nsampling_rate_hz = 250\nframes = 0\n[record]\nfile = "
                  "\"results/record.csv\"\nwindow_s = [3.0, 10.0]\n");
  ASSERT_EQ(place.run("simulate --config rig.toml --out results").code, 0);
  const Outcome outcome = place.run("identify --config rig.toml --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_NEAR(found["frequency_hz"]["estimate"].get<double>(), 3.455527, 5e-4);
  EXPECT_NEAR(found["damping_ratio"]["estimate"].get<double>(), 0.0045, 2e-4);
}

// Oracle: what the file asks for, counted in the record.
TEST(Simulate, WritesWhatCheapSensorsShow) {
  Workplace place;
  place.write("rig.toml",
              study +
                  "[[sensors]]\nname = \"tip\"\nclipping = 0.5\n[[sensors]]\nname = \"cable\"\noffset = "
                  "1\ndead = true\n[acquisition]\npretrigger_s = 0.5\njitter = 0.3\nmedian_shortfall = "
                  "0.09\n[simulation]\nduration_s = 2\nsampling_rate_hz = 500\n");
  const Outcome outcome = place.run("simulate --config rig.toml --out results");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Logger: 0.5 s before the excitation, intervals with a jitter of 30 %"));
  EXPECT_THAT(outcome.out, HasSubstr("Sensor cable"));
  const json found = json::parse(contents(place.folder() / "results" / "results.json"));
  EXPECT_EQ(found["configuration"]["experiment"]["sensors"][0]["clipping"], 0.5);
  EXPECT_EQ(found["configuration"]["experiment"]["sensors"][1]["dead"], true);
  const auto record = rows(place.folder() / "results" / "record.csv");
  ASSERT_EQ(record.size(), 1251u);
  double largest = 0;
  std::size_t at_limit = 0;
  for (const auto& row : record) largest = std::max(largest, std::abs(row[1]));
  for (const auto& row : record) {
    at_limit += std::abs(row[1]) == largest;
    EXPECT_EQ(row[2], record[0][2]);
  }
  EXPECT_GT(at_limit, 3u);
  EXPECT_NEAR(record[0][2], 2 * largest, 1e-9);
  EXPECT_EQ(record[100][1], 0.0);  // at rest, held
  EXPECT_NE(record[300][1], 0.0);
}

struct Refused {
  const char* text;
  const char* message;
};

TEST(Simulate, RefusesWhatItCannotFollow) {
  const Refused cases[] = {
      {"support = \"free-free\"\n", nullptr},
      {"[excitation]\nkind = \"none\"\n",
       "bad.toml:7:1: an excitation of kind \"none\" causes no motion; expected deflection_m or "
       "velocity_m_per_s"},
      {"[excitation]\nkind = \"impulse\"\nmomentum_n_s = 1\nduration_s = 0.002\n",
       "bad.toml:7:1: excitation.duration_s is 0.002, 2 steps of 0.001 s; expected at least 4 (raise "
       "simulation.steps_per_sample or sampling_rate_hz), or 0 for an instant"},
      {"[excitation]\nkind = \"table\"\nfile = \"no.csv\"\n",
       "no.csv: no such file; expected a record of numbers in columns"},
      {"[acquisition]\njitter = 0.1\nmedian_shortfall = 0.05\n",
       "bad.toml:9:20: acquisition.median_shortfall is 0.05; expected a number from 0 to 0.041"},
      {"[[sensors]]\nrattle_above = 2\n",
       "bad.toml:8:16: sensors[1].rattle_above is 2; expected a number from 0 to 1"},
      {"[[sensors]]\nposition_m = 0\n",
       "bad.toml: point 'root' is held by a support; expected one that can move"}};
  for (const Refused& refused : cases) {
    Workplace place;
    place.write("bad.toml", study + refused.text);
    const Outcome outcome = place.run("simulate --config bad.toml --out results");
    EXPECT_EQ(outcome.code, 2) << refused.text << outcome.err;
    EXPECT_EQ(place.files(), std::vector<std::string>{"bad.toml"});
    if (refused.message) {
      EXPECT_EQ(outcome.first_error_line(), refused.message);
    }
  }
}

}  // namespace
}  // namespace beamid::apps::simulate_test
