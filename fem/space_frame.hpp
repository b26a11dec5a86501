// A space frame: straight members between joints in three dimensions, in SI units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fem/beam.hpp"
#include "fem/frame.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

/// Of a member, the same all along; y and z are the section's principal axes. It bends about both, stretches
/// and twists as a shaft of Saint-Venant; its warping and any distance of its shear centre from its centroid
/// are neglected.
struct SpaceSection {
  double axial_stiffness = 0.0;                                ///< E A [N]
  double bending_stiffness_y = 0.0;                            ///< E I_y [N m2], of a deflection along z
  double bending_stiffness_z = 0.0;                            ///< E I_z [N m2], of a deflection along y
  double torsional_stiffness = 0.0;                            ///< G J [N m2]
  double mass_per_length = 0.0;                                ///< rho A [kg/m]
  double torsional_inertia = 0.0;                              ///< rho (I_y + I_z) [kg m]
  double rotary_inertia_y = 0.0;                               ///< rho I_y [kg m]; zero neglects it
  double rotary_inertia_z = 0.0;                               ///< rho I_z [kg m]
  std::optional<double> shear_stiffness_y, shear_stiffness_z;  ///< kappa G A along y and z [N]; absent:
                                                               ///< infinite
  std::vector<Eigen::Vector2d> outline = {};  ///< its corners (y, z) [m], for pictures; empty: unknown

  /// Of the deflection along `axis`, 'y' or 'z', as a beam's.
  Section bending(char axis) const;
};

/// Joints are told by their number, from 0 on.
struct SpaceFrame {
  struct Joint {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< x, y, z [m]
    std::string name = {};                            ///< empty: its number, from 1
  };
  /// How a member is fixed to a joint.
  struct End {
    bool x = false, y = false, z = false;  ///< moments about the member's axes that do not pass
    Eigen::Vector3d offset =
        Eigen::Vector3d::Zero();  ///< from the joint, rigidly, along the frame's axes [m]
  };
  struct Member {
    int first = 0, second = 0;
    SpaceSection section;
    /// In which the section's z points, as far as it is across the member; absent: the frame's z, or x for a
    /// member that is within half a degree of z.
    std::optional<Eigen::Vector3d> section_z = {};
    double roll = 0.0;  ///< of the section about the member's x, from there [rad]
    End at_first = {}, at_second = {};
    double stiffness_factor = 1.0;  ///< of all its stiffnesses: damage, or what a group is found to have
    std::string group = {};         ///< whose members share an unknown factor; empty: none
    double axial_load = 0.0;        ///< P [N], positive in compression, along the member as it stands at rest
  };
  /// What is held at zero: displacements and rotations.
  struct Support {
    int joint = 0;
    bool x = true, y = true, z = true, rx = true, ry = true, rz = true;
  };
  struct Body {
    int joint = 0;
    double mass = 0.0;                                  ///< [kg]
    Eigen::Vector3d inertia = Eigen::Vector3d::Zero();  ///< about its own centre, along x, y, z [kg m2]
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();   ///< of that centre from the joint, rigidly [m]
  };
  /// Between a joint and the ground.
  struct Spring {
    int joint = 0;
    Eigen::Vector3d translational = Eigen::Vector3d::Zero();  ///< along x, y, z [N/m]
    Eigen::Vector3d rotational = Eigen::Vector3d::Zero();     ///< about x, y, z [N m/rad]
  };
  /// Likewise, of the velocities.
  struct Dashpot {
    int joint = 0;
    Eigen::Vector3d translational = Eigen::Vector3d::Zero();  ///< along x, y, z [N s/m]
    Eigen::Vector3d rotational = Eigen::Vector3d::Zero();     ///< about x, y, z [N m s/rad]
  };
  std::vector<Joint> joints;
  std::vector<Member> members;
  std::vector<Support> supports;
  std::vector<Body> bodies;
  std::vector<Spring> springs;
  std::vector<Dashpot> dashpots = {};
  MassModel mass_model = MassModel::consistent;
  Eigen::Vector3d base_direction = Eigen::Vector3d::UnitX();  ///< along which the base moves; any length

  Eigen::Vector3d begin(std::size_t member) const;  ///< of the member itself, beyond its offset [m]
  Eigen::Vector3d end(std::size_t member) const;    ///< [m]
  double length(std::size_t member) const;          ///< [m]
  /// Columns x, y, z of the member: x from its first end to its second, z the section's.
  /// @throws std::invalid_argument where section_z is along the member.
  Eigen::Matrix3d axes(std::size_t member) const;
};

/// @throws std::invalid_argument naming the first joint, member or quantity that is impossible.
void validate(const SpaceFrame& frame);

/// A joint where forces act and motion is observed.
struct SpaceFramePoint {
  std::string name;
  int joint = 0;
};

/// Finite elements: each member is cut into `elements_per_member` equal ones (elements/space_frame_element).
///
/// Coordinates of a node: its displacements along x, y and z [m], and the scaled rotations s theta [m] about
/// x, y and z. The mesh's first nodes are the frame's joints. A moment that does not pass from a member to a
/// joint makes the rotation between both a coordinate of its own (generalised). What all members of a joint
/// are free of, one of them keeps: it turns with the joint.
///
/// The strains of an element determine first the rotations and then the displacements of its second node;
/// elements come in the order of a walk over the frame, so that where the walk closes a loop or meets a
/// support they are redundant.
///
/// Each point is, for each of x, y and z in which it can move, an input NAME_force_x [N] and an output
/// NAME_displacement_x [m]. The last three inputs are base_acceleration_x, _y and _z [m/s2], of all supports
/// and springs.
///
/// @throws std::invalid_argument when the frame is impossible, elements_per_member < 1, or a point does not
/// exist or cannot move.
StructuralSystem assemble(const SpaceFrame& frame, int elements_per_member,
                          const std::vector<SpaceFramePoint>& points = {});

// The axial loads that a beam or a frame bears.

/// The smallest compression [N] at which the beam, whatever its own axial load, has lost its stiffness: the
/// least P > 0 with det(K - P G) = 0, G from the elements' own geometric stiffness (elements/element.hpp), on
/// a mesh of `elements`. Nothing where the beam can move without strain.
/// @throws std::invalid_argument when the beam is impossible
std::optional<double> buckling_load(const Beam& beam, int elements = 40);

/// By how much all axial loads of a frame's members may grow together before it has lost its stiffness,
/// likewise, by bending or in space by twisting. Nothing where it can move without strain, or no growth does
/// that, as under tension alone.
std::optional<double> buckling_factor(const Frame& frame, int elements_per_member = 4);
std::optional<double> buckling_factor(const SpaceFrame& frame, int elements_per_member = 4);

}  // namespace beamid::fem
