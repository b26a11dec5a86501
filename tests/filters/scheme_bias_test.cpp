// The bias of a discretisation with many degrees of freedom. Oracles: the table of a chain of three storeys,
// computed outside this project mode by mode; the scalar law; series by hand (many_degrees_of_freedom.md).
#include "filters/scheme_bias.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace beamid::scheme_bias_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector3d;
using filters::SecondOrder, filters::Scheme, filters::scheme_registry;

std::unique_ptr<Scheme> scheme(const std::string& name) {
  return scheme_registry().make(name, {});
}

constexpr double stiffnesses[] = {2.0e6, 1.5e6, 1.2e6};

MatrixXd chain_matrix(const Vector3d& k) {
  MatrixXd matrix(3, 3);
  matrix << k[0] + k[1], -k[1], 0.0, -k[1], k[1] + k[2], -k[2], 0.0, -k[2], k[2];
  return matrix;
}

MatrixXd masses() {
  return Vector3d(1000.0, 800.0, 900.0).asDiagonal();
}

// 1 % of critical damping in the first mode, proportional to stiffness.
SecondOrder chain() {
  const MatrixXd k = chain_matrix(Vector3d(stiffnesses[0], stiffnesses[1], stiffnesses[2]));
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(k, masses());
  return {masses(), 0.02 / std::sqrt(modes.eigenvalues()[0]) * k, k};
}

// Dashpots in storeys 1 and 3 alone: its modes are complex.
SecondOrder unevenly_damped() {
  return {masses(), chain_matrix(Vector3d(4000.0, 0.0, 1500.0)), chain().stiffness};
}

// Storey j of a chain's matrix: C_11 + C_12, -C_12, -C_23.
double storey(const MatrixXd& c, int j) {
  return j == 0 ? c(0, 0) + c(0, 1) : -c(j - 1, j);
}

struct Row {
  const char* scheme;
  double dt;
  Vector3d damping;    // (c_f - c) / (k dt)
  Vector3d stiffness;  // k_f / k - 1 [%]; NaN where the table has none
};

class TableOfAChain : public testing::TestWithParam<Row> {};

TEST_P(TableOfAChain, IsMet) {
  const SecondOrder truth = chain(), found = seen_through(*scheme(GetParam().scheme), truth, GetParam().dt);
  for (int j = 0; j < 3; ++j) {
    const double k = stiffnesses[j], c = storey(truth.damping, j);
    EXPECT_NEAR((storey(found.damping, j) - c) / (k * GetParam().dt), GetParam().damping[j], 6e-5) << j;
    if (!std::isnan(GetParam().stiffness[j])) {
      EXPECT_NEAR(100.0 * (storey(found.stiffness, j) / k - 1.0), GetParam().stiffness[j], 6e-4) << j;
    }
  }
}

const Vector3d no_value = Vector3d::Constant(std::nan(""));
INSTANTIATE_TEST_SUITE_P(
    ThreeStoreys, TableOfAChain,
    testing::Values(Row{"forward_euler", 1e-3, {0.9973, 0.9923, 0.9947}, {-0.142, -0.410, -0.281}},
                    Row{"forward_euler", 2e-3, {0.9955, 0.9871, 0.9911}, {-0.323, -0.931, -0.638}},
                    Row{"forward_euler", 5e-3, {0.9878, 0.9649, 0.9759}, {-1.098, -3.153, -2.165}},
                    Row{"backward_euler", 1e-3, {-0.9998, -0.9993, -0.9995}, no_value},
                    Row{"backward_euler", 2e-3, {-1.0004, -1.0011, -1.0008}, no_value},
                    Row{"backward_euler", 5e-3, {-0.9999, -0.9997, -0.9998}, no_value},
                    Row{"implicit_midpoint", 1e-3, {0.0006, 0.0018, 0.0012}, no_value},
                    Row{"implicit_midpoint", 2e-3, {0.0012, 0.0035, 0.0024}, no_value},
                    Row{"implicit_midpoint", 5e-3, {0.0031, 0.0090, 0.0062}, no_value}));

class BiasOf : public testing::TestWithParam<const char*> {};

TEST_P(BiasOf, OneDegreeOfFreedomIsTheScalarLaw) {
  const double m = 3.0, k = 515.8, c = 7.867, dt = 0.004;
  const auto tested = scheme(GetParam());
  const auto one = [](double value) { return MatrixXd::Constant(1, 1, value); };
  const SecondOrder found = seen_through(*tested, SecondOrder{one(m), one(c), one(k)}, dt);
  const std::complex<double> mu(-0.5 * c / m, std::sqrt(k / m - 0.25 * c * c / (m * m))),
      seen = filters::seen_through(*tested, mu, dt);
  EXPECT_NEAR(found.stiffness(0, 0), m * std::norm(seen), 1e-10 * k);
  EXPECT_NEAR(found.damping(0, 0), -2.0 * m * seen.real(), 1e-10 * k * dt);
}

TEST_P(BiasOf, AStructureReproducesItsRecord) {
  const double dt = 0.004;
  const auto tested = scheme(GetParam());
  for (const SecondOrder& truth : {chain(), unevenly_damped()}) {
    const SecondOrder found = seen_through(*tested, truth, dt);
    const Index n = truth.size();
    // Displacements of both obey the same recursion, whose coefficients are sums of products of the poles.
    const MatrixXd exact = (truth.motion_matrix() * dt).exp(),
                   moved = filters::amplification(*tested, found.motion_matrix() * dt);
    const auto recursion = [n](const MatrixXd& g) -> MatrixXd {  // x_2 = [.., ..] [x_0; x_1]
      MatrixXd first(2 * n, 2 * n);
      first.topRows(n).setIdentity();
      first.bottomRows(n) = g.topRows(n);
      return MatrixXd(g * g).topRows(n) * first.inverse();
    };
    EXPECT_LT((recursion(exact) - recursion(moved)).norm(), 1e-9);
    const SecondOrder back = behind(*tested, found, dt);
    EXPECT_LT((back.damping - truth.damping).norm(), 1e-9 * truth.damping.norm());
    EXPECT_LT((back.stiffness - truth.stiffness).norm(), 1e-9 * truth.stiffness.norm());
  }
}

// Halving dt divides what the first terms lack by 2^2p at least, where rounding does not hide it.
TEST_P(BiasOf, ItsFirstTermsLackAHigherOrder) {
  const auto tested = scheme(GetParam());
  const auto lacking = [&](double dt) {
    const SecondOrder truth = unevenly_damped(), found = seen_through(*tested, truth, dt);
    const filters::BiasTerms terms = first_terms(*tested, truth, dt);
    return std::pair{(found.damping - truth.damping - terms.damping).norm(),
                     (found.stiffness - truth.stiffness - terms.stiffness).norm()};
  };
  const int order = first_terms(*tested, chain(), 1e-3).order;
  const auto coarse = lacking(0.008), fine = lacking(0.004);
  EXPECT_GT(std::log2(coarse.first / fine.first), 2 * order - 0.35);
  EXPECT_GT(std::log2(coarse.second / fine.second), 2 * order - 0.35);
}

INSTANTIATE_TEST_SUITE_P(Schemes, BiasOf,
                         testing::Values("forward_euler", "backward_euler", "implicit_midpoint",
                                         "runge_kutta_2", "runge_kutta_4", "pade"),
                         [](const auto& tested) { return tested.param; });

TEST(BiasSeries, IsThatOfTheLogarithm) {
  // e^z - 1 = z (1 + z/2 + z^2/6 + ...), 1 - e^-z, 2 tanh(z/2)
  const auto series = [](const char* name) { return filters::bias_series(*scheme(name), 4); };
  const auto expect = [](const std::vector<double>& found, std::vector<double> expected) {
    for (std::size_t j = 0; j < expected.size(); ++j) EXPECT_NEAR(found[j], expected[j], 1e-11) << j;
  };
  expect(series("forward_euler"), {1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120});
  expect(series("backward_euler"), {-1.0 / 2, 1.0 / 6, -1.0 / 24, 1.0 / 120});
  expect(series("implicit_midpoint"), {0.0, -1.0 / 12, 0.0, 1.0 / 120});
  expect(series("runge_kutta_2"), {0.0, 1.0 / 6, -1.0 / 8, 2.0 / 15});
  expect(series("exponential"), {0.0, 0.0, 0.0, 0.0});
}

TEST(ForwardEuler, AddsDtTimesKWhateverTheDamping) {
  const double dt = 1e-5;
  for (const SecondOrder& truth : {chain(), unevenly_damped()}) {
    const MatrixXd &c = truth.damping, &k = truth.stiffness, over_mass = truth.mass.inverse();
    const filters::BiasTerms terms = first_terms(*scheme("forward_euler"), truth, dt);
    EXPECT_EQ(terms.order, 1);
    EXPECT_LT((terms.damping - dt * (k - 0.5 * c * over_mass * c)).norm(), 1e-9 * dt * k.norm());
    EXPECT_LT((terms.stiffness + 0.5 * dt * c * over_mass * k).norm(),
              1e-9 * dt * (c * over_mass * k).norm());
  }
  const SecondOrder truth = unevenly_damped();
  EXPECT_NEAR(storey(seen_through(*scheme("forward_euler"), truth, dt).damping, 1) / (stiffnesses[1] * dt),
              1.0,
              1e-3);  // where there is no dashpot
}

TEST(ForwardEuler, HasASymmetricKOnlyOfClassicalDamping) {
  const auto skewness = [](const SecondOrder& truth) {
    const MatrixXd change = seen_through(*scheme("forward_euler"), truth, 1e-3).stiffness - truth.stiffness;
    return (change - change.transpose()).norm() / change.norm();
  };
  EXPECT_LT(skewness(chain()), 1e-9);
  EXPECT_GT(skewness(unevenly_damped()), 0.1);
}

TEST(ForwardEuler, IsCuredByDtTimesTheKFoundUpToTheDampingSquared) {
  // Of classical damping C = -M log(I - dt M^-1 (C_f - dt K_f)) / dt, exactly.
  const SecondOrder truth = chain();
  for (const double dt : {0.002, 0.02}) {
    const SecondOrder found = seen_through(*scheme("forward_euler"), truth, dt);
    const MatrixXd less = truth.mass.inverse() * (found.damping - dt * found.stiffness);
    const MatrixXd whole = -truth.mass * MatrixXd(MatrixXd::Identity(3, 3) - dt * less).log() / dt;
    EXPECT_LT((whole - truth.damping).norm(), 1e-10 * truth.damping.norm()) << dt;
  }
}

TEST(SeenThrough, TakesEqualAndDefectivePoles) {
  // Critical damping of one coordinate beside an equal one: e^At has t e^(-w t).
  const double w = 30.0, dt = 0.003;
  const SecondOrder truth{MatrixXd::Identity(2, 2), 2.0 * w * MatrixXd::Identity(2, 2),
                          w * w * MatrixXd::Identity(2, 2)};
  const SecondOrder found = seen_through(*scheme("forward_euler"), truth, dt);
  const double seen = (std::exp(-w * dt) - 1.0) / dt;
  EXPECT_LT((found.damping + 2.0 * seen * MatrixXd::Identity(2, 2)).norm(), 1e-9 * w);
  EXPECT_LT((found.stiffness - seen * seen * MatrixXd::Identity(2, 2)).norm(), 1e-9 * w * w);
}

TEST(SeenThrough, RefusesAStepThatIsTooLong) {
  const MatrixXd one = MatrixXd::Identity(1, 1);
  EXPECT_THROW(seen_through(*scheme("implicit_midpoint"), SecondOrder{one, 0.0 * one, one}, M_PI),
               std::runtime_error);
}

}  // namespace
}  // namespace beamid::scheme_bias_test
