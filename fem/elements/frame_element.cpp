#include "fem/elements/frame_element.hpp"

#include "fem/elements/element.hpp"
#include "fem/elements/rod_element.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd;

// The strain n (u_2 - u_1, v_2 - v_1) of rigidity -load per length, behind the others.
void add_chord(FrameElementMatrices& element, const Eigen::Vector2d& n, double softening) {
  const Index last = element.strain.rows();
  element.strain.conservativeResizeLike(MatrixXd::Zero(last + 1, element.strain.cols()));
  element.strain.block<1, 2>(last, 0) = -n.transpose();
  element.strain.block<1, 2>(last, 3) = n.transpose();
  element.rigidity.conservativeResizeLike(MatrixXd::Zero(last + 1, last + 1));
  element.flexibility.conservativeResizeLike(MatrixXd::Zero(last + 1, last + 1));
  element.rigidity(last, last) = -softening;
  element.flexibility(last, last) = -1.0 / softening;
}

}  // namespace

FrameElementMatrices frame_element_matrices(const Section& section, const Mesh::Element& element,
                                            const Eigen::Vector2d& direction, double axial_load,
                                            MassModel mass_model) {
  const ElementMatrices bending = element_matrices(section, element, 0.0, axial_load, mass_model);
  const RodMatrices axial =
      rod_matrices(section, element, *section.axial_stiffness, section.mass_per_length, mass_model);
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
  if (axial_load != 0.0) add_chord(result, n, axial_load / element.length);

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
