// Strain gauges on the virtual test rig.
#include <gtest/gtest.h>

#include "experiments/rig/simulated_test.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::experiments::strain_gauge_test {
namespace {

Experiment experiment_with(std::vector<Sensor> sensors) {
  Experiment experiment;
  experiment.structure = fem::Beam(test::steel_beam(0.36));
  experiment.damping = fem::ModalDamping{{0.005}};
  experiment.sensors = std::move(sensors);
  experiment.simulation.duration = 0.1;
  experiment.simulation.method.options["modes"] = 0.0;  // all of them
  return experiment;
}

Sensor gauge(double position, double distance) {
  Sensor sensor;
  sensor.position = position;
  sensor.quantity = Quantity::strain;
  sensor.distance = distance;
  return sensor;
}

TEST(StrainGauge, ReadsTheStaticStrainAtTheRelease) {
  // Oracle: w'' = 3 d (L - x) / L^3 under a tip force; the strain of a fibre at distance c is -c w''. Twelve
  // modes leave 1e-3 of it.
  const SimulatedTest test =
      simulate(experiment_with({gauge(0.0, 0.003), gauge(0.3, -0.002), Sensor{}}), ".", 0, [](auto&&...) {});
  const auto strain = [](double x, double c) { return -c * 3.0 * 0.012 * (1.1 - x) / (1.1 * 1.1 * 1.1); };
  EXPECT_NEAR(test.record.samples(0, 0), strain(0.0, 0.003), 1e-9 * std::abs(strain(0.0, 0.003)));
  EXPECT_NEAR(test.record.samples(1, 0), strain(0.3, -0.002), 1e-9 * std::abs(strain(0.3, -0.002)));
  EXPECT_EQ(test.record.channels[0].name, "root");
  EXPECT_EQ(test.record.channels[0].position, 0.0);
  EXPECT_EQ(test.record.channels[0].distance, 0.003);
  EXPECT_EQ(test.record.channels[1].name, "x0.3m");
  EXPECT_EQ(test.record.channels[2].quantity, Quantity::acceleration);
}

TEST(StrainGauge, LeavesTheOtherSensorsAsTheyAre) {
  // Oracle: the same test without the gauge, on the same mesh: it has a node at the root anyway.
  const auto quiet = [](auto&&...) {};
  const SimulatedTest with = simulate(experiment_with({Sensor{}, gauge(0.0, 0.003)}), ".", 0, quiet);
  const SimulatedTest without = simulate(experiment_with({Sensor{}}), ".", 0, quiet);
  EXPECT_EQ(with.record.samples.row(0), without.record.samples.row(0));
}

}  // namespace
}  // namespace beamid::experiments::strain_gauge_test
