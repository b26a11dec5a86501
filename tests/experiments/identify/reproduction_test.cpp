// Oracle: the free decay of one degree of freedom in closed form.
#include "experiments/identify/verdict/reproduction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/models/oscillator.hpp"
#include "tests/experiments/models/one_coordinate.hpp"

namespace beamid::experiments::reproduction_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double dt = 0.001, amplitude = 0.012, bias = 0.3;
const Oscillator truth = Oscillator::from_frequency(3.0, 13.0, 0.02);

// Acceleration of the decay from `amplitude`, on an accelerometer with a bias, and its displacement.
filters::Measurements decay(Index samples) {
  const std::complex<double> lambda = truth.eigenvalue();
  filters::Measurements record{
      VectorXd::LinSpaced(samples, 0.0, dt * static_cast<double>(samples - 1)), MatrixXd(2, samples), {}};
  for (Index k = 0; k < samples; ++k) {
    // x = Re(a e^(lambda t)) with x(0) = amplitude and x'(0) = 0
    const std::complex<double> a(amplitude, amplitude * lambda.real() / lambda.imag());
    const std::complex<double> x = a * std::exp(lambda * record.time[k]);
    record.outputs.col(k) << (lambda * lambda * x).real() + bias, x.real();
  }
  return record;
}

struct Case {
  std::unique_ptr<JointModel> model =
      model_registry().make("sdof", {},
                            at_one_point(test::one_coordinate(3.0, truth.stiffness),
                                         {Quantity::acceleration, Quantity::displacement}));
  std::vector<Observation> observations{{Quantity::acceleration}, {Quantity::displacement}};
  filters::Measurements record = decay(3000);
  StartDirections directions =
      start_directions(*model, observations, start_scale(*model, observations, record.outputs, 3.0));
  std::unique_ptr<filters::DiscreteModel> discrete = filters::discretise(
      model->motion, dt, "exponential", {{}, Eigen::Vector2d(1e-4, 1e-10).asDiagonal().toDenseMatrix()});

  VectorXd state(double stiffness, double damping) const {
    VectorXd z = initial_estimate(*model, directions).mean;
    z[model->unknown_places[0]] = stiffness;
    z[model->unknown_places[1]] = damping;
    return z;
  }
};

TEST(Reproduction, FindsTheStartAndTheBiasOfAnExactRecord) {
  const Case test;
  const Reproduction found =
      reproduce(*test.discrete, test.state(truth.stiffness, truth.damping), test.directions, test.record);
  EXPECT_NEAR(found.initial_state[0], amplitude, 1e-12);
  EXPECT_NEAR(found.initial_state[1], 0.0, 1e-11);
  EXPECT_NEAR(found.initial_state[test.model->offsets[0].place], bias, 1e-10);
  EXPECT_LT(found.response_error_percent, 1e-8);
}

TEST(Reproduction, LeavesWhatTheParametersGetWrong) {
  const Case test;
  const Reproduction found = reproduce(*test.discrete, test.state(truth.stiffness, 2.0 * truth.damping),
                                       test.directions, test.record);
  // The best multiple of e^(-2at) cos leaves of e^(-at) cos the share 1 - E(3a)^2 / (E(2a) E(4a)) of its
  // energy, E(r) being the integral of e^(-rt) over the record.
  const double a = 0.02 * 13.0, t = 3.0;
  const auto energy = [&](double rate) { return (1.0 - std::exp(-rate * t)) / rate; };
  const double share = 1.0 - std::pow(energy(3.0 * a), 2) / (energy(2.0 * a) * energy(4.0 * a));
  EXPECT_NEAR(found.response_error_percent, 100.0 * std::sqrt(share), 0.05 * 100.0 * std::sqrt(share));
}

TEST(StartScale, IsTheAmplitudeBehindTheReadings) {
  const Case test;
  const StartScale scale = start_scale(*test.model, test.observations, test.record.outputs, 3.0);
  EXPECT_NEAR(scale.displacement, amplitude, 0.2 * amplitude);  // the bias adds to one reading
}

TEST(InitialEstimate, CoversTheMotionTheOffsetsAndTheGuesses) {
  const Case test;
  const filters::Gaussian estimate = initial_estimate(*test.model, test.directions);
  const VectorXd deviations = estimate.deviations();
  EXPECT_NEAR((estimate.factor * estimate.factor.transpose() - estimate.covariance).norm(), 0.0,
              1e-15 * estimate.covariance.norm());
  EXPECT_NEAR(deviations[1] / deviations[0], 13.0, 1e-9);
  EXPECT_NEAR(deviations[2] / estimate.mean[2], 0.3, 1e-12);
  EXPECT_GT(deviations[4], 0.0);
}

}  // namespace
}  // namespace beamid::experiments::reproduction_test
