#include "filters/fisher_information.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "beamid/testing/oscillator.hpp"
#include "filters/filter_run.hpp"

namespace beamid::fisher_information_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double mass = 3.0, stiffness = 515.8, damping = 1.2, noise = 1e-4, dt = 2e-3;
constexpr Index samples = 3000;

std::unique_ptr<filters::DiscreteModel> model() {
  return filters::discretise(std::make_shared<test::Oscillator>(mass), dt, "exponential",
                             {{}, MatrixXd::Constant(1, 1, noise * noise)});
}

VectorXd truth() {
  return Eigen::Vector4d(0.012, -0.03, stiffness, damping);
}

TEST(FisherInformation, GivesTheClosedFormBoundOfADampedSine) {
  // Oracle: x = Re(c e^(lambda t)) written out and differentiated by c and lambda by hand, then carried to K
  // and C by M lambda^2 + C lambda + K = 0.
  using Complex = std::complex<double>;
  const double decay = damping / (2 * mass);
  const Complex lambda(-decay, std::sqrt(stiffness / mass - decay * decay));
  const Complex c(truth()[0], (truth()[0] * lambda.real() - truth()[1]) / lambda.imag());
  MatrixXd information = MatrixXd::Zero(4, 4);
  for (Index k = 0; k < samples; ++k) {
    const double t = static_cast<double>(k) * dt;
    const Complex e = std::exp(lambda * t), by_lambda = c * t * e;
    const Eigen::Vector4d slope(e.real(), -e.imag(), by_lambda.real(),
                                -by_lambda.imag());  // Re c, Im c, Re l, Im l
    information += slope * slope.transpose() / (noise * noise);
  }
  const MatrixXd covariance = information.inverse().bottomRightCorner(2, 2);
  // K = M |lambda|^2, C = -2 M Re lambda
  Eigen::Matrix2d jacobian;
  jacobian << 2 * mass * lambda.real(), 2 * mass * lambda.imag(), -2 * mass, 0.0;
  const Eigen::Matrix2d expected = jacobian * covariance * jacobian.transpose();

  const auto discrete = model();
  const VectorXd bound = filters::cramer_rao_bound(fisher_information(*discrete, truth(), samples));
  EXPECT_NEAR(bound[2] / std::sqrt(expected(0, 0)), 1.0, 1e-8);
  EXPECT_NEAR(bound[3] / std::sqrt(expected(1, 1)), 1.0, 1e-8);
}

TEST(FisherInformation, IsWhatAFilterAtTheTruthReports) {
  // Oracle: an EKF that is linearised at the truth, from a diffuse prior, ends with the inverse information.
  filters::Measurements record{VectorXd::LinSpaced(samples, 0, dt * (samples - 1)), MatrixXd(1, samples), {}};
  auto discrete = model();
  VectorXd z = truth(), next;
  for (Index k = 0; k < samples; ++k) {
    record.outputs(0, k) = z[0];
    discrete->transition(z, {}, next);
    z.swap(next);
  }
  const auto filter = filters::filter_registry().make("ekf", {}, model());
  const Eigen::Vector4d diffuse(1.0, 1e3, 1e9, 1e7);
  const auto last = run(*filter, {truth(), diffuse.asDiagonal()}, record).last;
  const VectorXd bound = filters::cramer_rao_bound(fisher_information(*discrete, truth(), samples));
  EXPECT_NEAR(std::sqrt(last.covariance(2, 2)) / bound[2], 1.0, 1e-4);
  EXPECT_NEAR(std::sqrt(last.covariance(3, 3)) / bound[3], 1.0, 1e-4);
}

TEST(FisherInformation, BoundOnDampingIsOneOverTwiceTheRatioThatOnStiffness) {
  // Oracle: the analytic law of light damping; the constant tends to 1 / (2 xi) for records of many cycles.
  const auto discrete = model();
  const VectorXd bound = filters::cramer_rao_bound(fisher_information(*discrete, truth(), samples));
  const double ratio = damping / (2 * std::sqrt(stiffness * mass));
  EXPECT_NEAR((bound[3] / damping) / (bound[2] / stiffness) * 2 * ratio, 1.0, 0.02);
}

TEST(CramerRaoBound, RefusesWhatIsNotDetermined) {
  // At rest nothing depends on K and C.
  const auto discrete = model();
  VectorXd rest = truth();
  rest.head(2).setZero();
  EXPECT_THROW(filters::cramer_rao_bound(fisher_information(*discrete, rest, 100)), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::fisher_information_test
