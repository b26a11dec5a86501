// What cheap sensors do to the written record. Oracles: the shares that were asked for, counted in the
// record; the same test read by a perfect instrument.
#include "experiments/rig/virtual_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/rig/simulated_test.hpp"
#include "experiments/signal/toolbox.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::experiments::acquisition_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

VectorXd steps_of(const VectorXd& time) {
  return time.tail(time.size() - 1) - time.head(time.size() - 1);
}

double deviation(const VectorXd& values) {
  return std::sqrt((values.array() - values.mean()).square().mean());
}

class Jitter : public testing::TestWithParam<double> {};

// 20,000 intervals: standard errors of 0.2 % of the mean for the median, 1 to 2 % for the deviation
TEST_P(Jitter, HasTheMeanTheDeviationAndTheMedianAskedFor) {
  Acquisition acquisition;
  acquisition.jitter = 0.35;
  acquisition.median_shortfall = GetParam();
  const VectorXd time = sample_instants(acquisition, 20001, 200.0, 3), intervals = 200.0 * steps_of(time);
  EXPECT_EQ(time[0], 0.0);
  EXPECT_NEAR(time[20000], 100.0, 1e-9);
  EXPECT_GT(intervals.minCoeff(), 0.0);
  EXPECT_NEAR(deviation(intervals), 0.35, 0.02);
  EXPECT_NEAR(1 - median(intervals), GetParam(), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Shortfalls, Jitter, testing::Values(0.0, 0.015, 0.05, 0.14));

TEST(SampleInstants, RefuseAMedianThatNoJitterOfThisKindHas) {
  Acquisition acquisition;
  acquisition.jitter = 0.1;
  acquisition.median_shortfall = 0.05;
  EXPECT_THROW(sample_instants(acquisition, 100, 200.0, 3), std::invalid_argument);
}

Experiment rig() {
  Experiment experiment;
  experiment.structure = fem::Beam(test::steel_beam(0.360490));
  experiment.damping = fem::ModalDamping{{0.005}};
  experiment.excitation.deflection = 0.012;
  Sensor sensor;
  sensor.quantity = Quantity::displacement;
  experiment.sensors = {sensor};
  experiment.simulation.duration = 10;
  experiment.simulation.sampling_rate = 250;
  experiment.simulation.method.options["modes"] = 3.0;
  return experiment;
}

Record recorded(const Experiment& experiment, const Acquisition& acquisition) {
  return simulate(
             experiment, ".", 0, [](auto&&...) {}, acquisition)
      .record;
}

Record recorded(const SensorDefects& sensor) {
  Acquisition acquisition;
  acquisition.sensors = {sensor};
  return recorded(rig(), acquisition);
}

VectorXd perfect() {
  return recorded(rig(), {}).samples.row(0).transpose();
}

TEST(Acquisition, IsPerfectUnlessToldOtherwise) {
  const Record record = recorded(rig(), {});
  EXPECT_EQ(record.size(), 2501);
  EXPECT_NEAR(record.time[2500], 10.0, 1e-12);
  EXPECT_EQ(recorded(SensorDefects{}).samples, record.samples);
}

// The motion itself, at other instants: steps of 1 / (8 rate), a spline between them.
TEST(Acquisition, ReadsTheMotionAtItsUnevenStamps) {
  Acquisition acquisition;
  acquisition.jitter = 0.3;
  acquisition.median_shortfall = 0.09;
  const Record uneven = recorded(rig(), acquisition);
  ASSERT_EQ(uneven.size(), 2501);
  Experiment fine = rig();
  fine.simulation.sampling_rate = 250 * 64;
  const Record exact = recorded(fine, {});
  for (Index k = 0; k < uneven.size(); k += 25) {
    const double at = uneven.time[k] * 250 * 64;
    const auto i = std::min<Index>(static_cast<Index>(at), exact.size() - 2);
    const double part = at - static_cast<double>(i);
    EXPECT_NEAR(uneven.samples(0, k), (1 - part) * exact.samples(0, i) + part * exact.samples(0, i + 1),
                2e-8);
  }
}

TEST(Acquisition, BeginsBeforeTheRelease) {
  Acquisition acquisition;
  acquisition.pretrigger = 0.5;
  Experiment experiment = rig();
  experiment.sensors.push_back({});  // an accelerometer
  const Record record = recorded(experiment, acquisition), after = recorded(experiment, {});
  EXPECT_EQ(record.size(), after.size() + 125);
  EXPECT_EQ(record.samples.row(0).head(125), Eigen::RowVectorXd::Constant(125, after.samples(0, 0)));
  EXPECT_EQ(record.samples.row(1).head(125), Eigen::RowVectorXd::Zero(125));
  EXPECT_EQ(record.samples.rightCols(after.size()), after.samples);
}

TEST(Acquisition, LosesSamplesInGaps) {
  Acquisition acquisition;
  acquisition.gaps = 5;
  acquisition.gap = {0.05, 0.3};
  const Record record = recorded(rig(), acquisition);
  const VectorXd steps = steps_of(record.time);
  Index gaps = 0;
  for (const double step : steps) {
    if (step < 0.005) continue;
    ++gaps;
    EXPECT_GE(step, 0.05 - 1e-9);
    EXPECT_LE(step, 0.3 + 2 * 0.004);
  }
  EXPECT_EQ(gaps, 5);
  EXPECT_EQ(record.samples.cols(), record.size());
}

// 2500 samples of 4 %: 100 +- 10
TEST(Acquisition, RepeatsSamples) {
  Acquisition acquisition;
  acquisition.repeated = 0.04;
  const Record record = recorded(rig(), acquisition);
  const Eigen::RowVectorXd shown = record.samples.row(0);
  const auto repeats = (shown.tail(shown.size() - 1).array() == shown.head(shown.size() - 1).array()).count();
  EXPECT_NEAR(static_cast<double>(repeats), 100.0, 40.0);
  EXPECT_EQ(recorded(rig(), acquisition).samples, record.samples);
}

TEST(SensorDefects, ClipAndRound) {
  SensorDefects sensor;
  sensor.clipping = 0.6;
  const VectorXd truth = perfect(), clipped = recorded(sensor).samples.row(0).transpose();
  const double largest = truth.cwiseAbs().maxCoeff();
  EXPECT_EQ(clipped, truth.cwiseMax(-0.6 * largest).cwiseMin(0.6 * largest));
  EXPECT_GT((truth - clipped).cwiseAbs().maxCoeff(), 0.3 * largest);
  SensorDefects coarse;
  coarse.resolution = 0.1;
  const VectorXd rounded = recorded(coarse).samples.row(0).transpose() / (0.1 * largest);
  EXPECT_NEAR((rounded.array() - rounded.array().round()).abs().maxCoeff(), 0.0, 1e-9);
  EXPECT_LE((0.1 * largest * rounded - truth).cwiseAbs().maxCoeff(), 0.0501 * largest);
}

TEST(SensorDefects, DriftAndStartUp) {
  SensorDefects sensor;
  sensor.offset = 0.1;
  sensor.drift = -0.4;
  sensor.startup = 2.0;
  sensor.startup_time = 0.25;
  const VectorXd truth = perfect(),
                 added = (recorded(sensor).samples.row(0).transpose() - truth) / truth.cwiseAbs().maxCoeff();
  EXPECT_NEAR(added[0], 2.1, 1e-12);
  EXPECT_NEAR(added[250], 0.1 - 0.04 + 2.0 * std::exp(-4.0), 1e-12);
  EXPECT_NEAR(added[2500], -0.3, 1e-12);
}

TEST(SensorDefects, RattleWhereTheMotionIsLarge) {
  SensorDefects sensor;
  sensor.rattle = 0.2;
  sensor.rattle_above = 0.5;
  const VectorXd truth = perfect() / perfect().cwiseAbs().maxCoeff(),
                 added =
                     recorded(sensor).samples.row(0).transpose() / perfect().cwiseAbs().maxCoeff() - truth;
  double squares = 0, count = 0;
  for (Index k = 0; k < truth.size(); ++k) {
    if (std::abs(truth[k]) <= 0.5) {
      EXPECT_NEAR(added[k], 0.0, 1e-12);
    } else {
      squares += added[k] * added[k], count += 1;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.2, 4 * 0.2 / std::sqrt(2 * count));
}

TEST(SensorDefects, LeaveADeadChannelItsOffset) {
  SensorDefects sensor;
  sensor.dead = true;
  sensor.offset = 0.5;
  EXPECT_EQ(recorded(sensor).samples,
            Eigen::RowVectorXd::Constant(2501, 0.5 * perfect().cwiseAbs().maxCoeff()));
}

// A force that falls along half a cosine over T leaves of a mode w the share |cos(w T / 2)| / |1 - (w T /
// pi)^2|.
TEST(SlowRelease, LeavesTheClosedFormsShareOfTheMotion) {
  Experiment experiment = rig();
  experiment.damping = fem::Undamped{};
  experiment.simulation.method.options["modes"] = 1.0;
  const double f = 3.455527194845, duration = 0.8 / f, turn = 2 * std::numbers::pi * 0.8;
  experiment.excitation.duration = duration;
  const double slow = recorded(experiment, {}).samples.row(0).tail(1000).cwiseAbs().maxCoeff();
  experiment.excitation.duration = 0.0;
  const double whole = recorded(experiment, {}).samples.row(0).tail(1000).cwiseAbs().maxCoeff();
  EXPECT_NEAR(slow / whole, std::abs(std::cos(turn / 2) / (1 - std::pow(turn / std::numbers::pi, 2))), 1e-3);
}

// Air drag c2 x' |x'|: xi + 4 c2 A / (3 pi M) at amplitude A [first order in both].
TEST(QuadraticDashpot, LetsTheDampingFallWithAmplitude) {
  Experiment experiment = rig();
  constexpr double mass = 1.109401, amplitude = 0.0118415, w = 2 * std::numbers::pi * 3.455527194845;
  experiment.damping = fem::CaugheyDamping{{{3.455527194845, 0.002}}};
  experiment.structure.beam().dashpots.push_back(
      {1.10, 0.0, 0.0, 0.005 * 3 * std::numbers::pi * mass / (4 * amplitude)});
  experiment.excitation.mode = 1;
  experiment.excitation.kind = Excitation::Kind::free;
  experiment.excitation.deflection = amplitude;
  experiment.simulation.method = {"newmark", {}};
  experiment.simulation.sampling_rate = 1000;
  experiment.simulation.duration = 30;
  const VectorXd x = recorded(experiment, {}).samples.row(0).transpose();
  struct Peak {
    double time = 0, size = 0;
  };
  const auto peak_behind = [&](double from) {
    Index at = 0;
    const auto first = static_cast<Index>(1000 * from);
    const double size = x.segment(first, 600).cwiseAbs().maxCoeff(&at);
    return Peak{static_cast<double>(first + at) / 1000, size};
  };
  // A' = -w (xi + k A) A: A / (xi + k A) falls as e^(-w xi t)
  const auto ratio = [&](double a) { return a / (0.002 + 0.005 * a / amplitude); };
  for (const double from : {0.0, 10.0, 20.0}) {
    const Peak one = peak_behind(from), other = peak_behind(from + 8);
    EXPECT_NEAR(std::log(ratio(one.size) / ratio(other.size)) / ((other.time - one.time) * w), 0.002, 2e-5)
        << from;
  }
}

}  // namespace
}  // namespace beamid::experiments::acquisition_test
