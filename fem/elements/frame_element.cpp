#include "fem/elements/frame_element.hpp"

#include <cmath>

#include "fem/elements/element.hpp"
#include "fem/elements/element_shapes.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd;

struct AxialMatrices {
  double rigidity, flexibility;
  Eigen::Matrix2d mass;
};

AxialMatrices axial_matrices(const Section& section, const Mesh::Element& element, MassModel mass_model) {
  const ElementSection p{section, element};
  const double h = element.length;
  const auto mean = [&](const auto& f) {
    return p.integral<Eigen::Vector<double, 1>>([&](double s) { return Eigen::Vector<double, 1>(f(s)); })[0];
  };
  const Variation& stiffness = *section.axial_stiffness;
  AxialMatrices result;
  if (p.along(stiffness, 0.0) > 0.0 && p.along(stiffness, 1.0) > 0.0) {
    result.flexibility = h * mean([&](double s) { return 1.0 / p.along(stiffness, s); });
    result.rigidity = 1.0 / result.flexibility;
  } else {  // a sharp end stretches without bound; a linear displacement does not
    result.rigidity = mean([&](double s) { return p.along(stiffness, s); }) / h;
    result.flexibility = 1.0 / result.rigidity;
  }
  const auto mass = [&](int power_first, int power_second) {
    return h * mean([&](double s) {
             return p.along(section.mass_per_length, s) * std::pow(1.0 - s, power_first) *
                    std::pow(s, power_second);
           });
  };
  if (mass_model == MassModel::lumped)
    result.mass << mass(1, 0), 0.0, 0.0, mass(0, 1);
  else
    result.mass << mass(2, 0), mass(1, 1), mass(1, 1), mass(0, 2);
  return result;
}

}  // namespace

FrameElementMatrices frame_element_matrices(const Section& section, const Mesh::Element& element,
                                            const Eigen::Vector2d& direction, MassModel mass_model) {
  const ElementMatrices bending = element_matrices(section, element, 0.0, 0.0, mass_model);
  const AxialMatrices axial = axial_matrices(section, element, mass_model);
  const Index inside = bending.interior ? 2 : 0, strains = 3 + inside, coordinates = 6 + inside;
  const Eigen::Vector2d& t = direction;
  const Eigen::Vector2d n(-t[1], t[0]);

  FrameElementMatrices result;
  result.strain = MatrixXd::Zero(strains, coordinates);
  result.strain.topLeftCorner<3, 6>() << -1, 0, -n[0], 1, 0, 0,  //
      0, -1, -n[1], 0, 1, 0,                                     //
      0, 0, -1, 0, 0, 1;
  result.strain.bottomRightCorner(inside, inside).setIdentity();

  // (elongation, epsilon_1, epsilon_2, interior) -> the strains here, an orthogonal matrix
  MatrixXd turn = MatrixXd::Identity(strains, strains);
  turn.topLeftCorner<2, 2>() << t, -n;
  const auto turned = [&](double elongation, const MatrixXd& bend) {
    MatrixXd block = MatrixXd::Zero(strains, strains);
    block(0, 0) = elongation;
    block.bottomRightCorner(strains - 1, strains - 1) = bend;
    return MatrixXd(turn * block * turn.transpose());
  };
  const MatrixXd rigidity = inside > 0 ? MatrixXd(bending.interior->rigidity) : MatrixXd(bending.rigidity);
  const MatrixXd flexibility =
      inside > 0 ? MatrixXd(bending.interior->flexibility) : MatrixXd(bending.flexibility);
  result.rigidity = turned(axial.rigidity, rigidity);
  result.flexibility = turned(axial.flexibility, flexibility);

  MatrixXd across = MatrixXd::Zero(4 + inside, coordinates);  // (w_1, h theta_1, w_2, h theta_2, interior)
  across.block<1, 2>(0, 0) = across.block<1, 2>(2, 3) = n.transpose();
  across(1, 2) = across(3, 5) = 1.0;
  across.bottomRightCorner(inside, inside).setIdentity();
  MatrixXd along = MatrixXd::Zero(2, coordinates);
  along.block<1, 2>(0, 0) = along.block<1, 2>(1, 3) = t.transpose();
  const MatrixXd mass = inside > 0 ? MatrixXd(bending.interior->mass) : MatrixXd(bending.mass);
  result.mass = across.transpose() * mass * across + along.transpose() * axial.mass * along;
  return result;
}

}  // namespace beamid::fem
