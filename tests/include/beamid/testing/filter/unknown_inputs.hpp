// Inputs that nobody measured.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <random>

#include "beamid/testing/every_filter.hpp"
#include "beamid/testing/forced_oscillator.hpp"
#include "filters/latent_inputs.hpp"

namespace beamid::test::unknown_inputs {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

TEST_P(EveryFilter, FindsAnInputThatNobodyMeasuredIfItEstimatesInputs) {
  // Oracle: the force itself, random and held between samples, within a tenth of its rms. Displacement and
  // acceleration are read; the latter's noise alone makes an error of 1 N of 40 N.
  if (!declares(filters::contract::unknown_inputs)) GTEST_SKIP() << "not promised";
  constexpr double dt = 0.005, size = 40.0;
  constexpr Index samples = 2000;
  const Vector2d sensors(1e-4, 0.5);
  const auto model = [&] {
    filters::Noise noise{MatrixXd::Zero(4, 4), sensors.cwiseAbs2().asDiagonal().toDenseMatrix()};
    noise.process(2, 2) = size * size;
    return filters::discretise(
        std::make_shared<filters::LatentInputs>(
            std::make_shared<ForcedOscillator>("xa"),
            std::vector<filters::LatentInput>{{0, filters::LatentInput::Process::random_walk, size, 1.0}}),
        dt, "exponential", noise);
  };
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  filters::Measurements record{
      VectorXd::LinSpaced(samples, 0.0, dt * static_cast<double>(samples - 1)), MatrixXd(2, samples), {}};
  const auto plant = model();
  VectorXd force(samples), z(4), y, next;
  z << 0.0, 0.0, 0.0, ForcedOscillator::stiffness;
  for (Index k = 0; k < samples; ++k) {
    force[k] = z[2] = size * normal(random);
    plant->output(z, VectorXd::Zero(1), y);
    record.outputs.col(k) = y + sensors.cwiseProduct(Vector2d(normal(random), normal(random)));
    plant->transition(z, VectorXd::Zero(1), next);
    z = next;
  }
  filters::Gaussian estimate{VectorXd::Zero(4), MatrixXd::Zero(4, 4), {}};
  estimate.mean[3] = ForcedOscillator::stiffness;
  estimate.covariance.diagonal() << 1e-6, 1e-4, size * size, 0.0;
  const auto filter = filters::filter_registry().make(GetParam(), {}, model());
  const filters::FilterRun found = filters::run(*filter, estimate, record, filters::Keep::last_estimate,
                                                filters::Start::at_first_sample, {{2}});
  ASSERT_FALSE(found.failure);
  const VectorXd error = (found.means.row(0).transpose() - force).tail(samples - 200);
  EXPECT_LT(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())), 0.1 * size);
}

}  // namespace beamid::test::unknown_inputs
