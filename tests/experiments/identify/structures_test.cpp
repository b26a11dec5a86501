// Structures other than beams through the one engine. Oracles: the values that their records were simulated
// with, and the Cramer-Rao bound.
#include <cmath>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::structures_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* frame = R"toml(
[frame]
elements_per_member = 3
joints = [{ name = "a", x_m = 0, y_m = 0 }, { name = "b", x_m = 5, y_m = 0 },
  { name = "c", x_m = 0, y_m = 3.2 }, { name = "d", x_m = 5, y_m = 3.2 },
  { name = "e", x_m = 0, y_m = 6.4 }, { name = "f", x_m = 5, y_m = 6.4 }]
supports = [{ joint = 1, kind = "clamped" }, { joint = 2, kind = "clamped" }]
bodies = [{ joint = 3, mass_kg = 1500 }, { joint = 4, mass_kg = 1500 },
  { joint = 5, mass_kg = 1200 }, { joint = 6, mass_kg = 1200 }]
[[frame.members]]
first = 1
second = 3
GROUP_1
[[frame.members]]
first = 2
second = 4
GROUP_1
[[frame.members]]
first = 3
second = 5
GROUP_1
[[frame.members]]
first = 4
second = 6
GROUP_1
[[frame.members]]
first = 3
second = 4
group = "lower"
DAMAGE
SECTION
[[frame.members]]
first = 5
second = 6
group = "upper"
SECTION
[damping]
ratio = 0.015
[excitation]
kind = "base"
file = "ground.csv"
[simulation]
duration_s = 15
sampling_rate_hz = 100
steps_per_sample = 4
seed = 3
[[sensors]]
at = "c.x"
noise_m_per_s2 = 0.01
[[sensors]]
at = "e.x"
noise_m_per_s2 = 0.01
[model]
name = "beam"
[reduction]
method = "modal_truncation"
modes = 6
[compare]
passes = 8
[[parameters]]
quantity = "factor"
name = "columns"
[[parameters]]
quantity = "factor"
name = "lower"
[[parameters]]
quantity = "factor"
name = "upper"
[[parameters]]
quantity = "damping_ratio"
)toml";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at; (at = text.find(what)) != std::string::npos;) text.replace(at, what.size(), by);
  return text;
}

std::string described(const std::string& damage) {
  const std::string section =
      "width_m = 0.1\nheight_m = 0.1\nyoungs_modulus_pa = 2.1e11\ndensity_kg_per_m3 = 7850";
  return replaced(replaced(replaced(frame, "GROUP_1", "group = \"columns\"\n" + section), "DAMAGE", damage),
                  "SECTION", section);
}

// A ground motion of many sines between 0.5 and 9 Hz, straight between its samples.
void write_ground(const fs::path& file) {
  std::ofstream out(file);
  out << "time_s,acceleration_m_per_s2\n";
  for (int k = 0; k <= 1500; ++k) {
    const double t = 0.01 * k;
    double a = 0.0;
    for (int i = 1; i <= 18; ++i) a += std::sin(2.0 * std::numbers::pi * 0.5 * i * t + 1.7 * i * i);
    out << t << "," << 0.5 * a << "\n";
  }
}

Experiment experiment_of(const std::string& text) {
  return read_experiment(TomlTable::parse(text, "frame.toml"));
}

class DamagedFrame : public testing::Test {
 protected:
  void SetUp() override {
    write_ground(folder_.path / "ground.csv");
    record_ =
        simulate(experiment_of(described("stiffness_factor = 0.75")), folder_.path, 0, unwatched).record;
  }
  ComparedRun identified(const Record& record) const {
    return identify_with_model(experiment_of(described("")), measured_record("record", record), folder_.path,
                               unwatched)
        .runs.at(0);
  }

  TemporaryFolder folder_;
  Record record_;
};

TEST_F(DamagedFrame, IsFoundByItsGroups) {
  const ComparedRun run = identified(record_);
  ASSERT_EQ(run.status, ComparedRun::Status::converged);
  const double truth[] = {1.0, 0.75, 1.0, 0.015};
  for (std::size_t j = 0; j < 4; ++j) {
    const Estimate& found = run.parameters[j].estimate;
    EXPECT_LE(std::abs(found.value - truth[j]), 3.5 * found.deviation) << found.name;
    EXPECT_LE(found.deviation, 0.03 * found.value) << found.name;
  }
}

// Sensors described in each other's place leave motion that no parameters explain.
TEST_F(DamagedFrame, ContradictsSensorsInWrongPlaces) {
  std::swap(record_.channels[0].place, record_.channels[1].place);
  const ComparedRun run = identified(record_);
  EXPECT_NE(run.status, ComparedRun::Status::converged);
}

TEST(Structures, SayWhatTheirPlacesAre) {
  const auto complaint = [](const std::string& text) {
    try {
      experiment_of(text);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_THAT(complaint(replaced(described(""), "at = \"c.x\"", "at = \"c.z\"")),
              testing::HasSubstr("expected one of the places c.x, c.y, d.x"));
  EXPECT_THAT(complaint(replaced(described(""), "at = \"c.x\"", "position_m = 3")),
              testing::HasSubstr("position_m has no use for a frame, whose places have names"));
  EXPECT_THAT(complaint(replaced(described(""), "name = \"lower\"", "name = \"middle\"")),
              testing::HasSubstr("expected one of columns, lower, upper"));
}

TEST(System, IsReadFromMatrixMarketFiles) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& entries) {
    std::ofstream(folder.path / name) << "%%MatrixMarket matrix coordinate real symmetric\n" << entries;
  };
  write("M.mtx", "2 2 2\n1 1 3\n2 2 5\n");
  write("K.mtx", "2 2 3\n1 1 700\n2 1 -300\n2 2 300\n");
  write("K1.mtx", "3 3 1\n1 1 1\n");
  const auto read = [&](const std::string& more) {
    return read_experiment(TomlTable::parse("[system]\nmass = \"M.mtx\"\nstiffness = \"K.mtx\"\n" + more,
                                            (folder.path / "s.toml").string()));
  };
  const Experiment kept = read("labels = [\"low\", \"high\"]\n");
  EXPECT_EQ(kept.structure.matrices()->stiffness.coeff(0, 1), -300.0);
  EXPECT_EQ(fem::place_names(kept.structure), (std::vector<std::string>{"low", "high"}));
  EXPECT_THROW(read("[[system.parameters]]\nname = \"k\"\nstiffness = \"K1.mtx\"\n"), InputError);
  EXPECT_THROW(read("labels = [\"low\"]\n"), InputError);
  EXPECT_THROW(read("damping = \"none.mtx\"\n"), InputError);
}

}  // namespace
}  // namespace beamid::experiments::structures_test
