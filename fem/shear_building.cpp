#include "fem/shear_building.hpp"

#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

namespace beamid::fem {
namespace {

constexpr double weightless = 1e-15;  // mass of all columns, over that of the floors

void require_storeys(const std::vector<double>& values, std::size_t count, const char* what, bool positive) {
  std::ostringstream message;
  if (values.size() != count) {
    message << values.size() << " " << what << " for " << count << " floors; expected one for each";
    throw std::invalid_argument(message.str());
  }
  for (std::size_t i = 0; i < count; ++i)
    if (!std::isfinite(values[i]) || values[i] < 0.0 || (positive && values[i] == 0.0)) {
      message << what << ": number " << i + 1 << " is " << values[i] << "; expected "
              << (positive ? "positive numbers" : "positive numbers or zero");
      throw std::invalid_argument(message.str());
    }
}

}  // namespace

Beam shear_building(const Storeys& storeys) {
  const std::size_t n = storeys.masses.size();
  if (n == 0) throw std::invalid_argument("a shear building without floors; expected one at least");
  const std::vector<double> heights = storeys.heights.empty() ? std::vector<double>(n, 1.0) : storeys.heights;
  const std::vector<double> dashpots =
      storeys.dashpots.empty() ? std::vector<double>(n, 0.0) : storeys.dashpots;
  require_storeys(storeys.masses, n, "masses", true);
  require_storeys(storeys.stiffnesses, n, "stiffnesses", true);
  require_storeys(heights, n, "heights", true);
  require_storeys(dashpots, n, "dashpots", false);
  const double mass = std::accumulate(storeys.masses.begin(), storeys.masses.end(), 0.0),
               height = std::accumulate(heights.begin(), heights.end(), 0.0);
  Beam beam;
  beam.shear_building = true;
  beam.supports.push_back({0.0});
  double place = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double h = heights[i];
    Segment storey{h, {}, dashpots[i]};
    storey.section.bending_stiffness = storeys.stiffnesses[i] * h * h * h / 12.0;
    storey.section.mass_per_length = weightless * mass / height;
    beam.segments.push_back(storey);
    place += h;
    beam.bodies.push_back({place, storeys.masses[i]});
    beam.supports.push_back({place, false, true});
  }
  return beam;
}

double storey_stiffness(const Segment& storey) {
  return 12.0 * storey.section.bending_stiffness.mean() / std::pow(storey.length, 3);
}

Storeys soil_column(const std::vector<SoilLayer>& layers) {
  Storeys column;
  for (const SoilLayer& layer : layers) {
    const double half = 0.5 * layer.density * layer.thickness;
    if (!column.masses.empty()) column.masses.back() += half;
    column.masses.push_back(half);
    column.stiffnesses.push_back(layer.density * layer.shear_wave_velocity * layer.shear_wave_velocity /
                                 layer.thickness);
    column.heights.push_back(layer.thickness);
  }
  return column;
}

}  // namespace beamid::fem
