#include "experiments/identify/twins/path_tracking.hpp"

#include <cmath>
#include <limits>

namespace beamid::experiments {
namespace {

using Eigen::Index;

constexpr double shortest_path_step = 1e-9, path_rounding = 64.0 * std::numeric_limits<double>::epsilon();

double largest_modulus(const ComplexVector& vector) {
  return vector.cwiseAbs().maxCoeff();
}

class Follower {
 public:
  Follower(const MinorSystem& system, PathComplex gamma) : system_(system), gamma_(gamma) {}

  // du/ds
  ComplexVector slope(const ComplexVector& u, double s) {
    const PathComplex below = s + (1.0 - s) * gamma_;
    system_.at(u, s / below, value_);
    return -(gamma_ / (below * below)) * ComplexVector(value_.jacobian.partialPivLu().solve(value_.motion));
  }

  ComplexVector predicted(const ComplexVector& u, double s, double h) {
    const ComplexVector a = slope(u, s), b = slope(u + 0.5 * h * a, s + 0.5 * h),
                        c = slope(u + 0.5 * h * b, s + 0.5 * h), d = slope(u + h * c, s + h);
    return u + (h / 6.0) * (a + 2.0 * b + 2.0 * c + d);
  }

  // Newton's method; the first correction, or infinity where it does not converge as it should.
  double correct(ComplexVector& u, double s) {
    double first = 0.0, before = 0.0;
    for (int i = 0; i < 4; ++i) {
      system_.at(u, s / (s + (1.0 - s) * gamma_), value_);
      const ComplexVector step = value_.jacobian.partialPivLu().solve(value_.residual);
      const double size = largest_modulus(step);
      if (!std::isfinite(size) || size > 0.1 || (i > 0 && size > 0.1 * before && size > 1e-11))
        return std::numeric_limits<double>::infinity();
      u -= step;
      if (i == 0) first = size;
      if (size < 1e-10) return first;
      before = size;
    }
    return first;
  }

 private:
  const MinorSystem& system_;
  PathComplex gamma_;
  MinorSystem::Value value_;
};

}  // namespace

std::optional<ComplexVector> follow_path(const MinorSystem& system, ComplexVector u, PathComplex gamma,
                                         double largest_correction) {
  Follower follower(system, gamma);
  double s = 0.0, h = 0.05;
  while (s < 1.0) {
    h = std::min(h, 1.0 - s);
    ComplexVector next = follower.predicted(u, s, h);
    const double correction =
        next.allFinite() ? follower.correct(next, s + h) : std::numeric_limits<double>::infinity();
    if (correction > largest_correction) {
      h *= 0.5;
      if (h < shortest_path_step) return std::nullopt;
      continue;
    }
    u = next;
    s = h == 1.0 - s ? 1.0 : s + h;
    if (correction < 0.05 * largest_correction) h *= 1.8;
  }
  return u;
}

// |F_r''[v, v]| <= r^2 T_r e^(r rho) for |v| <= 1 within rho of u, since every exponent is a sum of r
// components.
std::optional<CertifiedSolution> certified(const MinorSystem& system, ComplexVector u) {
  MinorSystem::Value value;
  const Index n = system.size();
  double beta = 0.0, curvature = 0.0;
  for (int i = 0; i < 8; ++i) {
    system.at(u, 1.0, value);
    if (!value.jacobian.allFinite()) return std::nullopt;
    const ComplexMatrix inverse = value.jacobian.inverse();
    if (!inverse.allFinite()) return std::nullopt;
    const ComplexVector step = inverse * value.residual;
    beta = largest_modulus(step);
    curvature = 0.0;
    double floor = 0.0;
    for (Index row = 0; row < n; ++row) {
      double bend = 0.0, rounded = 0.0;
      for (Index r = 0; r < n; ++r) {
        bend += std::abs(inverse(row, r)) * static_cast<double>((r + 1) * (r + 1)) * value.size[r];
        rounded += std::abs(inverse(row, r)) * (value.size[r] + 1.0) * path_rounding;
      }
      curvature = std::max(curvature, bend);
      floor = std::max(floor, rounded);
    }
    if (beta < 2.0 * floor || i == 7) {
      beta += floor;
      break;
    }
    u -= step;
  }
  const double bound = curvature * std::exp(2.0 * static_cast<double>(n) * beta);
  if (!(beta * bound <= 0.25)) return std::nullopt;
  return CertifiedSolution{u, 2.0 * beta};
}

}  // namespace beamid::experiments
