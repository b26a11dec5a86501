// What a free decay determines, and the digits of the bounds.
#include "filters/identifiability.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <limits>

#include "beamid/testing/oscillator.hpp"
#include "filters/fisher_information.hpp"

namespace beamid::identifiability_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::InformationFactor, filters::determined_combinations;

constexpr double mass = 4.37, noise = 1e-4, dt = 1e-3;
constexpr double infinity = std::numeric_limits<double>::infinity();

// Light damping: 0.15 %, the time constant longer than the record.
VectorXd decay() {
  const double stiffness = 516.0;
  return Eigen::Vector4d(0.012, -0.03, stiffness, 2 * 0.0015 * std::sqrt(stiffness * mass));
}

InformationFactor information(Index samples, const MatrixXd& directions = MatrixXd::Identity(4, 4)) {
  const auto model = filters::discretise(std::make_shared<test::Oscillator>(mass), dt, "exponential",
                                         {{}, MatrixXd::Constant(1, 1, noise * noise)});
  return information_factor(*model, decay(), samples, directions);
}

// Bounds on K and C from the closed-form motion x = Re(c e^(lambda t)) in long double.
Eigen::Vector2d closed_form(Index samples) {
  using Real = long double;
  using Complex = std::complex<Real>;
  const VectorXd z = decay();
  const Real rate = static_cast<Real>(z[3]) / (2 * static_cast<Real>(mass));
  const Complex lambda(-rate, std::sqrt(static_cast<Real>(z[2]) / static_cast<Real>(mass) - rate * rate));
  const Complex c(static_cast<Real>(z[0]),
                  (static_cast<Real>(z[0]) * lambda.real() - static_cast<Real>(z[1])) / lambda.imag());
  Eigen::Matrix<Real, 4, 4> sum = Eigen::Matrix<Real, 4, 4>::Zero();
  for (Index k = 0; k < samples; ++k) {
    const Real t = static_cast<Real>(k) * static_cast<Real>(dt);
    const Complex e = std::exp(lambda * t), by_lambda = c * t * e;
    const Eigen::Matrix<Real, 4, 1> slope(e.real(), -e.imag(), by_lambda.real(), -by_lambda.imag());
    sum += slope * slope.transpose() / (static_cast<Real>(noise) * static_cast<Real>(noise));
  }
  const Eigen::Matrix<Real, 2, 2> covariance = sum.inverse().bottomRightCorner<2, 2>();
  Eigen::Matrix<Real, 2, 2> jacobian;  // K = M |lambda|^2, C = -2 M Re lambda
  const Real m = static_cast<Real>(mass);
  jacobian << 2 * m * lambda.real(), 2 * m * lambda.imag(), -2 * m, 0;
  const Eigen::Matrix<Real, 2, 2> bound = jacobian * covariance * jacobian.transpose();
  return {static_cast<double>(std::sqrt(bound(0, 0))), static_cast<double>(std::sqrt(bound(1, 1)))};
}

TEST(InformationFactor, GivesBoundsToNineDigits) {
  // Oracle: the closed form in long double; 1 s and 25 s of a decay whose time constant is 61 s.
  for (const Index samples : {1000, 25000}) {
    const auto report = determined_combinations(information(samples), decay().cwiseAbs());
    const Eigen::Vector2d expected = closed_form(samples);
    EXPECT_NEAR(report.bounds[2] / expected[0], 1.0, 1e-9) << samples;
    EXPECT_NEAR(report.bounds[3] / expected[1], 1.0, 1e-9) << samples;
    EXPECT_EQ(report.rank, 4);
  }
}

TEST(InformationFactor, IsTheFactorOfTheFisherInformation) {
  // Oracle: the sum of products; and, of directions, its congruence D^T I D.
  const auto model = filters::discretise(std::make_shared<test::Oscillator>(mass), dt, "exponential",
                                         {{}, MatrixXd::Constant(1, 1, noise * noise)});
  const MatrixXd whole = fisher_information(*model, decay(), 700);
  const MatrixXd factored = information(700).information();
  const VectorXd unit = whole.diagonal().cwiseSqrt().cwiseInverse();
  EXPECT_LT((unit.asDiagonal() * (factored - whole) * unit.asDiagonal()).norm(), 1e-12);
  MatrixXd directions(4, 2);
  directions << 1, 0.5, 2, 0, 0, 100, 0, 0.01;
  const MatrixXd along = fisher_information(*model, decay(), 700, directions);
  const MatrixXd expected = directions.transpose() * whole * directions;
  EXPECT_LT((along - expected).norm(), 1e-12 * expected.norm());
}

TEST(InformationFactor, EliminatesTheStartAsTheInverseDoes) {
  // Oracle: the bounds on K and C with everything unknown at once. The Schur complement formed by subtraction
  // from I loses these digits.
  const InformationFactor all = information(25000), parameters = all.without({0, 1});
  const auto whole = determined_combinations(all, decay().cwiseAbs());
  const auto reduced = determined_combinations(parameters, decay().tail<2>());
  EXPECT_NEAR(reduced.bounds[0] / whole.bounds[2], 1.0, 1e-11);
  EXPECT_NEAR(reduced.bounds[1] / whole.bounds[3], 1.0, 1e-11);
  EXPECT_NEAR(reduced.correlations(0, 1), whole.correlations(2, 3), 1e-10);
}

TEST(InformationFactor, EliminatesForNothingWhatTheRecordDoesNotFeel) {
  // Oracle: the factor without the dead columns. One nuisance does nothing, another does what the first did.
  InformationFactor plain(2), padded(5);
  const MatrixXd rows = information(300).root();
  plain.add(rows.rightCols(2));
  MatrixXd wide = MatrixXd::Zero(4, 5);
  wide.rightCols(2) = rows.rightCols(2);
  padded.add(wide);
  EXPECT_LT((padded.without({0, 1, 2}).information() - plain.information()).norm(),
            1e-12 * plain.information().norm());
  wide.col(1) = rows.col(0);
  wide.col(2) = 2.0 * rows.col(0);
  InformationFactor twice(5), once(3);
  twice.add(wide);
  MatrixXd narrow(4, 3);
  narrow << rows.col(0), rows.rightCols(2);
  once.add(narrow);
  EXPECT_LT((twice.without({0, 1, 2}).information() - once.without({0}).information()).norm(),
            1e-12 * plain.information().norm());
}

TEST(InformationFactor, RefusesWhatDoesNotFit) {
  EXPECT_THROW(InformationFactor(0), std::invalid_argument);
  InformationFactor factor(2);
  EXPECT_THROW(factor.add(MatrixXd::Ones(1, 3)), std::invalid_argument);
  EXPECT_THROW(factor.add(MatrixXd::Constant(1, 2, std::nan(""))), std::invalid_argument);
  EXPECT_THROW(factor.without({2}), std::invalid_argument);
  EXPECT_THROW(factor.without({0, 1}), std::invalid_argument);
  EXPECT_EQ(factor.root(), MatrixXd::Zero(2, 2));
}

TEST(Identifiability, BoundOnDampingIsOneOverTwiceTheRatioThatOnStiffness) {
  // Oracle: the information on w and on xi w is the same, so (dC/C) / (dK/K) = 1/(2 xi), up to what the start
  // couples, which fades with the number of cycles: 41 in 25 s.
  const auto report = determined_combinations(information(25000), decay().cwiseAbs());
  const double on_stiffness = report.bounds[2] / decay()[2], on_damping = report.bounds[3] / decay()[3];
  EXPECT_NEAR(on_damping / on_stiffness * 2 * 0.0015, 1.0, 0.01);
}

// Free decay of an oscillator of which the mass is unknown too: z = [x, v, K, C, M].
class Weighed final : public filters::LinearMotion {
 public:
  std::vector<filters::Label> state_labels() const override { return std::vector<filters::Label>(5); }
  std::vector<filters::Label> output_labels() const override { return std::vector<filters::Label>(1); }
  Index motion_size() const override { return 2; }
  Index parameter_size() const override { return 3; }
  void motion_matrix(const VectorXd& z, MatrixXd& a) const override {
    a.resize(2, 2);
    a << 0, 1, -z[2] / z[4], -z[3] / z[4];
  }
  void motion_matrix_derivative(const VectorXd& z, Index j, MatrixXd& a) const override {
    a.setZero(2, 2);
    if (j < 2)
      a(1, j) = -1 / z[4];
    else
      a.row(1) << z[2] / (z[4] * z[4]), z[3] / (z[4] * z[4]);
  }
  void output(const VectorXd& z, const VectorXd&, VectorXd& y) const override { y = z.head(1); }
  void output_jacobian(const VectorXd&, const VectorXd&, MatrixXd& h) const override {
    h.setZero(1, 5);
    h(0, 0) = 1;
  }
};

TEST(Identifiability, FreeDecayTellsStiffnessAndDampingOnlyPerMass) {
  // Oracle: the motion depends on K/M and C/M alone, so K, C, M may grow together by any factor: in units of
  // their sizes the null vector is (1, 1, 1)/sqrt 3.
  const auto model = filters::discretise(std::make_shared<Weighed>(), dt, "exponential",
                                         {{}, MatrixXd::Constant(1, 1, noise * noise)});
  VectorXd state(5);
  state << decay(), mass;
  const MatrixXd directions = MatrixXd::Identity(5, 5);
  const InformationFactor all = information_factor(*model, state, 5000, directions);
  const auto report = determined_combinations(all.without({0, 1}), state.tail<3>());
  EXPECT_EQ(report.rank, 2);
  EXPECT_EQ(report.condition, infinity);
  ASSERT_EQ(report.undetermined().cols(), 1);
  EXPECT_LT((report.undetermined() - VectorXd::Constant(3, 1 / std::sqrt(3.0))).norm(), 1e-6);
  for (Index i = 0; i < 3; ++i) {
    EXPECT_FALSE(report.determined(i));
    EXPECT_EQ(report.bounds[i], infinity);
    EXPECT_LT(report.conditional_bounds[i], infinity);
  }
  // With the start asked about as well, the start alone is determined.
  const auto with_start = determined_combinations(all, state.cwiseAbs());
  EXPECT_TRUE(with_start.determined(0) && with_start.determined(1));
  EXPECT_FALSE(with_start.determined(4));
  // The matrix tells the same in its half of the digits.
  const auto matrix = determined_combinations(all.without({0, 1}).information(), state.tail<3>());
  EXPECT_EQ(matrix.rank, 2);
  EXPECT_LT((matrix.undetermined() - report.undetermined()).norm(), 1e-6);
}

TEST(Identifiability, ReportsBoundsAndCorrelationsOfAKnownMatrix) {
  // Oracle: by hand, I = [4 2; 2 3]: I^-1 = [3 -2; -2 4]/8; in units of 2 and 1 it is [16 4; 4 3].
  MatrixXd matrix(2, 2);
  matrix << 4, 2, 2, 3;
  const auto report = determined_combinations(matrix, Eigen::Vector2d(2.0, 1.0));
  EXPECT_NEAR(report.bounds[0], std::sqrt(3.0 / 8.0), 1e-14);
  EXPECT_NEAR(report.bounds[1], std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(report.conditional_bounds[0], 0.5, 1e-14);
  EXPECT_NEAR(report.conditional_bounds[1], 1 / std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(report.correlations(0, 1), -2 / std::sqrt(12.0), 1e-14);
  const double middle = 9.5, half = std::sqrt(6.5 * 6.5 + 16.0);
  EXPECT_NEAR(report.eigenvalues[0], middle + half, 1e-12);
  EXPECT_NEAR(report.condition, (middle + half) / (middle - half), 1e-11);
}

TEST(Identifiability, RefusesWhatIsNoInformation) {
  const MatrixXd one = MatrixXd::Identity(2, 2);
  EXPECT_THROW(determined_combinations(one, VectorXd::Ones(3)), std::invalid_argument);
  EXPECT_THROW(determined_combinations(one, Eigen::Vector2d(1.0, 0.0)), std::invalid_argument);
  EXPECT_THROW(determined_combinations(-one, VectorXd::Ones(2)), std::invalid_argument);
  EXPECT_THROW(determined_combinations(MatrixXd::Ones(2, 3), VectorXd::Ones(2)), std::invalid_argument);
  // Nothing known is an answer, not an error.
  const auto nothing = determined_combinations(MatrixXd::Zero(2, 2), VectorXd::Ones(2));
  EXPECT_EQ(nothing.rank, 0);
  EXPECT_EQ(nothing.bounds[0], infinity);
}

TEST(InformationAlongDirections, RefusesShapesThatDisagree) {
  const auto model = filters::discretise(std::make_shared<test::Oscillator>(mass), dt, "exponential",
                                         {{}, MatrixXd::Identity(1, 1)});
  const MatrixXd four = MatrixXd::Identity(4, 4);
  EXPECT_THROW(information_factor(*model, VectorXd::Zero(3), 5, four), std::invalid_argument);
  EXPECT_THROW(information_factor(*model, decay(), 5, MatrixXd::Identity(3, 3)), std::invalid_argument);
  EXPECT_THROW(information_factor(*model, decay(), 5, four, MatrixXd::Zero(1, 4)), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::identifiability_test
