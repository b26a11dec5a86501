#include "fem/elements/rod_element.hpp"

#include "fem/elements/element_shapes.hpp"

namespace beamid::fem {
namespace {

using Eigen::Matrix2d, Eigen::Matrix3d, Eigen::Vector3d;

// Of one number, which ElementSection integrates as a vector.
template <class Function>
double integral(const ElementSection& p, const Function& f, double begin = 0.0, double end = 1.0) {
  using One = Eigen::Vector<double, 1>;
  return p.integral<One>([&](double s) { return One(f(s)); }, begin, end)[0];
}

Matrix3d consistent_mass(const ElementSection& p, const Variation& stiffness, const Variation& mass) {
  const auto give = [&](double s) { return 1.0 / p.along(stiffness, s); };
  const double whole = stiffness.is_constant() ? 1.0 : integral(p, give);
  return p.integral<Matrix3d>([&](double s) {
    const double beyond = stiffness.is_constant() ? s : integral(p, give, 0.0, s) / whole;
    const Vector3d shape(1.0 - beyond, beyond, 4.0 * s * (1.0 - s));
    return Matrix3d(p.element.length * p.along(mass, s) * shape * shape.transpose());
  });
}

Matrix2d linear_mass(const ElementSection& p, const Variation& mass, bool lumped) {
  return p.integral<Matrix2d>([&](double s) {
    const Eigen::Vector2d shape(1.0 - s, s);
    const Matrix2d spread = lumped ? Matrix2d(shape.asDiagonal()) : Matrix2d(shape * shape.transpose());
    return Matrix2d(p.element.length * p.along(mass, s) * spread);
  });
}

}  // namespace

RodMatrices rod_matrices(const Section& section, const Mesh::Element& element, const Variation& stiffness,
                         const Variation& mass_per_length, MassModel mass_model) {
  const ElementSection p{section, element};
  const double h = element.length;
  const bool lumped = mass_model == MassModel::lumped,
             sharp = !(p.along(stiffness, 0.0) > 0.0 && p.along(stiffness, 1.0) > 0.0),
             with_interior = !lumped && !sharp;
  RodMatrices result;
  result.flexibility.resize(with_interior ? 2 : 1);
  result.flexibility[0] = sharp ? h / integral(p, [&](double s) { return p.along(stiffness, s); })
                                : h * integral(p, [&](double s) { return 1.0 / p.along(stiffness, s); });
  if (with_interior) {
    result.flexibility[1] = h / integral(p, [&](double s) {
                              const double strain = 4.0 * (1.0 - 2.0 * s);
                              return p.along(stiffness, s) * strain * strain;
                            });
    result.mass = consistent_mass(p, stiffness, mass_per_length);
  } else {
    result.mass = linear_mass(p, mass_per_length, lumped);
  }
  result.rigidity = result.flexibility.cwiseInverse();
  return result;
}

}  // namespace beamid::fem
