// Coloured noise, where estimates are determined.
#include "experiments/identify/engine/noise_in_estimates.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/models/joint_model.hpp"
#include "experiments/signal/toolbox.hpp"
#include "fem/assembly.hpp"
#include "filters/batch_estimator.hpp"
#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::noise_in_estimates_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index samples = 800;
constexpr double dt = 0.005, deviation = 0.01;

/// Two oscillators in one channel, x'' = -w^2 x - 2 xi w x': the state [x1, x2, v1, v2, w1^2, w2^2] is found
/// from x1 + x2.
class TwoModes final : public filters::LinearMotion {
 public:
  std::vector<filters::Label> state_labels() const override {
    return {{"x1", "m"}, {"x2", "m"}, {"v1", "m/s"}, {"v2", "m/s"}, {"k1", "1/s2"}, {"k2", "1/s2"}};
  }
  std::vector<filters::Label> output_labels() const override { return {{"sum", "m"}}; }
  Index motion_size() const override { return 4; }
  Index parameter_size() const override { return 2; }
  void motion_matrix(const VectorXd& z, MatrixXd& a) const override {
    a.setZero(4, 4);
    a(0, 2) = a(1, 3) = 1.0;
    a(2, 0) = -z[4], a(3, 1) = -z[5];
    a(2, 2) = -0.2, a(3, 3) = -0.6;
  }
  void motion_matrix_derivative(const VectorXd&, Index j, MatrixXd& a) const override {
    a.setZero(4, 4);
    a(2 + j, j) = -1.0;
  }
  void output(const VectorXd& z, const VectorXd&, VectorXd& y) const override {
    y.resize(1);
    y[0] = z[0] + z[1];
  }
  void output_jacobian(const VectorXd&, const VectorXd&, MatrixXd& h) const override {
    h.setZero(1, 6);
    h(0, 0) = h(0, 1) = 1.0;
  }
};

// Noise that is denser at the slow mode than at the fast one: of standard deviation one.
VectorXd low_passed(std::uint64_t seed) {
  constexpr double keep = 0.9;
  const VectorXd white = standard_normal(samples + 500, seed, 0);
  VectorXd noise = white;
  for (Index k = 1; k < noise.size(); ++k)
    noise[k] = keep * noise[k - 1] + std::sqrt(1 - keep * keep) * white[k];
  return noise.tail(samples);
}

// Oracle: the scatter of 200 least-squares estimates in noise of that colour, over what white noise of its
// deviation would make; 200 runs know it to 5 %.
TEST(NoiseInEstimates, IsTheScatterOfLeastSquaresInThatNoise) {
  const auto motion = std::make_shared<TwoModes>();
  const VectorXd truth =
      (VectorXd(6) << 1, 0.5, 0, 0, std::pow(2 * M_PI * 2, 2), std::pow(2 * M_PI * 20, 2)).finished();
  const auto model =
      filters::discretise(motion, dt, "exponential", {{}, MatrixXd::Constant(1, 1, deviation * deviation)});
  StartDirections directions{MatrixXd::Zero(6, 4), MatrixXd::Zero(6, 2)};
  directions.motion.topRows(4).setIdentity();
  directions.motion(2, 2) = 10, directions.motion(3, 3) = 100;
  directions.unknowns(4, 0) = truth[4], directions.unknowns(5, 1) = truth[5];
  filters::Measurements record{VectorXd::LinSpaced(samples, 0, dt * (samples - 1)), MatrixXd(1, samples), {}};
  MatrixXd clean(1, samples);
  VectorXd x = truth, next, y;
  for (Index k = 0; k < samples; ++k) {
    model->output(x, {}, y);
    clean(0, k) = y[0];
    model->transition(x, {}, next);
    x = next;
  }
  constexpr int runs = 200, every = 10;
  Eigen::Vector2d squares = Eigen::Vector2d::Zero(), predicted = squares, white = squares;
  for (int run = 0; run < runs; ++run) {
    record.outputs = clean + deviation * low_passed(static_cast<std::uint64_t>(run + 1)).transpose();
    const auto found = filters::estimate_batch(*model, truth, directions.all(), record);
    ASSERT_NE(found.status, filters::BatchStatus::failed) << found.reason;
    squares += found.coefficients.tail<2>().cwiseAbs2() / runs;
    white = found.covariance.diagonal().tail<2>();
    if (run % every != 0) continue;
    const auto noise = noise_in_estimates(*model, found.state, directions, record, found.residuals);
    for (int j = 0; j < 2; ++j) predicted[j] += every * noise[static_cast<std::size_t>(j)].ratio / runs;
  }
  double ratios[2];
  for (int j = 0; j < 2; ++j) {
    const double ratio = std::sqrt(squares[j] / white[j]);
    EXPECT_NEAR(predicted[j] / ratio, 1.0, 0.12) << j;
    ratios[j] = ratio;
  }
  EXPECT_GT(ratios[0], 2.0);  // the slow mode is worse off than white noise says
  EXPECT_LT(ratios[1], 1.0);
}

}  // namespace
}  // namespace beamid::experiments::noise_in_estimates_test
