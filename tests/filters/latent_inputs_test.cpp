// Inputs that nobody measured, as random processes beside the motion.
#include "filters/latent_inputs.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <unsupported/Eigen/MatrixFunctions>

#include "beamid/testing/forced_oscillator.hpp"
#include "filters/linear_gaussian.hpp"

namespace beamid::latent_inputs_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;
using filters::LatentInput;

using Oscillator = test::ForcedOscillator;
constexpr double mass = Oscillator::mass, damping = Oscillator::damping, stiffness = Oscillator::stiffness;

filters::LatentInputs with(LatentInput::Process process) {
  return {std::make_shared<Oscillator>(), {{0, process, 40.0, 0.03}}};
}

const LatentInput::Process processes[] = {  // stationary ones
    LatentInput::Process::ornstein_uhlenbeck, LatentInput::Process::matern};

VectorXd state_of(const filters::LatentInputs& model) {
  VectorXd state = VectorXd::LinSpaced(model.motion_size() + 1, 0.3, -0.2);
  state[model.moved(2)] = stiffness;
  return state;
}

// The covariance that motion and force keep: A P + P A^T + L L^T = 0, as one linear system.
MatrixXd stationary(const MatrixXd& a, const MatrixXd& intensity) {
  const Index n = a.rows();
  const MatrixXd one = MatrixXd::Identity(n, n);
  MatrixXd sum = MatrixXd::Zero(n * n, n * n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      sum.block(i * n, j * n, n, n) = a(i, j) * one + (i == j ? a : MatrixXd::Zero(n, n));
  const VectorXd found = sum.partialPivLu().solve(-intensity.reshaped());
  return found.reshaped(n, n);
}

TEST(LatentInputs, KeepTheCovarianceThatMotionAndForceHaveForEver) {
  // Oracle: the Lyapunov equation of continuous time. The force's own variance in it is sigma^2.
  for (const auto process : processes) {
    const filters::LatentInputs model = with(process);
    const VectorXd state = state_of(model);
    const Index n = model.motion_size();
    MatrixXd a;
    model.motion_matrix(state, a);
    const double rate = process == LatentInput::Process::matern ? std::sqrt(3.0) / 0.03 : 1.0 / 0.03;
    MatrixXd intensity = MatrixXd::Zero(n, n);
    intensity(n - 1, n - 1) = (n == 4 ? 4.0 : 2.0) * rate * 1600.0;
    const MatrixXd p = stationary(a, intensity);
    EXPECT_NEAR(p(2, 2), 1600.0, 1e-8);
    const MatrixXd moved = (a * 0.01).exp();
    const MatrixXd next =
        moved * p * moved.transpose() + model.process_noise(state, 0.01).topLeftCorner(n, n);
    EXPECT_LT((next - p).cwiseAbs().maxCoeff(), 1e-9 * p.cwiseAbs().maxCoeff());
  }
}

TEST(LatentInputs, HaveTheCovarianceFunctionTheyAreNamedAfter) {
  // Oracle: sigma^2 e^(-t/tau), sigma^2 (1 + l t) e^(-l t).
  const double t = 0.02;
  for (const auto process : processes) {
    const filters::LatentInputs model = with(process);
    MatrixXd a;
    model.motion_matrix(state_of(model), a);
    const double found = 1600.0 * MatrixXd((a * t).exp())(2, 2);
    const double l = std::sqrt(3.0) / 0.03;
    const double expected = process == LatentInput::Process::matern
                                ? 1600.0 * (1.0 + l * t) * std::exp(-l * t)
                                : 1600.0 * std::exp(-t / 0.03);
    EXPECT_NEAR(found, expected, 1e-9 * 1600.0);
  }
}

TEST(LatentInputs, HaveTheDerivativesOfTheirMotionAndOutput) {
  // Oracle: central differences.
  for (const auto process : processes) {
    const auto model = std::make_shared<filters::LatentInputs>(with(process));
    const VectorXd state = state_of(*model), none = VectorXd::Zero(1);
    const auto discrete = filters::discretise(model, 0.01, "exponential", {{}, MatrixXd::Identity(2, 2)});
    VectorXd next, above, below;
    MatrixXd moved, shown, by_differences(state.size(), state.size()), seen(2, state.size());
    discrete->linearised_transition(state, none, next, moved);
    model->output_jacobian(state, none, shown);
    for (Index j = 0; j < state.size(); ++j) {
      const double step = 1e-5 * std::max(1.0, std::abs(state[j]));
      VectorXd there = state;
      there[j] += step;
      discrete->transition(there, none, above);
      there[j] -= 2.0 * step;
      discrete->transition(there, none, below);
      by_differences.col(j) = (above - below) / (2.0 * step);
      model->output(there, none, below);
      there[j] += 2.0 * step;
      model->output(there, none, above);
      seen.col(j) = (above - below) / (2.0 * step);
    }
    EXPECT_LT((moved - by_differences).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_LT((shown - seen).cwiseAbs().maxCoeff(), 1e-6 * shown.cwiseAbs().maxCoeff());
  }
}

TEST(LatentInputs, AreEstimatedAsWellAsTheirDeviationSays) {
  // Oracle: 300 seeded records, the force and the motion drawn at a twentieth of the sampling interval. The
  // mean of (error / deviation)^2 over independent records is 1 to 3 / sqrt(150) = 0.25, the error's own
  // rms over the deviation 1 to 5 %.
  constexpr int records = 300, fine = 20;
  constexpr Index samples = 120;
  constexpr double dt = 0.005;
  const auto model = std::make_shared<filters::LatentInputs>(with(LatentInput::Process::matern));
  const VectorXd state = state_of(*model);
  MatrixXd a;
  model->motion_matrix(state, a);
  const MatrixXd step = (a * (dt / fine)).exp();
  const MatrixXd noise = model->process_noise(state, dt / fine).topLeftCorner(4, 4);
  const Eigen::LDLT<MatrixXd> factor(noise);
  const MatrixXd spread =
      factor.transpositionsP().transpose() *
      (MatrixXd(factor.matrixL()) * factor.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal());
  const Vector2d sensors(1e-4, 0.5);

  filters::Gaussian known{VectorXd::Zero(3), MatrixXd::Zero(3, 3), {}};
  known.covariance.diagonal() << 0.01, 1.0, 1.0;
  const auto discrete = filters::discretise(
      model, dt, "exponential",
      {model->process_noise(state, dt), sensors.cwiseAbs2().asDiagonal().toDenseMatrix()});
  const filters::LinearGaussian form = filters::linear_gaussian(
      *discrete, {4}, VectorXd::Constant(1, stiffness), model->with_latent(known), 0);

  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  double squares = 0.0, deviation = 0.0;
  for (int i = 0; i < records; ++i) {
    VectorXd z(4);
    z << 0.1 * normal(random), normal(random), 40.0 * normal(random), 40.0 * normal(random);
    filters::Measurements record{VectorXd::LinSpaced(samples, 0.0, dt * static_cast<double>(samples - 1)),
                                 MatrixXd(2, samples), MatrixXd(0, samples)};
    double truth = 0.0;
    for (Index k = 0; k < samples; ++k) {
      const double acceleration = (z[2] - damping * z[1] - stiffness * z[0]) / mass;
      record.outputs.col(k) =
          Vector2d(z[0] + sensors[0] * normal(random), acceleration + sensors[1] * normal(random));
      if (k == samples / 2) truth = z[2];
      for (int j = 0; j < fine; ++j) {
        VectorXd draw(4);
        for (double& one : draw) one = normal(random);
        z = (step * z + spread * draw).eval();
      }
    }
    const filters::KalmanPass pass = filters::kalman_pass(form, record, dt);
    MatrixXd row = MatrixXd::Zero(1, 4);
    row(0, 2) = 1.0;
    const filters::SmoothedRows found = filters::smoothed_rows(form, record, pass, row, {});
    const double error = found.means(0, samples / 2) - truth;
    deviation = found.deviations(0, samples / 2);
    squares += error * error / (deviation * deviation);
  }
  EXPECT_NEAR(squares / records, 1.0, 3.0 * std::sqrt(2.0 / records));
  EXPECT_LT(deviation, 0.1 * 40.0);
}

TEST(LatentInputs, WalkAtRandomByTheirDeviationWithinTheirTime) {
  // Oracle: white noise of intensity q = sigma^2 / tau, so that the variance of force, velocity and
  // displacement of a free mass grow by q t, q t^3 / (3 m^2), q t^5 / (20 m^2).
  const filters::LatentInputs model = with(LatentInput::Process::random_walk);
  VectorXd state = VectorXd::Zero(4);
  const double t = 1e-4, q = 1600.0 / 0.03;
  const MatrixXd noise = model.process_noise(state, t);
  EXPECT_NEAR(noise(2, 2), q * t, 1e-9 * q * t);
  EXPECT_NEAR(noise(1, 1), q * t * t * t / (3.0 * mass * mass), 1e-3 * noise(1, 1));
  EXPECT_NEAR(noise(0, 0), q * std::pow(t, 5) / (20.0 * mass * mass), 1e-3 * noise(0, 0));
}

TEST(LatentInputs, RefuseAnInputThatDoesNotExist) {
  EXPECT_THROW(filters::LatentInputs(std::make_shared<Oscillator>(), {{1}}), std::invalid_argument);
  EXPECT_THROW(filters::LatentInputs(std::make_shared<Oscillator>(), {{0}, {0}}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::latent_inputs_test
