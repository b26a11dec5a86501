// The section along one element, and the shapes in which the element moves.
#pragma once

#include <Eigen/Core>
#include <boost/math/quadrature/gauss.hpp>

#include "fem/mesh.hpp"

namespace beamid::fem {

/// Properties at s, from 0 at node 1 of the element to 1 at node 2.
struct ElementSection {
  const Section& section;
  const Mesh::Element& element;

  double along(const Variation& quantity, double s) const {
    return quantity(element.from + s * (element.to - element.from));
  }
  double bending_stiffness(double s) const { return element.remaining * along(section.bending_stiffness, s); }
  double shear_flexibility(double s) const {  ///< 1 / kappa G A
    return section.shear_stiffness ? 1.0 / along(*section.shear_stiffness, s) : 0.0;
  }

  /// Whether the section vanishes at one end.
  bool is_sharp() const;

  /// Integral over s from begin to end by ten Gauss points, halved until EI changes by less than twofold:
  /// 1/EI is then smooth enough for them.
  template <class Result, class Function>
  Result integral(const Function& f, double begin = 0.0, double end = 1.0) const;
};

/// At one place of the element, per (w_1, h theta_1, w_2, h theta_2).
struct NodalShape {
  Eigen::Vector4d deflection;  ///< w
  Eigen::Vector4d slope;       ///< h dw/dx
  Eigen::Vector4d rotation;    ///< h theta: the slope without the shear strain

  /// h dw/dx per strain (element.hpp), the chord's slope taken off: h theta_1 = eps_1, h theta_2 = eps_1 +
  /// eps_2.
  Eigen::Vector2d slope_of_strains() const { return {slope[1] + slope[3], slope[3]}; }
};

/// Static shapes of a uniform element [friedman1993]; phi = 12 EI / (kappa G A h^2), 0 gives Hermite's
/// cubics.
NodalShape uniform_shape(double phi, double s);

/// Static shapes of any element: what its natural forces N = D epsilon bend and shear between node 1 and s,
///
///     h theta = h theta_1 + h^3 int_0^s b^T N / EI dt,   h dw/dx = h theta - h N_1 / kappa G A,   b = (t -
///     1, 1).
///
/// @param rigidity D
NodalShape varying_shape(const ElementSection& section, const Eigen::Matrix2d& rigidity, double s);

/// At one place, per interior coordinate: what a uniform force and a uniform couple along a uniform element
/// do while its nodes are held, scaled to a deflection and an h theta of 1 at the middle.
struct InteriorShape {
  Eigen::Vector2d deflection;  ///< w
  Eigen::Vector2d slope;       ///< h dw/dx
  Eigen::Vector2d rotation;    ///< h theta
  Eigen::Vector2d bend;        ///< h^2 dtheta/dx
};
InteriorShape interior_shape(double phi, double s);

template <class Result, class Function>
Result ElementSection::integral(const Function& f, double begin, double end) const {
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  if (!section.bending_stiffness.is_constant() && !is_sharp()) {
    const double ratio = bending_stiffness(end) / bending_stiffness(begin);
    if (ratio > 2.0 || ratio < 0.5)
      return integral<Result>(f, begin, middle) + integral<Result>(f, middle, end);
  }
  using Gauss = boost::math::quadrature::gauss<double, 10>;
  Result sum = Result::Zero();
  for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
    const double offset = half * Gauss::abscissa()[i], weight = half * Gauss::weights()[i];
    sum += weight * (f(middle - offset) + f(middle + offset));
  }
  return sum;
}

}  // namespace beamid::fem
