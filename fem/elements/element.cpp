#include "fem/elements/element.hpp"

#include <algorithm>

#include <Eigen/LU>

namespace beamid::fem {

using Eigen::Index, Eigen::Matrix2d, Eigen::Matrix3d, Eigen::Matrix4d, Eigen::MatrixXd, Eigen::Vector2d,
    Eigen::Vector3d, Eigen::Vector4d;

void add_chord(const Eigen::VectorXd& across, Index second, double softening, MatrixXd& strain,
               MatrixXd& rigidity, MatrixXd& flexibility) {
  const Index last = strain.rows();
  for (MatrixXd* const factor : {&rigidity, &flexibility})
    factor->conservativeResizeLike(MatrixXd::Zero(last + 1, last + 1));
  strain.conservativeResizeLike(MatrixXd::Zero(last + 1, strain.cols()));
  strain.row(last).head(across.size()) = -across.transpose();
  strain.row(last).segment(second, across.size()) = across.transpose();
  rigidity(last, last) = -softening;
  flexibility(last, last) = -1.0 / softening;
}

namespace {

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

namespace {

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
