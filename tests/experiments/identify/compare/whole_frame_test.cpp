// A frame that nobody has reduced, shaken at its base, from its record to its estimates. Oracles: the frame
// simulated, and the Cramer-Rao bound.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/read_reduction.hpp"
#include "experiments/identify/compare/comparison.hpp"

namespace beamid::experiments::whole_frame_test {
namespace {

const Progress silent = [](const std::string&) {};
const std::filesystem::path folder = BEAMID_SOURCE_DIR "/docs/tutorials/17_any_structure";

// Smooth motion of the ground below 14 Hz, from rest.
std::string ground_file() {
  const std::string name = testing::TempDir() + "whole_frame_ground.csv";
  std::ofstream file(name);
  file << "time_s,base_acceleration_m_per_s2\n";
  for (int k = 0; k <= 3200; ++k) {
    const double time = 0.0025 * k;
    double sum = 0.0;
    for (int i = 0; i < 20; ++i)
      sum += 0.15 * std::sin(2.0 * std::numbers::pi * (0.6 + 0.7 * i) * time + i * i);
    file << time << "," << std::pow(std::min(1.0, time), 3) * sum << "\n";
  }
  return name;
}

TEST(WholeFrame, IsIdentifiedOnAllItsCoordinates) {
  // Two storeys of six members, 66 coordinates, the lower girder at 0.75 of the stiffness that is guessed.
  // Damping is Rayleigh's, which damps what is above the modes of the start too.
  // At 400 Hz the step turns a mode at 14 Hz by 3e-6 too fast.
  Experiment truth = read_experiment(
      TomlTable::read(folder / "damaged.toml", {{"simulation", "sampling_rate_hz", 400.0, "test"},
                                                {"simulation", "duration_s", 8.0, "test"},
                                                {"excitation", "file", ground_file(), "test"}}));
  truth.damping = fem::RayleighDamping{{2.0, 0.015}, {10.0, 0.02}};
  const ComparedRecord record = simulated_record(truth, folder, silent);

  Experiment asked = read_experiment(TomlTable::read(folder / "frame.toml"));
  asked.damping = fem::RayleighDamping{{2.0, 0.02}, {10.0, 0.02}};
  asked.parameters.pop_back();  // the ratio of all modes
  asked.parameters.push_back({"mass_damping"});
  asked.parameters.push_back({"stiffness_damping"});
  asked.model.options.set("coordinates", std::string("mesh"));
  asked.model.options.set("modes", 3.0);
  asked.model.options.set("sensor_bias", false);
  asked.reductions = {parse_reduction("none", "test")};
  asked.filters = {asked.filter};
  asked.discretisations = {asked.discretisation};
  const Comparison found = compare(asked, record, folder, silent);
  const ComparedRun& run = found.runs[0];
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  EXPECT_EQ(run.coordinates, 66);
  EXPECT_EQ(run.filter + " " + run.discretisation, "low_rank_ekf pade");
  ASSERT_EQ(run.parameters.size(), 5u);
  for (std::size_t j = 0; j < 3; ++j) {
    const ComparedParameter& p = run.parameters[j];
    EXPECT_LT(std::abs(p.estimate.value - *p.truth), 3.0 * p.estimate.deviation) << p.estimate.name;
    EXPECT_LT(p.estimate.deviation, 0.01) << p.estimate.name;
    EXPECT_NEAR(*p.bound_ratio(), 1.0, 0.1) << p.estimate.name;
  }
}

}  // namespace
}  // namespace beamid::experiments::whole_frame_test
