#include "fem/elements/space_frame_element.hpp"

#include <vector>

#include "fem/elements/element.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd;

// Bending in one of the member's planes: of which strains and coordinates along the member's axes the beam
// element's own are made, and with which sign. Rows are (theta, d), columns (d_1, theta_1, d_2, theta_2).
struct BendingPlane {
  ElementMatrices matrices;
  int across, about;  // axis of the deflection and of the rotation
  double sense;       // of the rotation: dw/dx = sense x theta
  Index inside, first_inside;

  MatrixXd part(bool flexible) const {
    if (inside > 0)
      return flexible ? MatrixXd(matrices.interior->flexibility) : MatrixXd(matrices.interior->rigidity);
    return flexible ? MatrixXd(matrices.flexibility) : MatrixXd(matrices.rigidity);
  }
  MatrixXd mass() const { return inside > 0 ? MatrixXd(matrices.interior->mass) : MatrixXd(matrices.mass); }

  MatrixXd strains(Index count) const {  // own strains -> those of the element
    MatrixXd map = MatrixXd::Zero(count, 2 + inside);
    map(3 + across, 0) = -1.0;
    map(about, 1) = sense;
    map.block(6 + first_inside, 2, inside, inside).setIdentity();
    return map;
  }
  MatrixXd coordinates(Index count) const {  // those of the element -> own coordinates
    MatrixXd map = MatrixXd::Zero(4 + inside, count);
    map(0, across) = map(2, 6 + across) = 1.0;
    map(1, 3 + about) = map(3, 9 + about) = sense;
    map.block(4, 12 + first_inside, inside, inside).setIdentity();
    return map;
  }
};

BendingPlane bending_plane(const Section& section, const Mesh::Element& element, double axial_load,
                           MassModel mass_model, int across, Index first_inside) {
  BendingPlane plane{element_matrices(section, element, 0.0, axial_load, mass_model),
                     across,
                     across == 1 ? 2 : 1,
                     across == 1 ? 1.0 : -1.0,
                     0,
                     first_inside};
  plane.inside = plane.matrices.interior ? 2 : 0;
  return plane;
}

// The section's torsional stiffness less what the load takes.
RodMatrices shaft_matrices(const SpaceSection& section, const Mesh::Element& element, double axial_load,
                           MassModel mass_model) {
  RodMatrices shaft = rod_matrices(section.bending('y'), element, section.torsional_stiffness,
                                   section.torsional_inertia, mass_model);
  if (axial_load == 0.0) return shaft;
  const double lost = axial_load * section.torsional_inertia / section.mass_per_length;
  shaft.rigidity *= 1.0 - lost / section.torsional_stiffness;
  shaft.flexibility = shaft.rigidity.cwiseInverse();
  return shaft;
}

// Where the rod's own strains and coordinates are among those of the element.
struct RodPlace {
  const RodMatrices& matrices;
  Index strain, first, second, inside;
  double scale;  // of the element's coordinates: they are `scale` times the rod's

  void add(MatrixXd& rigidity, MatrixXd& flexibility, MatrixXd& mass) const {
    const double square = scale * scale;
    std::vector<Index> strains{strain}, coordinates{first, second};
    if (matrices.inside() > 0) strains.push_back(6 + inside), coordinates.push_back(12 + inside);
    for (std::size_t i = 0; i < strains.size(); ++i) {
      rigidity(strains[i], strains[i]) += matrices.rigidity[static_cast<Index>(i)] / square;
      flexibility(strains[i], strains[i]) += matrices.flexibility[static_cast<Index>(i)] * square;
    }
    mass(coordinates, coordinates) += matrices.mass / square;
  }
};

// Each triple of rows along the member's axes turned into the frame's.
MatrixXd turned_rows(const MatrixXd& local, const Eigen::Matrix3d& axes, Index triples) {
  MatrixXd result = local;
  for (Index i = 0; i < triples; ++i) result.middleRows(3 * i, 3) = axes * local.middleRows(3 * i, 3);
  return result;
}

MatrixXd turned(const MatrixXd& local, const Eigen::Matrix3d& axes, Index triples) {
  return turned_rows(turned_rows(local, axes, triples).transpose(), axes, triples);
}

}  // namespace

SpaceFrameElementMatrices space_frame_element_matrices(const SpaceSection& section,
                                                       const Mesh::Element& element,
                                                       const Eigen::Matrix3d& axes, double axial_load,
                                                       MassModel mass_model) {
  const double h = element.length;
  const Section in_y = section.bending('y'), in_z = section.bending('z');
  const BendingPlane along_y = bending_plane(in_y, element, axial_load, mass_model, 1, 0),
                     along_z = bending_plane(in_z, element, axial_load, mass_model, 2, along_y.inside);
  const RodMatrices rod = rod_matrices(in_y, element, section.axial_stiffness, section.mass_per_length,
                                       mass_model),
                    shaft = shaft_matrices(section, element, axial_load, mass_model);
  const Index bent_inside = along_y.inside + along_z.inside,
              inside = bent_inside + rod.inside() + shaft.inside(), strains = 6 + inside,
              coordinates = 12 + inside;

  SpaceFrameElementMatrices result;
  result.strain = MatrixXd::Zero(strains, coordinates);
  result.strain.block<3, 3>(0, 3) = -Eigen::Matrix3d::Identity();
  result.strain.block<3, 3>(0, 9) = Eigen::Matrix3d::Identity();
  result.strain.block<3, 3>(3, 0) = -Eigen::Matrix3d::Identity();
  result.strain.block<3, 3>(3, 6) = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d t = axes.col(0);
  result.strain.block<3, 3>(3, 3) << 0, -t[2], t[1], t[2], 0, -t[0], -t[1], t[0], 0;  // t x = - (x t)
  result.strain.bottomRightCorner(inside, inside).setIdentity();

  MatrixXd rigidity = MatrixXd::Zero(strains, strains), flexibility = rigidity,
           mass = MatrixXd::Zero(coordinates, coordinates);
  RodPlace{rod, 3, 0, 6, bent_inside, 1.0}.add(rigidity, flexibility, mass);
  RodPlace{shaft, 0, 3, 9, bent_inside + rod.inside(), h}.add(rigidity, flexibility, mass);
  for (const BendingPlane* const plane : {&along_y, &along_z}) {
    const MatrixXd to_strains = plane->strains(strains), to_own = plane->coordinates(coordinates);
    rigidity += to_strains * plane->part(false) * to_strains.transpose();
    flexibility += to_strains * plane->part(true) * to_strains.transpose();
    mass += to_own.transpose() * plane->mass() * to_own;
  }
  result.rigidity = turned(rigidity, axes, 2);
  result.flexibility = turned(flexibility, axes, 2);
  result.mass = turned(mass, axes, 4);
  if (axial_load != 0.0)
    for (const Index across : {1, 2})
      add_chord(axes.col(across), 6, axial_load / h, result.strain, result.rigidity, result.flexibility);
  return result;
}

}  // namespace beamid::fem
