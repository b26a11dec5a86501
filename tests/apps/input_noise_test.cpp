// Noise of a base beside coloured noise of sensors, end to end. Oracle: the noise that was added to a
// simulated record: of which channel, and how much.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <utility>
#include <vector>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::input_noise_test {
namespace {

using testing::HasSubstr, testing::Not;

constexpr const char* building =
    "[chain]\nmasses_kg = [1000, 900, 800]\nstiffnesses_n_per_m = [2.0e6, 1.6e6, 1.2e6]\nheights_m = [3, 3, "
    "3]\n[damping]\nlaw = \"modal\"\nratio = 0.03\n[model]\nname = \"beam\"\n[reduction]\nmethod = \"none\"\n"
    "[excitation]\nkind = \"base\"\nfile = \"ground.csv\"\n[simulation]\nduration_s = 30\n"
    "sampling_rate_hz = 100\nsteps_per_sample = 4\nframes = 0\n"
    "[[sensors]]\nquantity = \"acceleration\"\nposition_m = 3\n"
    "[[sensors]]\nquantity = \"acceleration\"\nposition_m = 9\n"
    "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = 0\nto_m = 3\n"
    "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = 3\nto_m = 6\n"
    "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = 6\nto_m = 9\n"
    "[[parameters]]\nquantity = \"damping_ratio\"\n";

/// The record with AR(1) noise, of a pole of 0.9 or white, in the columns whose name begins so.
void add_noise(const fs::path& file, const std::string& column, double deviation, double pole) {
  std::istringstream in(contents(file));
  std::ostringstream out;
  std::string line, cell;
  std::getline(in, line);
  out << line << '\n';
  std::vector<bool> noisy;
  std::istringstream header(line);
  while (std::getline(header, cell, ',')) noisy.push_back(cell.starts_with(column));
  std::vector<double> now(noisy.size(), 0.0);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  out.precision(12);
  while (std::getline(in, line)) {
    std::istringstream row(line);
    for (std::size_t k = 0; std::getline(row, cell, ','); ++k) {
      now[k] = pole * now[k] + std::sqrt(1.0 - pole * pole) * deviation * normal(random);
      out << (k > 0 ? "," : "") << std::stod(cell) + (noisy[k] ? now[k] : 0.0);
    }
    out << '\n';
  }
  std::ofstream(file) << out.str();
}

class InputNoise : public testing::Test {
 protected:
  InputNoise() {
    fs::copy(source("docs/tutorials/15_shear_building/ground.csv"), place_.folder() / "ground.csv");
    place_.write("building.toml", building);
    const Outcome made = place_.run("simulate --config building.toml --out made --quiet");
    EXPECT_EQ(made.code, 0) << made.err;
  }
  fs::path record() const { return place_.folder() / "made" / "record.csv"; }
  Workplace place_;
};

TEST_F(InputNoise, IsNotSeenInColouredNoiseOfSensors) {
  add_noise(record(), "acceleration", 0.02, 0.9);
  const Outcome found = place_.run("identify made/record.csv --config building.toml");
  EXPECT_EQ(found.code, 0) << found.out;
  EXPECT_THAT(found.out, Not(HasSubstr("of noise in base_acceleration")));
}

TEST_F(InputNoise, OfTheBaseIsNamedWithItsSize) {
  add_noise(record(), "base_acceleration", 0.05, 0.0);
  const Outcome found = place_.run("identify made/record.csv --config building.toml");
  EXPECT_THAT(found.out, HasSubstr("of noise in base_acceleration"));
  EXPECT_EQ(found.code, 0)
      << found.out;  // the scatter of the lines widens the intervals: they hold the truth
  const auto json =
      nlohmann::json::parse(place_.run("identify made/record.csv --config building.toml --json").out);
  const auto& parameters = json["runs"][0]["parameters"];
  for (const auto& [name, truth] : {std::pair{"storey_stiffness_1", 2.0e6},
                                    {"storey_stiffness_2", 1.6e6},
                                    {"storey_stiffness_3", 1.2e6},
                                    {"damping_ratio", 0.03}}) {
    EXPECT_LT(parameters[name]["lower_95"], truth) << name;
    EXPECT_GT(parameters[name]["upper_95"], truth) << name;
  }
}

}  // namespace
}  // namespace beamid::apps::input_noise_test
