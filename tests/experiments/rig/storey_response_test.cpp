// Simulated chains whose storeys follow laws. Oracles: the response of a beam on a cubic spring by another
// integrator and another formulation, the balance of energy, the linear chain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "tests/experiments/identify/ground_motion.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::storey_response_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr const char* building = R"toml(
[chain]
masses_kg = [1000, 900, 800]
stiffnesses_n_per_m = [4.0e5, 3.2e5, 2.4e5]
dashpots_n_s_per_m = [800, 640, 480]
[excitation]
kind = "base"
file = "quake.csv"
[simulation]
duration_s = 10
sampling_rate_hz = 1000
[[sensors]]
quantity = "displacement"
position_m = 1
[[sensors]]
quantity = "displacement"
position_m = 2
[[sensors]]
quantity = "displacement"
position_m = 3
)toml";

class SimulatedStoreys : public testing::Test {
 protected:
  SimulatedStoreys() { test::write_ground_motion(place_.path / "quake.csv", 1001); }

  Experiment experiment(const std::string& more) const {
    return read_experiment(TomlTable::parse(std::string(building) + more, "building.toml"));
  }
  SimulatedTest simulated(const std::string& more) const {
    return simulate(experiment(more), place_.path, 0, unwatched);
  }

  TemporaryFolder place_;
};

constexpr const char* cubic =
    "[[chain.storeys]]\nstorey = 1\nlaw = \"duffing\"\ncubic_stiffness_n_per_m3 = 4e8\n";

TEST_F(SimulatedStoreys, OfALinearLawAreTheLinearChain) {
  const SimulatedTest linear = simulated("");
  const SimulatedTest same = simulated("[[chain.storeys]]\nstorey = 2\nlaw = \"linear\"\n");
  EXPECT_EQ(same.record.samples, linear.record.samples);
  // A cubic term too small to count, integrated as a law.
  const SimulatedTest nearly =
      simulated("[[chain.storeys]]\nstorey = 2\nlaw = \"duffing\"\ncubic_stiffness_n_per_m3 = 1e-6\n");
  EXPECT_LT((nearly.record.samples - linear.record.samples).topRows(3).norm(),
            1e-7 * linear.record.samples.topRows(3).norm());
}

// Oracle: the lowest storey's cubic spring holds the first floor against the ground, as a spring of a beam
// may; fem moves it by its own equations and its own integrator.
TEST_F(SimulatedStoreys, MoveAsAFloorOnACubicSpring) {
  const SimulatedTest by_law = simulated(cubic);
  Experiment spring = experiment("");
  fem::Beam chain = spring.structure.beam();
  fem::Spring held;
  held.position = 1.0;
  held.cubic = 4e8;
  chain.springs.push_back(held);
  spring.structure = chain;
  spring.simulation.method = {"cvode", {{"tolerance", 1e-12}, {"absolute_tolerance", 1e-14}}};
  const SimulatedTest by_spring = simulate(spring, place_.path, 0, unwatched);
  const auto expected = by_spring.record.samples.topRows(3);
  EXPECT_GT(4e8 * std::pow(expected.row(0).cwiseAbs().maxCoeff(), 2), 0.3 * 4.0e5);  // not a small term
  EXPECT_LT((by_law.record.samples.topRows(3) - expected).cwiseAbs().maxCoeff(),
            1e-6 * expected.cwiseAbs().maxCoeff());
}

/// Simpson's integral of samples.
double integral(const VectorXd& values, double dt) {
  double sum = 0.0;
  for (Index k = 0; k + 2 < values.size(); k += 2) sum += values[k] + 4.0 * values[k + 1] + values[k + 2];
  return sum * dt / 3.0;
}

/// Work done on 0.2 k d + 0.8 k h, h by Heun's method along the motion.
double work_of_loop(const VectorXd& d, const VectorXd& v, double dt) {
  const auto rate = [](double speed, double h) {
    return speed - 40 * std::abs(speed) * h - 30 * speed * std::abs(h);
  };
  VectorXd power(d.size());
  double h = 0.0;
  for (Index k = 0; k < d.size(); ++k) {
    power[k] = (0.2 * 4.0e5 * d[k] + 0.8 * 4.0e5 * h) * v[k];
    if (k + 1 == d.size()) break;
    const double first = rate(v[k], h), second = rate(v[k + 1], h + dt * first);
    h += 0.5 * dt * (first + second);
  }
  return integral(power, dt);
}

// Oracle: the work of the ground, of the inertia and of the dashpots, all from the motion, against the energy
// that the law's formula stores in the lowest storey, or what its loop, followed by hand, takes.
TEST_F(SimulatedStoreys, KeepTheBalanceOfEnergy) {
  const std::string laws[] = {
      cubic, "[[chain.storeys]]\nstorey = 1\nlaw = \"hyperbolic\"\nreference_drift_m = 0.02\n",
      "[[chain.storeys]]\nstorey = 1\nlaw = \"bouc_wen\"\npost_yield_ratio = 0.2\nhysteresis_beta_per_m = "
      "40\n"
      "hysteresis_gamma_per_m = 30\n"};
  const double m[] = {1000, 900, 800}, k[] = {4.0e5, 3.2e5, 2.4e5}, c[] = {800, 640, 480}, dt = 1e-3;
  for (const std::string& law : laws) {
    const SimulatedTest test = simulated(law);
    const auto& r = test.response;
    const VectorXd ground = test.record.samples.row(3);
    VectorXd power =
        VectorXd::Zero(r.time.size());  // into the springs: ground's less dashpots' less inertia's
    double elastic = 0.0;               // of storeys 2 and 3
    const Index last = r.time.size() - 1;
    for (Index i = 0; i < 3; ++i) {
      const VectorXd v = r.velocity.row(i), a = r.acceleration.row(i);
      const VectorXd dv = i > 0 ? VectorXd(v.transpose() - r.velocity.row(i - 1)) : v;
      power -= m[i] * (ground + a).cwiseProduct(v) + c[i] * dv.cwiseProduct(dv);
      const double drift = r.displacement(i, last) - (i > 0 ? r.displacement(i - 1, last) : 0.0);
      if (i > 0) elastic += 0.5 * k[i] * drift * drift;
    }
    const double into_first = integral(power, dt) - elastic, d = r.displacement(0, last);
    const double input = integral(power.cwiseAbs(), dt);
    if (law == laws[0]) {
      EXPECT_NEAR(into_first, 0.5 * k[0] * d * d + 0.25 * 4e8 * std::pow(d, 4), 1e-5 * input);
    } else if (law == laws[1]) {
      const double x = std::abs(d) / 0.02;
      EXPECT_NEAR(into_first, k[0] * 0.02 * 0.02 * (x - std::log1p(x)), 1e-5 * input);
    } else {
      EXPECT_NEAR(into_first, work_of_loop(r.displacement.row(0), r.velocity.row(0), dt), 1e-4 * input);
    }
  }
}

TEST_F(SimulatedStoreys, SayWhoMovesThem) {
  EXPECT_EQ(simulated(cubic).method.name, "cvode");
  Experiment e = experiment(cubic);
  e.simulation.method.name = "newmark";
  EXPECT_THROW(simulate(e, place_.path, 0, unwatched), std::invalid_argument);
}

// Oracle: what a file may say.
TEST(StoreysInAFile, AreCheckedWhereTheyStand) {
  const auto message = [](const std::string& more) -> std::string {
    try {
      const std::string two = "[chain]\nmasses_kg = [1, 1]\nstiffnesses_n_per_m = [1, 1]\n";
      read_experiment(TomlTable::parse(two + more, "b.toml"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "read";
  };
  using testing::HasSubstr;
  const std::string storey = "[[chain.storeys]]\nstorey = 1\n";
  EXPECT_EQ(message(storey + "law = \"duffing\"\ncubic_stiffness_n_per_m3 = 1\n"), "read");
  EXPECT_THAT(message(storey + "law = \"duffing\"\n"), HasSubstr("cubic_stiffness_n_per_m3"));
  EXPECT_THAT(message(storey + "law = \"dufing\"\n"), HasSubstr("unknown spring law 'dufing'"));
  EXPECT_THAT(message(storey), HasSubstr("law"));
  EXPECT_THAT(message(storey + "law = \"hyperbolic\"\nreference_drift_m = -1\n"), HasSubstr("b.toml:7"));
  EXPECT_THAT(message("[[chain.storeys]]\nstorey = 3\nlaw = \"linear\"\n"),
              HasSubstr("a storey from 1 to 2"));
  EXPECT_THAT(message(storey + "law = \"hyperbolic\"\nreference_drift_m = 1\n" + storey +
                      "law = \"hyperbolic\"\nreference_drift_m = 1\n"),
              HasSubstr("has a law already"));
  EXPECT_THAT(message(storey + "law = \"hyperbolic\"\nreference_drift_m = 1\n[model]\nname = \"sdof\"\n"),
              HasSubstr("Expected [model] name = \"beam\""));
  EXPECT_THAT(message(storey + "law = \"duffing\"\nreference_drift_m = 1\n"), HasSubstr("reference_drift_m"));
}

}  // namespace
}  // namespace beamid::experiments::storey_response_test
