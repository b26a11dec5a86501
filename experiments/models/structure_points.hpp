// Where forces act on a beam and its motion is observed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fem/assembly.hpp"

namespace beamid::experiments {

/// "root", "tip" or "x0.4m".
std::string name_of_place(double position, double length);

/// Points without repetition, numbered as inputs and outputs of fem::assemble.
class BeamPoints {
 public:
  explicit BeamPoints(const fem::Beam& beam) : natural_(fem::natural_point(beam)), length_(beam.length()) {}

  /// @param position [m]; absent: fem::natural_point(). @returns its number.
  Eigen::Index add(const std::optional<double>& position);

  const std::vector<fem::Point>& all() const { return points_; }
  const fem::Point& operator[](Eigen::Index number) const { return points_[number]; }

 private:
  fem::Point natural_;
  double length_;
  std::vector<fem::Point> points_;
};

}  // namespace beamid::experiments
