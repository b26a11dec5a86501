#include "fem/elements/element_shapes.hpp"

#include <algorithm>

namespace beamid::fem {

using Eigen::Matrix2d, Eigen::Vector2d, Eigen::Vector4d;
using Matrix24d = Eigen::Matrix<double, 2, 4>;

bool ElementSection::is_sharp() const {
  return std::min(bending_stiffness(0.0), bending_stiffness(1.0)) <= 1e-9 * bending_stiffness(0.5);
}

NodalShape uniform_shape(double phi, double s) {
  const double shear = 0.5 * phi * (s - s * s), shear_slope = 0.5 * phi * (1 - 2 * s);
  const Vector4d deflection{1 + s * s * (2 * s - 3) + phi * (1 - s), s * (1 - s) * (1 - s) + shear,
                            s * s * (3 - 2 * s) + phi * s, s * s * (s - 1) - shear};
  const Vector4d slope{6 * s * (s - 1) - phi, 1 + s * (3 * s - 4) + shear_slope, 6 * s * (1 - s) + phi,
                       s * (3 * s - 2) - shear_slope};
  const Vector4d rotation{6 * s * (s - 1), 1 + s * (3 * s - 4) + phi * (1 - s), 6 * s * (1 - s),
                          s * (3 * s - 2) + phi * s};
  return {deflection / (1 + phi), slope / (1 + phi), rotation / (1 + phi)};
}

NodalShape varying_shape(const ElementSection& section, const Matrix2d& rigidity, double s) {
  const double h = section.element.length;
  const auto path = section.integral<Matrix2d>(
      [&](double t) {
        const Vector2d bend = h * h * h / section.bending_stiffness(t) * Vector2d(t - 1, 1);
        const Vector2d shear(h * section.shear_flexibility(t), 0.0);
        Matrix2d turned_and_moved;
        turned_and_moved << bend, (s - t) * bend - shear;
        return turned_and_moved;
      },
      0.0, s);
  const Matrix24d strain{{1, 1, -1, 0}, {0, -1, 0, 1}}, forces = rigidity * strain;
  NodalShape shape;
  shape.rotation = Vector4d(0, 1, 0, 0) + forces.transpose() * path.col(0);
  shape.slope = shape.rotation - h * section.shear_flexibility(s) * forces.row(0).transpose();
  shape.deflection = Vector4d(1, s, 0, 0) + forces.transpose() * path.col(1);
  return shape;
}

// Force: EI theta'' + kappa G A (w' - theta) = 0 gives w = s^2 (1-s)^2 + phi s (1-s) up to a factor, with the
// shear strain phi (1 - 2 s). Couple: theta = s (1-s), and a constant shear strain that brings w back to
// zero.
InteriorShape interior_shape(double phi, double s) {
  const double r = 1 - s, n = 16 / (1 + 4 * phi);
  return {{n * s * r * (s * r + phi), -2.0 / 3.0 * s * r * (r - s)},
          {n * (r - s) * (2 * s * r + phi), 4 * s * r - 2.0 / 3.0},
          {n * (r - s) * 2 * s * r, 4 * s * r},
          {n * (2 - 12 * s * r), 4 * (r - s)}};
}

}  // namespace beamid::fem
