// The equations of plane frames: what the assemblies of plane and space frames collect on their way.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fem/parametric_system.hpp"
#include "fem/structural_system.hpp"

namespace beamid::fem {

/// The entries of M, C, B, D and D^-1 and of the inputs, in the order in which elements, springs, bodies and
/// dashpots come.
class FrameEquations {
 public:
  /// @param axes along which the base moves and points are asked about: "xy" or "xyz"
  explicit FrameEquations(std::string axes) : axes_(std::move(axes)) {}

  int strains() const { return strains_; }  ///< so far: the number of the next one

  /// @param direction of the base's motion, 0 for x, that moves `column` along; -1: none. A row or column of
  /// -1 is held.
  void add_mass(int row, int column, double value, int direction);
  void add_damping(int coordinate, double value);
  void add_strain(int strain, int coordinate, double value);

  /// The block of the next strains (s x s).
  void add_rigidity(const Eigen::MatrixXd& rigidity, const Eigen::MatrixXd& flexibility);

  /// A spring between a coordinate and the ground, whose strain is the coordinate.
  void add_ground_spring(int coordinate, double rigidity);

  /// Inputs NAME_force_x and outputs NAME_displacement_x of the coordinates, one for each axis.
  /// @throws std::invalid_argument when all of them are held
  void add_point(const std::string& name, const std::vector<int>& coordinates);

  /// Into a system whose coordinates are known.
  void put_into(StructuralSystem& system) const;

 private:
  std::string axes_;
  Triplets mass_, damping_, strain_, rigidity_, flexibility_, base_, inputs_, outputs_;
  std::vector<std::string> input_names_, output_names_;
  int strains_ = 0;
};

/// @throws std::invalid_argument when the system has no coordinate or a point is at none of the joints
template <class AnyPoint>
void check_points(const StructuralSystem& system, const std::vector<AnyPoint>& points, std::size_t joints) {
  if (system.coordinates.empty())
    throw std::invalid_argument("the supports hold every joint; expected some freedom");
  for (const AnyPoint& point : points)
    if (point.joint < 0 || point.joint >= static_cast<int>(joints))
      throw std::invalid_argument("point '" + point.name + "' is at joint " + std::to_string(point.joint) +
                                  "; expected 0 to " + std::to_string(joints - 1));
}

}  // namespace beamid::fem
