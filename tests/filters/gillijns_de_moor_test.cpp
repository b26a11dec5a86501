// The unbiased minimum-variance filter for unknown inputs, and the dual Kalman filter beside it.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "beamid/testing/forced_oscillator.hpp"
#include "filters/filter_run.hpp"
#include "filters/latent_inputs.hpp"

namespace beamid::gillijns_de_moor_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;
using Oscillator = test::ForcedOscillator;

constexpr double dt = 0.005;
const Vector2d motion_noise(2e-5, 1e-3);  // deviations of x and v, from sample to sample
constexpr double start_deviations[] = {0.01, 0.3};

double sensor_noise(char sensor) {
  return sensor == 'x' ? 1e-4 : 0.5;
}

// z = [x, v, d; k]: the force d is held between samples, and a new one at each.
std::unique_ptr<filters::DiscreteModel> model(const std::string& sensors, double walk = 40.0) {
  const auto latent = std::make_shared<filters::LatentInputs>(
      std::make_shared<Oscillator>(sensors),
      std::vector<filters::LatentInput>{{0, filters::LatentInput::Process::random_walk, walk, 1.0}});
  const auto p = static_cast<Index>(sensors.size());
  filters::Noise noise{MatrixXd::Zero(4, 4), MatrixXd::Zero(p, p)};
  noise.process.diagonal() << motion_noise.cwiseAbs2(), walk * walk, 0.0;
  for (Index i = 0; i < p; ++i)
    noise.output(i, i) = std::pow(sensor_noise(sensors[static_cast<std::size_t>(i)]), 2);
  return filters::discretise(latent, dt, "exponential", noise);
}

filters::Gaussian start(double stiffness_deviation = 0.0, double stiffness = Oscillator::stiffness) {
  filters::Gaussian estimate{VectorXd::Zero(4), MatrixXd::Zero(4, 4), {}};
  estimate.mean[3] = stiffness;
  estimate.covariance.diagonal() << std::pow(start_deviations[0], 2), std::pow(start_deviations[1], 2),
      1600.0, stiffness_deviation * stiffness_deviation;
  return estimate;
}

struct Simulated {
  filters::Measurements record;
  VectorXd force;  // (N)
};

// The model itself, by its own transition; forces independent from sample to sample.
Simulated simulate(const std::string& sensors, Index samples, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto plant = model(sensors);
  const auto p = static_cast<Index>(sensors.size());
  Simulated result{
      {VectorXd::LinSpaced(samples, 0.0, dt * static_cast<double>(samples - 1)), MatrixXd(p, samples), {}},
      VectorXd(samples)};
  VectorXd z(4), next, y;
  z << start_deviations[0] * normal(random), start_deviations[1] * normal(random), 0.0, Oscillator::stiffness;
  for (Index k = 0; k < samples; ++k) {
    result.force[k] = z[2] = 40.0 * normal(random);
    plant->output(z, VectorXd::Zero(1), y);
    for (Index i = 0; i < p; ++i)
      result.record.outputs(i, k) =
          y[i] + sensor_noise(sensors[static_cast<std::size_t>(i)]) * normal(random);
    plant->transition(z, VectorXd::Zero(1), next);
    z = next;
    z[0] += motion_noise[0] * normal(random);
    z[1] += motion_noise[1] * normal(random);
  }
  return result;
}

filters::FilterRun filtered(const char* name, const std::string& sensors, const filters::Measurements& record,
                            const filters::Gaussian& estimate = start()) {
  const auto filter = filters::filter_registry().make(name, {}, model(sensors));
  return filters::run(*filter, estimate, record, filters::Keep::all_estimates);
}

// All at once: x_0, the noise of every step and the force of every sample as the unknowns of one weighted
// linear least-squares problem, of which the motion of the last sample and a force are linear functions.
struct BatchEstimate {
  Eigen::Vector3d value, deviation;  // x, v of the last sample; force of sample `at`
};
BatchEstimate batch_estimate(const std::string& sensors, const filters::Measurements& record, Index at) {
  const auto plant = model(sensors);
  const Index n = record.size(), p = record.outputs.rows(), forces = 2 * n, all = forces + n;
  const VectorXd none = VectorXd::Zero(1);
  VectorXd z = start().mean, next;
  MatrixXd tangent, sensor;
  plant->linearised_transition(z, none, next, tangent);
  plant->output_jacobian(z, none, sensor);
  MatrixXd motion = MatrixXd::Zero(2, all);  // x_k of the unknowns, in deviations
  motion(0, 0) = start_deviations[0], motion(1, 1) = start_deviations[1];
  // A force that no reading shows has no place in the problem: the last one where nothing reads it at once.
  const bool direct = !sensor.col(2).isZero(0.0);
  const Index used = direct ? all : all - 1;
  MatrixXd rows = MatrixXd::Zero(forces + p * n, all);
  VectorXd right = VectorXd::Zero(rows.rows());
  rows.topLeftCorner(forces, forces).setIdentity();
  for (Index k = 0; k < n; ++k) {
    if (k > 0) {
      motion = (tangent.topLeftCorner(2, 2) * motion).eval();
      motion.col(forces + k - 1) += tangent.block(0, 2, 2, 1);
      motion(0, 2 * k) += motion_noise[0];
      motion(1, 2 * k + 1) += motion_noise[1];
    }
    for (Index i = 0; i < p; ++i) {
      const double weight = 1.0 / sensor_noise(sensors[static_cast<std::size_t>(i)]);
      rows.row(forces + p * k + i) = weight * sensor.block(i, 0, 1, 2) * motion;
      rows(forces + p * k + i, forces + k) += weight * sensor(i, 2);
      right[forces + p * k + i] = weight * record.outputs(i, k);
    }
  }
  MatrixXd wanted = MatrixXd::Zero(3, all);
  wanted.topRows(2) = motion;
  wanted(2, forces + at) = 1.0;
  const Eigen::HouseholderQR<MatrixXd> factor(rows.leftCols(used));
  const VectorXd found = factor.solve(right);
  const MatrixXd r = factor.matrixQR().topRows(used).triangularView<Eigen::Upper>();
  const MatrixXd spread =
      r.transpose().triangularView<Eigen::Lower>().solve(wanted.leftCols(used).transpose());
  return {wanted.leftCols(used) * found, spread.colwise().norm().transpose()};
}

TEST(GillijnsDeMoor, IsTheLeastSquaresEstimateWhereSensorsReadTheForceAtOnce) {
  // Oracle: all 60 samples as one weighted least-squares problem in which nothing is known of any force.
  const auto [record, force] = simulate("xa", 60, 3);
  const filters::Gaussian last = filtered("gillijns_de_moor", "xa", record).last;
  const BatchEstimate expected = batch_estimate("xa", record, 59);
  for (Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(last.mean[i], expected.value[i],
                1e-10 * expected.deviation[i] + 1e-10 * std::abs(expected.value[i]));
    EXPECT_NEAR(last.deviations()[i], expected.deviation[i], 1e-10 * expected.deviation[i]);
  }
}

TEST(GillijnsDeMoor, IsTheLeastSquaresEstimateOfTheForceBeforeWhereOnlyMotionShowsIt) {
  // Oracle: likewise, of displacements alone, the force of the sample before the last.
  const auto [record, force] = simulate("xx", 60, 4);
  const filters::FilterRun run = filtered("gillijns_de_moor", "xx", record);
  const BatchEstimate expected = batch_estimate("xx", record, 58);
  for (Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(run.last.mean[i], expected.value[i], 1e-7 * expected.deviation[i]);
    EXPECT_NEAR(run.last.deviations()[i], expected.deviation[i], 1e-7 * expected.deviation[i]);
  }
  ASSERT_EQ(run.remarks.size(), 1U);
  EXPECT_NE(run.remarks[0].find("the interval before"), std::string::npos);
}

TEST(GillijnsDeMoor, ErrsAsItsDeviationsSay) {
  // Oracle: 300 seeded records of 40 samples. The mean of error^2 / variance of force, x and v at the last
  // sample is 1 within 3 standard errors, and the rms error of the force within 5 % of the least-squares
  // deviation.
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  double force_squares = 0.0;
  constexpr int records = 300;
  for (unsigned seed = 1; seed <= records; ++seed) {
    const auto [record, force] = simulate("xa", 40, seed);
    const filters::Gaussian last = filtered("gillijns_de_moor", "xa", record).last;
    const double error = last.mean[2] - force[39];
    squares[2] += error * error / last.covariance(2, 2);
    force_squares += error * error;
  }
  EXPECT_NEAR(squares[2] / records, 1.0, 3.0 * std::sqrt(2.0 / records));
  const double least = batch_estimate("xa", simulate("xa", 40, 1).record, 39).deviation[2];
  EXPECT_NEAR(std::sqrt(force_squares / records) / least, 1.0, 3.0 / std::sqrt(2.0 * records));
}

TEST(GillijnsDeMoor, IsNotMovedByWhatIsAssumedOfTheForce) {
  // Oracle: a walk a million times wider changes nothing but the weight of innovations.
  const auto [record, force] = simulate("xa", 100, 7);
  const auto narrow = filters::filter_registry().make("gillijns_de_moor", {}, model("xa", 1e-3));
  const auto wide = filters::filter_registry().make("gillijns_de_moor", {}, model("xa", 1e3));
  const filters::Gaussian one = filters::run(*narrow, start(), record).last,
                          other = filters::run(*wide, start(), record).last;
  EXPECT_LT((one.mean - other.mean).cwiseAbs().maxCoeff(), 1e-9 * one.mean.cwiseAbs().maxCoeff());
}

TEST(GillijnsDeMoor, FindsTheStiffnessUnderAForceThatNobodyMeasured) {
  // Oracle: the truth, within four of its deviations, from a guess 20 % off.
  const auto [record, force] = simulate("xa", 4000, 8);
  const filters::FilterRun run = filtered("gillijns_de_moor", "xa", record,
                                          start(0.2 * Oscillator::stiffness, 1.2 * Oscillator::stiffness));
  ASSERT_FALSE(run.failure);
  const double deviation = run.last.deviations()[3];
  EXPECT_NEAR(run.last.mean[3], Oscillator::stiffness, 4.0 * deviation);
  EXPECT_LT(deviation, 0.02 * Oscillator::stiffness);
}

TEST(GillijnsDeMoor, GoesOnByTheProcessWhereReadingsAreMissing) {
  auto [record, force] = simulate("xa", 200, 9);
  for (Index k = 50; k < 60; ++k) record.outputs.col(k).setConstant(std::nan(""));
  for (Index k = 70; k < 80; ++k) record.outputs(1, k) = std::nan("");
  const filters::FilterRun run = filtered("gillijns_de_moor", "xa", record);
  ASSERT_FALSE(run.failure);
  EXPECT_LT(std::abs(run.last.mean[2] - force[199]), 4.0 * run.last.deviations()[2]);
}

TEST(GillijnsDeMoor, RefusesInputsThatAreKnownBeforehand) {
  const auto matern = std::make_shared<filters::LatentInputs>(std::make_shared<Oscillator>(),
                                                              std::vector<filters::LatentInput>{{0}});
  for (const char* name : {"gillijns_de_moor", "dual_kf"}) {
    EXPECT_THROW(
        filters::filter_registry().make(
            name, {}, filters::discretise(matern, dt, "exponential", {{}, MatrixXd::Identity(2, 2)})),
        std::invalid_argument);
    EXPECT_THROW(filters::filter_registry().make(name, {{"inputs", std::vector<double>{2.5}}}, model("xa")),
                 std::invalid_argument);
  }
}

TEST(DualKf, SaysThatDisplacementsAloneShowItNoForce) {
  const filters::FilterRun run = filtered("dual_kf", "xx", simulate("xx", 50, 6).record);
  ASSERT_EQ(run.remarks.size(), 2U);
  EXPECT_NE(run.remarks[1].find("not estimated at all"), std::string::npos);
}

}  // namespace
}  // namespace beamid::gillijns_de_moor_test
