// Where forces act on a structure and its motion is observed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fem/structure.hpp"

namespace beamid::experiments {

/// "root", "tip" or "x0.4m".
std::string name_of_place(double position, double length);

/// Points without repetition, numbered as inputs and outputs of fem::assemble.
class StructurePoints {
 public:
  explicit StructurePoints(const fem::Structure& structure)
      : natural_(fem::natural_point(structure)), length_(structure.extent()) {}

  /// @param position [m]; absent: fem::natural_point(). @param place its name instead, where places have
  /// names. @param rotates whether its rotation is meant. @returns its number.
  /// @throws std::invalid_argument for a rotation where places have names: a place is one motion there.
  Eigen::Index add(const std::optional<double>& position, const std::string& place = {},
                   bool rotates = false);

  const std::vector<fem::Point>& all() const { return points_; }
  const fem::Point& operator[](Eigen::Index number) const { return points_[number]; }

 private:
  Eigen::Index add_named(const std::string& place);

  fem::Point natural_;
  double length_;
  std::vector<fem::Point> points_;
};

}  // namespace beamid::experiments
