#include "tests/fem/exact_space_frame.hpp"

#include <Eigen/Eigenvalues>

#include "tests/fem/exact_frame.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index;
using Matrix12d = Eigen::Matrix<double, 12, 12>;

constexpr double pi = std::numbers::pi;

// Of (d_1, theta_1, d_2, theta_2) along the member's own axes.
Matrix12d own_dynamic_stiffness(const SpaceSection& s, double length, double w) {
  // in place of (u, w, theta): (d_x, d_y, theta_z), and (theta_x, d_z, -theta_y) where GJ and rho I_p stand
  // for EA and rho A, which differ from GJ rho A / rho I_p and rho A by a factor
  const double ratio = s.torsional_inertia / s.mass_per_length;
  const Eigen::Matrix<double, 6, 6> in_y =
      dynamic_stiffness(length, s.bending_stiffness_z, s.axial_stiffness, s.mass_per_length, w);
  Eigen::Matrix<double, 6, 6> in_z =
      dynamic_stiffness(length, s.bending_stiffness_y, s.torsional_stiffness / ratio, s.mass_per_length, w);
  for (const Index i : {0, 3})
    for (const Index j : {0, 3}) in_z(i, j) *= ratio;
  Matrix12d k = Matrix12d::Zero();
  const Index of_y[6] = {0, 1, 5, 6, 7, 11}, of_z[6] = {3, 2, 4, 9, 8, 10};
  const double sign[6] = {1, 1, -1, 1, 1, -1};
  for (Index i = 0; i < 6; ++i)
    for (Index j = 0; j < 6; ++j) {
      k(of_y[i], of_y[j]) += in_y(i, j);
      k(of_z[i], of_z[j]) += sign[i] * sign[j] * in_z(i, j);
    }
  return k;
}

int clamped_bending_below(double length, double bending, double mass, double w) {
  const double x = std::sqrt(w * std::sqrt(mass / bending)) * length;
  const int whole = static_cast<int>(x / pi);
  const double sign = (whole % 2 == 0 ? 1 : -1) * (1 - std::cos(x) * std::cosh(x));
  return whole - (sign > 0 ? 0 : 1);
}

int space_frequencies_below(const SpaceFrame& frame, double w) {
  const auto joints = static_cast<Index>(frame.joints.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(6 * joints, 6 * joints);
  int count = 0;
  for (std::size_t i = 0; i < frame.members.size(); ++i) {
    const SpaceSection& s = frame.members[i].section;
    const double length = frame.length(i);
    count += clamped_bending_below(length, s.bending_stiffness_y, s.mass_per_length, w) +
             clamped_bending_below(length, s.bending_stiffness_z, s.mass_per_length, w) +
             static_cast<int>(w * std::sqrt(s.mass_per_length / s.axial_stiffness) * length / pi) +
             static_cast<int>(w * std::sqrt(s.torsional_inertia / s.torsional_stiffness) * length / pi);
    Matrix12d turn = Matrix12d::Zero();
    for (Index b = 0; b < 4; ++b) turn.block<3, 3>(3 * b, 3 * b) = frame.axes(i).transpose();
    const Matrix12d k = turn.transpose() * own_dynamic_stiffness(s, length, w) * turn;
    const Index at[2] = {6 * frame.members[i].first, 6 * frame.members[i].second};
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q) all.block<6, 6>(at[p], at[q]) += k.block<6, 6>(6 * p, 6 * q);
  }
  for (const SpaceFrame::Body& body : frame.bodies) {
    all.diagonal().segment<3>(6 * body.joint).array() -= w * w * body.mass;
    all.diagonal().segment<3>(6 * body.joint + 3) -= w * w * body.inertia;
  }
  std::vector<bool> held(static_cast<std::size_t>(6 * joints), false);
  for (const SpaceFrame::Support& s : frame.supports) {
    const bool motions[6] = {s.x, s.y, s.z, s.rx, s.ry, s.rz};
    for (std::size_t i = 0; i < 6; ++i)
      if (motions[i]) held[static_cast<std::size_t>(6 * s.joint) + i] = true;
  }
  std::vector<Index> free;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (!held[i]) free.push_back(static_cast<Index>(i));
  const Eigen::MatrixXd stiffness = all(free, free);
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness, Eigen::EigenvaluesOnly).eigenvalues();
  return count + static_cast<int>((eigenvalues.array() < 0).count());
}

}  // namespace

double exact_frequency(const SpaceFrame& frame, int i) {
  double low = 1e-3, high = 1e4;
  while (high - low > 1e-13 * high) {
    const double middle = low < 1.0 && high > 2.0 ? std::sqrt(low * high) : 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (space_frequencies_below(frame, 2 * pi * middle) >= i ? high : low) = middle;
  }
  return high;
}

}  // namespace beamid::fem
