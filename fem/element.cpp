#include "fem/element.hpp"

#include <Eigen/LU>
#include <boost/math/quadrature/gauss.hpp>

namespace beamid::fem {
namespace {

using Eigen::Matrix2d, Eigen::Matrix4d, Eigen::Vector2d, Eigen::Vector4d;

// Integral over 0..1 by ten Gauss points: exact for the polynomials here, to rounding for 1/EI of mild taper.
template <class Result, class Function>
Result integral(const Function& f) {
  using Gauss = boost::math::quadrature::gauss<double, 10>;
  Result sum = Result::Zero();
  for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
    const double offset = 0.5 * Gauss::abscissa()[i], weight = 0.5 * Gauss::weights()[i];
    sum += weight * (f(0.5 - offset) + f(0.5 + offset));
  }
  return sum;
}

// Static shapes of a uniform element [friedman1993]; phi = 12 EI / (kappa G A h^2), 0 gives Hermite's cubics.
struct Shapes {
  double phi;

  Vector4d deflection(double s) const {  // of (w1, h theta1, w2, h theta2)
    const double bend = 0.5 * phi * (s - s * s);
    return Vector4d{1 + s * s * (2 * s - 3) + phi * (1 - s), s * (1 - s) * (1 - s) + bend,
                    s * s * (3 - 2 * s) + phi * s, s * s * (s - 1) - bend} /
           (1 + phi);
  }
  Vector4d slope(double s) const {  // h dw/dx
    const double bend = 0.5 * phi * (1 - 2 * s);
    return Vector4d{6 * s * (s - 1) - phi, 1 + s * (3 * s - 4) + bend, 6 * s * (1 - s) + phi,
                    s * (3 * s - 2) - bend} /
           (1 + phi);
  }
  Vector4d rotation(double s) const {  // h theta; the slope without the shear strain
    return Vector4d{6 * s * (s - 1), 1 + s * (3 * s - 4) + phi * (1 - s), 6 * s * (1 - s),
                    s * (3 * s - 2) + phi * s} /
           (1 + phi);
  }
  // h dw/dx of the two strains alone, the chord's slope taken off; h theta_1 = eps_1, h theta_2 = eps_1 +
  // eps_2
  Vector2d slope_of_strains(double s) const {
    const Vector4d n = slope(s);
    return {n[1] + n[3], n[3]};
  }
};

struct Properties {  // of the element, s from 0 to 1 along it
  const Section& section;
  const Mesh::Element& element;
  double along(const Variation& quantity, double s) const {
    return quantity(element.from + s * (element.to - element.from));
  }
  double bending(double s) const { return element.remaining * along(section.bending_stiffness, s); }
};

Matrix2d flexibility_of(const Properties& p) {
  const double h = p.element.length;
  return integral<Matrix2d>([&](double s) {
    const Vector2d moment{s - 1, 1};
    Matrix2d part = h * h * h / p.bending(s) * moment * moment.transpose();
    if (p.section.shear_stiffness) part(0, 0) += h / p.along(*p.section.shear_stiffness, s);
    return part;
  });
}

// Over Hermite's cubics: h^2 w'' = (6 s - 4) e1 + (6 s - 2) e2 with the chord rotations e1 = eps_1, e2 =
// eps_1 + eps_2
Matrix2d integrated_rigidity(const Properties& p) {
  const double h = p.element.length;
  return integral<Matrix2d>([&](double s) {
           const Vector2d curvature{12 * s - 6, 6 * s - 2};
           return Matrix2d(p.bending(s) * curvature * curvature.transpose());
         }) /
         (h * h * h);
}

Matrix4d consistent_mass(const Properties& p, const Shapes& shapes, double added) {
  const double h = p.element.length;
  return integral<Matrix4d>([&](double s) {
    const Vector4d w = shapes.deflection(s), turn = shapes.rotation(s);
    return Matrix4d(h * (p.along(p.section.mass_per_length, s) + added) * w * w.transpose() +
                    p.along(p.section.rotary_inertia, s) / h * turn * turn.transpose());
  });
}

// Each half at its node, with the rotary inertia m (h/2)^3 / 3 of the half about it.
Matrix4d lumped_mass(const Properties& p, double added) {
  const double h = p.element.length;
  const Vector4d diagonal = integral<Vector4d>([&](double s) {
    const double mass = h * (p.along(p.section.mass_per_length, s) + added);
    const double turn = mass / 12.0 + p.along(p.section.rotary_inertia, s) / h;
    return Vector4d(mass * (1 - s), turn * (1 - s), mass * s, turn * s);
  });
  return diagonal.asDiagonal();
}

}  // namespace

ElementMatrices element_matrices(const Section& section, const Mesh::Element& element, double added,
                                 double axial_load, MassModel mass_model) {
  const Properties p{section, element};
  const double h = element.length;
  ElementMatrices result;
  if (p.bending(0.0) > 0.0 && p.bending(1.0) > 0.0) {
    result.flexibility = flexibility_of(p);
    result.rigidity = result.flexibility.inverse();
  } else {
    result.rigidity = integrated_rigidity(p);
    result.flexibility = result.rigidity.inverse();
  }
  const double shear = section.shear_stiffness ? p.along(*section.shear_stiffness, 0.5) : 0.0;
  const Shapes shapes{shear > 0.0 ? 12.0 * p.bending(0.5) / (shear * h * h) : 0.0};
  if (axial_load != 0.0) {
    result.rigidity -= axial_load / h * integral<Matrix2d>([&](double s) {
                         const Vector2d slope = shapes.slope_of_strains(s);
                         return Matrix2d(slope * slope.transpose());
                       });
    result.flexibility = result.rigidity.inverse();
  }
  result.mass = mass_model == MassModel::lumped ? lumped_mass(p, added) : consistent_mass(p, shapes, added);
  return result;
}

}  // namespace beamid::fem
