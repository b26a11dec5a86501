#include "fem/elements/frame_element.hpp"

#include "fem/elements/chord.hpp"
#include "fem/elements/element.hpp"
#include "fem/elements/rod_element.hpp"

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

FrameElementMatrices frame_element_matrices(const Section& section, const Mesh::Element& element,
                                            const Eigen::Vector2d& direction, double axial_load,
                                            MassModel mass_model) {
  const ElementMatrices bending = element_matrices(section, element, 0.0, axial_load, mass_model);
  const RodMatrices rod =
      rod_matrices(section, element, *section.axial_stiffness, section.mass_per_length, mass_model);
  const Index bent_inside = bending.interior ? 2 : 0, inside = bent_inside + rod.inside(),
              strains = 3 + inside, coordinates = 6 + inside;
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
  const auto turned = [&](const VectorXd& stretch, const MatrixXd& bend) {
    MatrixXd block = MatrixXd::Zero(strains, strains);
    block(0, 0) = stretch[0];
    block.block(1, 1, bend.rows(), bend.rows()) = bend;
    block.diagonal().tail(rod.inside()) = stretch.tail(rod.inside());
    return MatrixXd(turn * block * turn.transpose());
  };
  const bool deep = bent_inside > 0;
  result.rigidity =
      turned(rod.rigidity, deep ? MatrixXd(bending.interior->rigidity) : MatrixXd(bending.rigidity));
  result.flexibility =
      turned(rod.flexibility, deep ? MatrixXd(bending.interior->flexibility) : MatrixXd(bending.flexibility));
  if (axial_load != 0.0)
    add_chord(n, 3, axial_load / element.length, result.strain, result.rigidity, result.flexibility);

  MatrixXd across =
      MatrixXd::Zero(4 + bent_inside, coordinates);  // (w_1, h theta_1, w_2, h theta_2, interior)
  across.block<1, 2>(0, 0) = across.block<1, 2>(2, 3) = n.transpose();
  across(1, 2) = across(3, 5) = 1.0;
  across.block(4, 6, bent_inside, bent_inside).setIdentity();
  MatrixXd along = MatrixXd::Zero(2 + rod.inside(), coordinates);  // (u_1, u_2, interior)
  along.block<1, 2>(0, 0) = along.block<1, 2>(1, 3) = t.transpose();
  along.bottomRightCorner(rod.inside(), rod.inside()).setIdentity();
  const MatrixXd mass = deep ? MatrixXd(bending.interior->mass) : MatrixXd(bending.mass);
  result.mass = across.transpose() * mass * across + along.transpose() * rod.mass * along;
  return result;
}

}  // namespace beamid::fem
