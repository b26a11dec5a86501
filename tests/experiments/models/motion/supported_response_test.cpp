// What a part does at one frequency.
#include "experiments/models/motion/supported_response.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "fem/structure.hpp"

namespace beamid::experiments::supported_response_test {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;

// Three masses between two supports, a force at the second; dashpots of any size.
struct Chain {
  MatrixXd mass, stiffness, damping;  // 3 inside, then 2 supports
  SecondOrderForm form;
  MatrixXd rows = MatrixXd::Identity(3, 5);

  explicit Chain(const VectorXd& dashpots, double beta) {
    const double k[] = {2e6, 1.5e6, 1.2e6, 1.8e6};
    mass = MatrixXd(VectorXd(Eigen::Vector<double, 5>(1000, 900, 1100, 1, 1)).asDiagonal());
    stiffness = damping = MatrixXd::Zero(5, 5);
    const Index ends[4][2] = {{3, 0}, {0, 1}, {1, 2}, {2, 4}};
    for (int i = 0; i < 4; ++i)
      for (const Index a : ends[i])
        for (const Index b : ends[i]) {
          const double sign = a == b ? 1.0 : -1.0;
          stiffness(a, b) += sign * k[i];
          damping(a, b) += sign * (dashpots[i] + beta * k[i]);
        }
    stiffness.bottomRows(2).setZero();
    damping.bottomRows(2).setZero();
    const MatrixXd inverse = mass.inverse();
    form.stiffness = inverse * stiffness;
    form.damping = inverse * damping;
    form.inputs = MatrixXd::Zero(5, 3);
    form.inputs(1, 0) = 1.0 / mass(1, 1);
    form.inputs(3, 1) = 1.0;
    form.inputs(4, 2) = 0.5;  // of a coordinate that is half of what was measured
  }

  // Oracle: (K + i w C - w^2 M) x = f - (K_s + i w C_s) s, all masses, straight.
  MatrixXcd expected(double omega) const {
    const Complex i(0.0, omega);
    const MatrixXcd dynamic = stiffness + i * damping - omega * omega * mass;
    MatrixXcd right = MatrixXcd::Zero(3, 3);
    right(1, 0) = 1.0;
    right.col(1) = dynamic.col(3).head(3) / (omega * omega);
    right.col(2) = 0.5 * dynamic.col(4).head(3) / (omega * omega);
    return -omega * omega * dynamic.topLeftCorner(3, 3).lu().solve(right);
  }
};

TEST(SupportedResponse, IsThatOfTheMassesBetweenTheSupports) {
  for (const bool coupled : {false, true}) {
    const Chain chain(coupled ? VectorXd(Eigen::Vector4d(500, 0, 9000, 200)) : VectorXd(VectorXd::Zero(4)),
                      coupled ? 0.0 : 1e-3);
    const SupportedResponse response(chain.form, chain.rows, 2);
    for (const double omega : {0.1, 10.0, 30.0, 60.0, 500.0}) {
      const MatrixXcd expected = chain.expected(omega);
      EXPECT_LT((response.transfer(omega) - expected).norm(), 1e-9 * expected.norm()) << omega;
    }
  }
}

TEST(SupportedResponse, MovesFreelyAsItsEquationsAllow) {
  // Oracle: x = h e^(lambda t) / lambda^2 leaves nothing of x'' + D x' + W x, whatever its phase.
  for (const bool coupled : {false, true}) {
    const Chain chain(coupled ? VectorXd(Eigen::Vector4d(500, 0, 9000, 200)) : VectorXd(VectorXd::Zero(4)),
                      coupled ? 0.0 : 1e-3);
    const auto free = SupportedResponse(chain.form, chain.rows, 2).free_motion(3);
    ASSERT_EQ(free.poles.size(), 3);
    for (Index j = 0; j < 3; ++j) {
      const Complex pole = free.poles[j];
      EXPECT_GT(pole.imag(), 0.0);
      const MatrixXcd equations = pole * pole * MatrixXd::Identity(3, 3) +
                                  pole * chain.form.damping.topLeftCorner(3, 3) +
                                  chain.form.stiffness.topLeftCorner(3, 3);
      EXPECT_LT((equations * free.shapes.col(j)).norm(), 1e-8 * equations.norm() * free.shapes.col(j).norm());
    }
  }
}

// u, u', EI u''', EI u'' of a wave at both ends of a span determine what it does inside.
// Oracle: the exact solution of E I w'''' = rho A omega^2 w through the motions of its ends.
VectorXd exact_inside(double stiffness, double mass, double length, double omega, double at) {
  const double k = std::sqrt(std::sqrt(mass / stiffness) * omega);
  const auto row = [&](double x) {
    return Eigen::RowVector4d(std::cos(k * x), std::sin(k * x), std::cosh(k * x), std::sinh(k * x));
  };
  const auto slope = [&](double x) {
    return Eigen::RowVector4d(-k * std::sin(k * x), k * std::cos(k * x), k * std::sinh(k * x),
                              k * std::cosh(k * x));
  };
  Eigen::Matrix4d ends;
  ends << row(0.0), slope(0.0), row(length), slope(length);
  return (row(at) * ends.inverse()).transpose();
}

TEST(SupportedResponse, OfASpanIsTheExactBeamsThroughItsFourMotions) {
  // A free beam of 24 elements, its ends' deflections and rotations imposed.
  const double stiffness = 2.1e9, mass = 400.0, length = 14.0;
  fem::Beam beam;
  fem::Segment segment;
  segment.length = length;
  segment.section.bending_stiffness = fem::Variation(stiffness);
  segment.section.mass_per_length = fem::Variation(mass);
  beam.segments = {segment};
  const std::vector<fem::Point> points{{"a", 0.0},      {"a", 0.0, {}, true},
                                       {"b", length},   {"b", length, {}, true},
                                       {"inside", 5.0}, {"inside", 5.0, {}, true}};
  const fem::StructuralSystem system = fem::assemble(beam, 24, points);
  const MatrixXd k = system.stiffness.assembled(), m = system.mass, e = system.inputs, h = system.outputs;
  std::vector<Index> order, supports;
  for (Index i = 0; i < 4; ++i) {
    Index at = 0;
    e.col(i).cwiseAbs().maxCoeff(&at);
    supports.push_back(at);
  }
  for (Index i = 0; i < system.size(); ++i)
    if (std::find(supports.begin(), supports.end(), i) == supports.end()) order.push_back(i);
  const auto inside = static_cast<Index>(order.size());
  order.insert(order.end(), supports.begin(), supports.end());
  MatrixXd mass_here = m(order, order), stiff_here = k(order, order);
  mass_here.bottomRows(4).setZero();
  mass_here.bottomRightCorner(4, 4).setIdentity();
  stiff_here.bottomRows(4).setZero();
  SecondOrderForm form;
  const Eigen::PartialPivLU<MatrixXd> factor(mass_here);
  form.stiffness = factor.solve(stiff_here);
  form.damping = MatrixXd::Zero(order.size(), order.size());
  MatrixXd imposed = MatrixXd::Zero(static_cast<Index>(order.size()), 4);
  for (Index i = 0; i < 4; ++i) imposed(inside + i, i) = 1.0 / e(supports[static_cast<std::size_t>(i)], i);
  form.inputs = factor.solve(imposed);
  const MatrixXd rows = h(std::vector<Index>{4, 5}, order);
  const SupportedResponse response(form, rows, 4);
  for (const double hertz : {0.5, 10.0, 30.0, 60.0}) {
    const double omega = 2.0 * 3.141592653589793 * hertz;
    const VectorXd exact = exact_inside(stiffness, mass, length, omega, 5.0);
    const VectorXcd found = response.transfer(omega).row(0);
    EXPECT_LT((found - exact).norm(), 2e-5 * exact.norm()) << hertz;
    // The rotation, by a difference of exact deflections.
    const double step = 1e-4;
    const VectorXd turn = (exact_inside(stiffness, mass, length, omega, 5.0 + step) -
                           exact_inside(stiffness, mass, length, omega, 5.0 - step)) /
                          (2.0 * step);
    const VectorXcd turned = response.transfer(omega).row(1);
    EXPECT_LT((turned - turn).norm(), 1e-4 * turn.norm()) << hertz;
  }
}

}  // namespace
}  // namespace beamid::experiments::supported_response_test
