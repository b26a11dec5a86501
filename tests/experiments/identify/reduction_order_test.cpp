// Errors predicted for each order of a reduction. Oracle: nonlinear least squares of damped sines, written
// here, over seeds of phases and noise; and the truth that records were made of.
#include <gmock/gmock.h>

#include <Eigen/QR>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <sstream>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/results/results.hpp"
#include "experiments/studies/compare/report.hpp"
#include "fem/modes.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments::reduction_order_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double rate_hz = 500.0, noise = 0.05;
constexpr Index samples = 2500;
const Progress silent = [](const std::string&) {};

/// Beam S(0.65), the lightest: its higher modes are as strong in acceleration as the first.
Experiment lightest_beam(const std::vector<std::string>& reductions) {
  Experiment e = read_experiment(TomlTable::parse(R"toml(
[beam]
length_m = 1.1
width_m = 0.06
height_m = 0.006
youngs_modulus_pa = 2.12e11
mass_kg = 3.055
tip_mass_kg = 0.0198575
elements = 30
[damping]
ratios = [0.004, 0.005]
[[sensors]]
quantity = "acceleration"
noise_m_per_s2 = 0.05
[model]
name = "beam"
[[parameters]]
quantity = "bending_stiffness"
relative_deviation = 0.3
[[parameters]]
quantity = "damping_ratio"
mode = 1
guess = 0.004
deviation = 0.004
)toml",
                                                  "lightest.toml"));
  for (const std::string& text : reductions) e.reductions.push_back(parse_reduction(text, "test"));
  e.filters = {e.filter};
  e.discretisations = {e.discretisation};
  return e;
}

/// Sum of damped sines of three modes.
struct Sines {
  VectorXd omega, ratio, amplitude = VectorXd::Constant(3, 7.0);
  VectorXd time = VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1) / rate_hz);

  explicit Sines(const Experiment& e) : ratio(VectorXd::Constant(3, 0.005)) {
    omega = fem::modes(fem::assemble(e.structure, e.elements), 3).angular_frequency;
    ratio[0] = 0.004;
  }
  VectorXd record(int seed) const {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
    std::normal_distribution<double> reading(0.0, noise);
    VectorXd y(samples);
    for (Index i = 0; i < samples; ++i) y[i] = reading(random);
    for (Index k = 0; k < 3; ++k) {
      const double psi = phase(random), damped = omega[k] * std::sqrt(1.0 - ratio[k] * ratio[k]);
      y.array() +=
          amplitude[k] * (-ratio[k] * omega[k] * time.array()).exp() * (damped * time.array() + psi).cos();
    }
    return y;
  }
  /// ln of E I and of the first damping ratio, over the truth, by the first r modes: variable projection.
  Eigen::Vector2d fitted(const VectorXd& y, Index r) const {
    Eigen::Vector2d found = Eigen::Vector2d::Zero();
    for (int iteration = 0; iteration < 6; ++iteration) {
      MatrixXd columns(samples, 2 * r + 2);
      columns.rightCols(2).setZero();
      std::vector<std::complex<double>> rate(static_cast<std::size_t>(r));
      for (Index k = 0; k < r; ++k) {
        const double w = omega[k] * std::exp(0.5 * found[0]),
                     xi = ratio[k] * (k == 0 ? std::exp(found[1]) : 1.0);
        rate[static_cast<std::size_t>(k)] = {-xi * w, w * std::sqrt(1.0 - xi * xi)};
        for (Index i = 0; i < samples; ++i) {
          const auto motion = std::exp(rate[static_cast<std::size_t>(k)] * time[i]);
          columns(i, 2 * k) = motion.real(), columns(i, 2 * k + 1) = -motion.imag();
        }
      }
      const VectorXd sizes = columns.leftCols(2 * r).householderQr().solve(y);
      for (Index k = 0; k < r; ++k) {
        const std::complex<double> size(sizes[2 * k], sizes[2 * k + 1]),
            lambda = rate[static_cast<std::size_t>(k)];
        const std::complex<double> by_ratio(lambda.real(), -lambda.real() * lambda.real() / lambda.imag());
        for (Index i = 0; i < samples; ++i) {
          const auto motion =
              time[i] * size * std::complex<double>(columns(i, 2 * k), -columns(i, 2 * k + 1));
          columns(i, 2 * r) += (0.5 * lambda * motion).real();
          if (k == 0) columns(i, 2 * r + 1) += (by_ratio * motion).real();
        }
      }
      const VectorXd left = y - columns.leftCols(2 * r) * sizes;
      found += columns.householderQr().solve(left).tail(2);
    }
    return found;
  }
};

Comparison compared(const Experiment& e, const Sines& sines, int seed) {
  Record record;
  record.time = sines.time;
  record.samples = sines.record(seed).transpose();
  Channel channel;
  channel.name = "tip";
  channel.quantity = Quantity::acceleration;
  channel.position = 1.1;
  record.channels = {channel};
  return compare(e, measured_record("decay", record), {}, silent);
}

TEST(ReductionOrder, ErrsAsLeastSquaresOverSeedsDo) {
  constexpr int seeds = 40;
  const Experiment e = lightest_beam({"modal_truncation:modes=3"});
  const Sines sines(e);
  MatrixXd found = MatrixXd::Zero(3, 2), predicted = MatrixXd::Zero(3, 2);
  for (int seed = 1; seed <= seeds; ++seed) {
    const VectorXd y = sines.record(seed);
    for (Index r = 1; r <= 3; ++r) found.row(r - 1) += sines.fitted(y, r).cwiseAbs2().transpose();
    const Comparison comparison = compared(e, sines, seed);
    const auto errors = errors_by_order({e, comparison.compared, comparison.analysis}, comparison.runs.at(0));
    ASSERT_EQ(errors.size(), 6U);
    for (const OrderError& one : errors) {
      EXPECT_EQ(one.bias, 0.0);
      predicted(one.order - 1, static_cast<Index>(one.parameter)) += one.expected() * one.expected();
    }
  }
  // A mean of 40 squares is known to 22 %; three of these are left, and the scatter of the predictions.
  for (Index r = 0; r < 3; ++r)
    for (Index j = 0; j < 2; ++j)
      EXPECT_NEAR(std::log(found(r, j) / predicted(r, j)), 0.0, std::log(2.0))
          << "order " << r + 1 << ", " << j;
  EXPECT_GT(predicted(0, 1), 4.0 * predicted(1, 1));
  EXPECT_GT(predicted(1, 1), 2.0 * predicted(2, 1));
}

TEST(ReductionOrder, HasTheBiasOfShapesThatAreNotModes) {
  const Experiment e = lightest_beam({"krylov:moments=3"});
  const Sines sines(e);
  const Comparison found = compared(e, sines, 1);
  const ComparedRun& run = found.runs.at(0);
  ASSERT_TRUE(run.has_estimate());
  const double error = run.parameters.at(0).estimate.value / 228.96 - 1.0;
  bool predicted = false;
  for (const OrderError& one : errors_by_order({e, found.compared, found.analysis}, run))
    if (one.parameter == 0 && one.order == 3) {
      predicted = true;
      EXPECT_EQ(one.method, "krylov");
      EXPECT_NEAR(error, one.bias, 0.2 * std::abs(one.bias) + 4.0 * std::hypot(one.others, one.deviation));
      EXPECT_LT(one.bias, -2e-5);
    }
  EXPECT_TRUE(predicted);
  std::ostringstream text, json;
  const Results results = report(e, found);
  print(text, results);
  print_json(json, results);
  EXPECT_THAT(text.str(), testing::HasSubstr("the expected error of bending_stiffness: bias"));
  EXPECT_THAT(json.str(), testing::HasSubstr("\"expected_error_percent\""));
}

}  // namespace
}  // namespace beamid::experiments::reduction_order_test
