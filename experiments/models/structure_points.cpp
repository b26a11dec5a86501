#include "experiments/models/structure_points.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

constexpr double same_place = 1e-9;  // of the beam's length, as in fem::cut

}  // namespace

std::string name_of_place(double position, double length) {
  if (position == length) return "tip";
  return position == 0.0 ? std::string("root") : fmt::format("x{:g}m", position);
}

Eigen::Index StructurePoints::add(const std::optional<double>& position, const std::string& place,
                                  bool rotates) {
  if (rotates && !natural_.place.empty())
    throw std::invalid_argument(fmt::format(
        "angular_acceleration at '{}': it is of a beam; expected acceleration at a place that rotates",
        place.empty() ? natural_.place : place));
  if (!natural_.place.empty()) return add_named(place.empty() ? natural_.place : place);
  const double where = position.value_or(natural_.position);
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (points_[i].rotates == rotates && std::abs(points_[i].position - where) <= same_place * length_)
      return static_cast<Eigen::Index>(i);
  const bool natural = std::abs(where - natural_.position) <= same_place * length_;
  points_.push_back({natural ? natural_.name : name_of_place(where, length_), where, {}, rotates});
  return static_cast<Eigen::Index>(points_.size()) - 1;
}

Eigen::Index StructurePoints::add_named(const std::string& place) {
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (points_[i].place == place) return static_cast<Eigen::Index>(i);
  points_.push_back({place, 0.0, place});
  return static_cast<Eigen::Index>(points_.size()) - 1;
}

}  // namespace beamid::experiments
