#include "tests/fem/exact_frame.hpp"

namespace beamid::fem {

Eigen::Matrix<double, 6, 6> dynamic_stiffness(double length, double bending, double axial, double mass,
                                              double w) {
  const double b = std::sqrt(w * std::sqrt(mass / bending)), x = b * length;
  const double c = std::cos(x), s = std::sin(x), ch = std::cosh(x), sh = std::sinh(x), d = 1 - c * ch;
  const double k3 = bending * b * b * b / d, k2 = bending * b * b / d, k1 = bending * b / d;
  const double a = w * std::sqrt(mass / axial), ka = axial * a / std::sin(a * length);
  Eigen::Matrix<double, 6, 6> k = Eigen::Matrix<double, 6, 6>::Zero();
  k(0, 0) = k(3, 3) = ka * std::cos(a * length);
  k(0, 3) = -ka;
  k(1, 1) = k(4, 4) = k3 * (c * sh + s * ch);
  k(1, 2) = k2 * s * sh;
  k(4, 5) = -k(1, 2);
  k(1, 4) = -k3 * (s + sh);
  k(1, 5) = k2 * (ch - c);
  k(2, 4) = -k(1, 5);
  k(2, 2) = k(5, 5) = k1 * (s * ch - c * sh);
  k(2, 5) = k1 * (sh - s);
  return k.selfadjointView<Eigen::Upper>();
}

int frequencies_below(const Frame& frame, double w) {
  const auto joints = static_cast<Eigen::Index>(frame.joints.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * joints, 3 * joints);
  int count = 0;
  for (std::size_t i = 0; i < frame.members.size(); ++i) {
    const Frame::Member& member = frame.members[i];
    const Section& section = member.section;
    const double length = frame.length(i), bending = section.bending_stiffness(0),
                 axial = (*section.axial_stiffness)(0), mass = section.mass_per_length(0);
    const double x = std::sqrt(w * std::sqrt(mass / bending)) * length;
    const int whole = static_cast<int>(x / std::numbers::pi);
    const double sign = (whole % 2 == 0 ? 1 : -1) * (1 - std::cos(x) * std::cosh(x));
    count += whole - (sign > 0 ? 0 : 1);
    count += static_cast<int>(w * std::sqrt(mass / axial) * length / std::numbers::pi);
    const Frame::Joint &first = frame.joints[member.first], &second = frame.joints[member.second];
    const double c = (second.x - first.x) / length, s = (second.y - first.y) / length;
    Eigen::Matrix3d turn;
    turn << c, s, 0, -s, c, 0, 0, 0, 1;
    Eigen::Matrix<double, 6, 6> both = Eigen::Matrix<double, 6, 6>::Zero();
    both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = turn;
    const Eigen::Matrix<double, 6, 6> k =
        both.transpose() * dynamic_stiffness(length, bending, axial, mass, w) * both;
    const Eigen::Index at[2] = {3 * member.first, 3 * member.second};
    for (int p = 0; p < 2; ++p)
      for (int q = 0; q < 2; ++q) all.block<3, 3>(at[p], at[q]) += k.block<3, 3>(3 * p, 3 * q);
  }
  for (const Frame::Body& body : frame.bodies) {
    const Eigen::Vector3d inertia(body.mass, body.mass, body.rotary_inertia);
    all.diagonal().segment<3>(3 * body.joint) -= w * w * inertia;
  }
  std::vector<bool> held(static_cast<std::size_t>(3 * joints), false);
  for (const Frame::Support& support : frame.supports) {
    held[3 * support.joint] = held[3 * support.joint] || support.x;
    held[3 * support.joint + 1] = held[3 * support.joint + 1] || support.y;
    held[3 * support.joint + 2] = held[3 * support.joint + 2] || support.rotation;
  }
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (!held[i]) free.push_back(static_cast<Eigen::Index>(i));
  const Eigen::MatrixXd stiffness = all(free, free);
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness, Eigen::EigenvaluesOnly).eigenvalues();
  return count + static_cast<int>((eigenvalues.array() < 0).count());
}

double exact_frequency(const Frame& frame, int i) {
  double low = 1e-3, high = 1e4;
  while (high - low > 1e-14 * high) {
    const double middle = low < 1.0 && high > 2.0 ? std::sqrt(low * high) : 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (frequencies_below(frame, 2 * std::numbers::pi * middle) >= i ? high : low) = middle;
  }
  return high;
}

}  // namespace beamid::fem
