// One beam element: flexibility, stiffness and mass.
#pragma once

#include <optional>

#include <Eigen/Core>
#include <boost/math/quadrature/gauss.hpp>

#include "fem/beam.hpp"

namespace beamid::fem {

// One element that stretches or twists.

// What an axial load does to the chord of an element.

/// Appends to an element's strains the drift of its nodes against each other along `across`, e = across .
/// (d_2
/// - d_1) [m], of the rigidity -softening, softening = P/h [N/m] under a compression P (element.hpp). The
/// displacements of node 1 are the first coordinates, those of node 2 begin at `second`.
void add_chord(const Eigen::VectorXd& across, Eigen::Index second, double softening, Eigen::MatrixXd& strain,
               Eigen::MatrixXd& rigidity, Eigen::MatrixXd& flexibility);

/// Of the two nodal displacements u along the element: strain u_2 - u_1. The flexibility is h times the mean
/// of 1/EA, exact for any variation; the mass is that of the static shapes, in which the elongation spreads
/// as 1/EA does, or half at each node.
///
/// Static shapes cannot follow the inertia force omega^2 rho A u inside the element, which costs
/// (omega h)^2 rho A / (24 EA) of a frequency, at joints and along members alike. With consistent mass the
/// element therefore has an interior coordinate a, the displacement 4 s (1 - s) a beyond the static one: a
/// quadratic element, which errs by (omega h)^4 (rho A / EA)^2 / 1440. Static shapes do no work on it, so
/// that it is a strain of its own, of rigidity 16 EA / 3h.
///
/// A rod in torsion is the same with GJ and rho I_p in place of EA and rho A, and rotations in place of
/// displacements. A rod that is sharp at one end stretches without bound there; it is given linear
/// displacements and no interior coordinate.
struct RodMatrices {
  Eigen::VectorXd rigidity, flexibility;  ///< [N/m], [m/N] of the strains, which are not coupled (1 or 2)
  Eigen::MatrixXd mass;                   ///< [kg] of (u_1, u_2) or (u_1, u_2, a)

  Eigen::Index inside() const { return rigidity.size() - 1; }  ///< interior coordinates, 0 or 1
};

/// @param section of which only the taper is asked, for the steps of the integration
RodMatrices rod_matrices(const Section& section, const Mesh::Element& element, const Variation& stiffness,
                         const Variation& mass_per_length, MassModel mass_model);

// The section along one element, and the shapes in which the element moves.

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

/// Matrices of one element of length h between nodes 1 and 2.
///
/// Natural strains: the drift of node 2 from the tangent at node 1, and the change of rotation, both zero in
/// rigid motions,
///
///     epsilon = (h theta_1 - (w_2 - w_1),  h theta_2 - h theta_1)   [m],
///
/// and their conjugate forces (shear force, bending moment at node 2 over h) [N]. The flexibility is exact
/// for any variation of the section, shear included:
///
///     F = h^3 integral_0^1 b b^T / EI ds + (h / kappa G A) [1 0; 0 0],   b = (s - 1, 1)
///
/// which for a uniform Euler-Bernoulli element is h^3/EI [1/3 -1/2; -1/2 1]. The mass is that of the static
/// shapes, exact for any variation as well (element.hpp). A section that vanishes at one end (a sharp
/// tip) has no flexibility; its stiffness is then integrated over Hermite's cubics, and its shear neglected.
///
/// An axial load P subtracts P/h times the integral of (dw/ds)^2, in two parts: one on these strains, and one
/// on the chord, w_2 - w_1, which becomes a third strain of rigidity -P/h.
///
/// Static shapes cannot follow what inertia forces do inside the element. Bent, that costs (h/L)^4; sheared,
/// it costs (h/L)^2. A Timoshenko element with consistent mass therefore has two coordinates of its own, the
/// amplitudes of its answers to a uniform force and to a uniform couple. Static shapes do no work on them, so
/// that they are their own strains, and the order is four again.
struct ElementMatrices {
  Eigen::Matrix2d rigidity;     ///< D [N/m]
  Eigen::Matrix2d flexibility;  ///< D^-1 [m/N]
  Eigen::Matrix4d mass;         ///< of (w_1, h theta_1, w_2, h theta_2) [kg]

  /// The same with the interior coordinates a [m] behind the strains and behind the nodes'.
  struct Interior {
    Eigen::Matrix4d rigidity, flexibility;
    Eigen::Matrix<double, 6, 6> mass;
  };
  std::optional<Interior> interior;
};

/// Whether the element has interior coordinates.
bool has_interior(const Section& section, const Mesh::Element& element, MassModel mass_model);

/// @param added mass per length that rides on the element [kg/m].
ElementMatrices element_matrices(const Section& section, const Mesh::Element& element, double added,
                                 double axial_load, MassModel mass_model);

}  // namespace beamid::fem
