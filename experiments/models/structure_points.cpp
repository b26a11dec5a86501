#include "experiments/models/beam_points.hpp"

#include <fmt/format.h>

#include <cmath>

namespace beamid::experiments {
namespace {

constexpr double same_place = 1e-9;  // of the beam's length, as in fem::cut

}  // namespace

std::string name_of_place(double position, double length) {
  if (position == length) return "tip";
  return position == 0.0 ? std::string("root") : fmt::format("x{:g}m", position);
}

Eigen::Index BeamPoints::add(const std::optional<double>& position) {
  const double place = position.value_or(natural_.position);
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (std::abs(points_[i].position - place) <= same_place * length_) return static_cast<Eigen::Index>(i);
  const bool natural = std::abs(place - natural_.position) <= same_place * length_;
  points_.push_back({natural ? natural_.name : name_of_place(place, length_), place});
  return static_cast<Eigen::Index>(points_.size()) - 1;
}

}  // namespace beamid::experiments
