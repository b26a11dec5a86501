// What a beam is made of along one segment, and the sections it can be worked out from.
#pragma once

#include <optional>

#include "fem/variation.hpp"

namespace beamid::fem {

/// The drawn outline of a section, for pictures; nothing is computed from it.
struct Outline {
  enum class Shape { none, rectangle, ellipse };
  Shape shape = Shape::none;
  Variation width;   ///< across the direction of bending [m]
  Variation height;  ///< in the direction of bending [m]
};

/// Properties along a segment. Without a shear stiffness it is an Euler-Bernoulli beam, with one a Timoshenko
/// beam.
struct Section {
  Variation bending_stiffness;               ///< E I [N m2]
  Variation mass_per_length;                 ///< rho A [kg/m]
  Variation rotary_inertia = {};             ///< rho I [kg m]; zero neglects it
  std::optional<Variation> shear_stiffness;  ///< kappa G A [N]; absent: infinite
  std::optional<Variation> axial_stiffness;  ///< E A [N]; only frames use it
  Outline outline = {};

  /// The same all along.
  bool is_uniform() const;
};

/// Second moment of area of a rectangle about its own axis, width x height^3 / 12 [m4].
constexpr double rectangle_second_moment(double width, double height) {
  return width * height * height * height / 12.0;
}

/// Shear correction factor kappa of a rectangle, 10 (1 + nu) / (12 + 11 nu) [cowper1966].
constexpr double rectangle_shear_factor(double poissons_ratio) {
  return 10.0 * (1.0 + poissons_ratio) / (12.0 + 11.0 * poissons_ratio);
}

/// Shear correction factor kappa of a circle, 6 (1 + nu) / (7 + 6 nu) [cowper1966].
constexpr double circle_shear_factor(double poissons_ratio) {
  return 6.0 * (1.0 + poissons_ratio) / (7.0 + 6.0 * poissons_ratio);
}

}  // namespace beamid::fem
