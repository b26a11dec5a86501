#include "fem/elements/element.hpp"

#include <Eigen/LU>

#include "fem/elements/element_shapes.hpp"

namespace beamid::fem {
namespace {

using Eigen::Matrix2d, Eigen::Matrix4d, Eigen::Vector2d, Eigen::Vector4d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Vector<double, 6>;

Matrix2d flexibility_of(const ElementSection& p) {
  const double h = p.element.length;
  return p.integral<Matrix2d>([&](double s) {
    const Vector2d moment{s - 1, 1};
    Matrix2d part = h * h * h / p.bending_stiffness(s) * moment * moment.transpose();
    part(0, 0) += h * p.shear_flexibility(s);
    return part;
  });
}

// Over Hermite's cubics: h^2 w'' = (6 s - 4) e1 + (6 s - 2) e2, e1 = eps_1, e2 = eps_1 + eps_2 the chord
// rotations.
Matrix2d integrated_rigidity(const ElementSection& p) {
  const double h = p.element.length;
  return p.integral<Matrix2d>([&](double s) {
    const Vector2d curvature{12 * s - 6, 6 * s - 2};
    return Matrix2d(p.bending_stiffness(s) * curvature * curvature.transpose());
  }) / (h * h * h);
}

Matrix2d interior_rigidity(const ElementSection& p, double phi) {
  const double h = p.element.length;
  return p.integral<Matrix2d>([&](double s) {
    const InteriorShape at = interior_shape(phi, s);
    const Vector2d shear = at.slope - at.rotation;
    return Matrix2d(p.bending_stiffness(s) / (h * h * h) * at.bend * at.bend.transpose() +
                    shear * shear.transpose() / (h * p.shear_flexibility(s)));
  });
}

// Each half at its node, with the rotary inertia m (h/2)^3 / 3 of the half about it.
Matrix4d lumped_mass(const ElementSection& p, double added) {
  const double h = p.element.length;
  const Vector4d diagonal = p.integral<Vector4d>([&](double s) {
    const double mass = h * (p.along(p.section.mass_per_length, s) + added);
    const double turn = mass / 12.0 + p.along(p.section.rotary_inertia, s) / h;
    return Vector4d(mass * (1 - s), turn * (1 - s), mass * s, turn * s);
  });
  return diagonal.asDiagonal();
}

}  // namespace

bool has_interior(const Section& section, const Mesh::Element& element, MassModel mass_model) {
  return section.shear_stiffness && mass_model == MassModel::consistent &&
         !ElementSection{section, element}.is_sharp();
}

ElementMatrices element_matrices(const Section& section, const Mesh::Element& element, double added,
                                 double axial_load, MassModel mass_model) {
  const ElementSection p{section, element};
  const double h = element.length;
  const bool sharp = p.is_sharp(), with_interior = has_interior(section, element, mass_model);
  const double phi = sharp ? 0.0 : 12.0 * p.bending_stiffness(0.5) * p.shear_flexibility(0.5) / (h * h);
  ElementMatrices result;
  result.flexibility = sharp ? integrated_rigidity(p).inverse().eval() : flexibility_of(p);
  result.rigidity = sharp ? integrated_rigidity(p) : result.flexibility.inverse().eval();
  const Matrix2d static_rigidity = result.rigidity;
  const auto shape = [&](double s) {
    return sharp || section.is_uniform() ? uniform_shape(phi, s) : varying_shape(p, static_rigidity, s);
  };

  Matrix4d rigidity = Matrix4d::Zero(), softening = Matrix4d::Zero();
  if (axial_load != 0.0) {
    softening = axial_load / h * p.integral<Matrix4d>([&](double s) {
      Vector4d slope;
      slope << shape(s).slope_of_strains(), interior_shape(phi, s).slope;
      return Matrix4d(slope * slope.transpose());
    });
    result.rigidity -= softening.topLeftCorner<2, 2>();
    result.flexibility = result.rigidity.inverse();
  }
  Matrix6d mass = Matrix6d::Zero();
  if (mass_model == MassModel::lumped)
    mass.topLeftCorner<4, 4>() = lumped_mass(p, added);
  else
    mass = p.integral<Matrix6d>([&](double s) {
      const NodalShape nodal = shape(s);
      const InteriorShape inner = interior_shape(phi, s);
      Vector6d deflection, rotation;
      deflection << nodal.deflection, inner.deflection;
      rotation << nodal.rotation, inner.rotation;
      return Matrix6d(h * (p.along(section.mass_per_length, s) + added) * deflection *
                          deflection.transpose() +
                      p.along(section.rotary_inertia, s) / h * rotation * rotation.transpose());
    });
  result.mass = mass.topLeftCorner<4, 4>();
  if (!with_interior) return result;

  rigidity.topLeftCorner<2, 2>() = static_rigidity;
  rigidity.bottomRightCorner<2, 2>() = interior_rigidity(p, phi);
  ElementMatrices::Interior interior{rigidity - softening, Matrix4d::Zero(), mass};
  if (axial_load != 0.0) {
    interior.flexibility = interior.rigidity.inverse();
  } else {
    interior.flexibility.topLeftCorner<2, 2>() = result.flexibility;
    interior.flexibility.bottomRightCorner<2, 2>() = rigidity.bottomRightCorner<2, 2>().inverse();
  }
  result.interior = interior;
  return result;
}

}  // namespace beamid::fem
