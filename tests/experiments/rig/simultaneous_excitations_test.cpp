// Several excitations at the same time, and inputs that are recorded with noise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/rig/simulated_test.hpp"

namespace beamid::experiments::simultaneous_excitations_test {
namespace {

using Eigen::VectorXd;
using testing::HasSubstr;

constexpr const char* floors = R"toml(
[chain]
masses_kg = [1000, 900, 800]
stiffnesses_n_per_m = [2.0e6, 1.6e6, 1.2e6]
dashpots_n_s_per_m = [2000, 1600, 1200]
[simulation]
duration_s = 5
sampling_rate_hz = 200
[[sensors]]
quantity = "acceleration"
position_m = 3
)toml";

constexpr const char* low = R"toml(
[[excitations]]
kind = "random"
amplitude_n = 300
frequency_hz = 100
position_m = 1
)toml";
constexpr const char* high = R"toml(
[[excitations]]
kind = "harmonic"
amplitude_n = 200
frequency_hz = 3
position_m = 3
)toml";
constexpr const char* ground = R"toml(
[[excitations]]
kind = "base"
amplitude_m_per_s2 = 0.4
frequency_hz = 2
)toml";

Experiment read(const std::string& more) {
  return read_experiment(TomlTable::parse(floors + more, "floors.toml"));
}

SimulatedTest simulated(const std::string& more) {
  const Experiment experiment = read(more);
  return simulate(experiment, {}, 0, unwatched, experiment.acquisition);
}

TEST(SimultaneousExcitations, AddUp) {
  // Oracle: superposition, the structure being linear.
  const SimulatedTest all = simulated(std::string(low) + high + ground);
  const VectorXd sum = simulated(low).record.samples.row(0) + simulated(high).record.samples.row(0) +
                       simulated(ground).record.samples.row(0);
  EXPECT_LT((all.record.samples.row(0).transpose() - sum).norm(), 1e-9 * sum.norm());
  ASSERT_EQ(all.record.channels.size(), 4u);
  EXPECT_EQ(all.record.channels[1].quantity, Quantity::force);
  EXPECT_DOUBLE_EQ(*all.record.channels[1].position, 1.0);
  EXPECT_DOUBLE_EQ(*all.record.channels[2].position, 3.0);
  EXPECT_EQ(all.record.channels[3].quantity, Quantity::base_acceleration);
}

TEST(RandomForce, HasItsRootMeanSquareAndIsWhiteAtItsOwnRate) {
  // Oracle: 1001 normal numbers, whose root mean square is known to 2.2 % and whose correlation to 3.2 %.
  const VectorXd force = simulated(low).record.samples.row(1);
  const double square = force.squaredNorm() / static_cast<double>(force.size());
  EXPECT_NEAR(std::sqrt(square), 300.0, 4.0 * 0.022 * 300.0);
  const auto last = force.size() - 1;
  EXPECT_NEAR(force.head(last).dot(force.tail(last)) / force.squaredNorm(), 0.0, 4.0 * 0.032);
}

TEST(RandomForce, IsThatOfItsSeed) {
  const VectorXd one = simulated(low).record.samples.row(1), again = simulated(low).record.samples.row(1);
  EXPECT_EQ(one, again);
}

TEST(RecordedInput, ShowsItsNoiseAndStatesIt) {
  const SimulatedTest clean = simulated(ground),
                      noisy = simulated(std::string(ground) + "[acquisition]\nbase_noise_m_per_s2 = 0.02\n");
  const VectorXd noise = noisy.record.samples.row(1) - clean.record.samples.row(1);
  EXPECT_NEAR(noise.norm() / std::sqrt(static_cast<double>(noise.size())), 0.02, 4.0 * 0.022 * 0.02);
  EXPECT_EQ(noisy.record.channels[1].noise, 0.02);
  EXPECT_EQ(noisy.record.samples.row(0), clean.record.samples.row(0));  // the base moves as it did
}

void expect_refused(const std::string& more, const std::string& words) {
  try {
    simulated(more);
    FAIL() << more;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

TEST(SimultaneousExcitations, StartTheMotionOnce) {
  expect_refused(std::string(low) + "[[excitations]]\nkind = \"release\"\n",
                 "only the first of [[excitations]]");
}
TEST(SimultaneousExcitations, ActEachAtAPlaceOfItsOwn) {
  expect_refused(std::string(low) + low, "acts where another one of [[excitations]] does");
}
TEST(SimultaneousExcitations, StandInPlaceOfTheOne) {
  expect_refused(std::string(low) + "[excitation]\nkind = \"static\"\nforce_n = 2\n",
                 "excitations beside excitation; expected one of them");
}

}  // namespace
}  // namespace beamid::experiments::simultaneous_excitations_test
