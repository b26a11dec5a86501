#include "fem/section.hpp"

#include <cmath>
#include <numbers>

namespace beamid::fem {
namespace {

using std::numbers::pi;

double rectangle_torsion_constant(double one, double other) {
  const double a = std::max(one, other), b = std::min(one, other);
  double sum = 0.0;
  for (int n = 39; n > 0; n -= 2) sum += std::tanh(n * pi * a / (2.0 * b)) / std::pow(n, 5);
  return a * b * b * b * (1.0 / 3.0 - 64.0 / std::pow(pi, 5) * (b / a) * sum);
}

}  // namespace

SectionShape rectangle_shape(double width, double height, double poissons_ratio) {
  const double area = width * height, y = 0.5 * width, z = 0.5 * height;
  const double sheared = rectangle_shear_factor(poissons_ratio) * area;
  return {area,
          rectangle_second_moment(width, height),
          rectangle_second_moment(height, width),
          rectangle_torsion_constant(width, height),
          sheared,
          sheared,
          {{y, z}, {-y, z}, {-y, -z}, {y, -z}}};
}

SectionShape tube_shape(double diameter, double wall, double poissons_ratio) {
  constexpr int sides = 24;
  const double m = (diameter - 2.0 * wall) / diameter, nu = poissons_ratio, ring = 1.0 + m * m;
  const double area = pi / 4.0 * diameter * diameter * (1.0 - m * m),
               second_moment = pi / 64.0 * std::pow(diameter, 4) * (1.0 - std::pow(m, 4));
  const double kappa =
      6.0 * (1.0 + nu) * ring * ring / ((7.0 + 6.0 * nu) * ring * ring + (20.0 + 12.0 * nu) * m * m);
  SectionShape shape{area, second_moment, second_moment, 2.0 * second_moment, kappa * area, kappa * area, {}};
  for (int side = 0; side < sides; ++side) {
    const double angle = 2.0 * pi * side / sides;
    shape.outline.emplace_back(0.5 * diameter * std::cos(angle), 0.5 * diameter * std::sin(angle));
  }
  return shape;
}

SectionShape i_shape(double width, double height, double web, double flange) {
  const double inside = height - 2.0 * flange, y = 0.5 * width, z = 0.5 * height, t = 0.5 * web,
               f = 0.5 * inside;
  return {2.0 * width * flange + inside * web,
          rectangle_second_moment(width, height) - rectangle_second_moment(width - web, inside),
          2.0 * rectangle_second_moment(flange, width) + rectangle_second_moment(inside, web),
          (2.0 * width * std::pow(flange, 3) + (height - flange) * std::pow(web, 3)) / 3.0,
          5.0 / 6.0 * 2.0 * width * flange,
          height * web,
          {{y, z},
           {-y, z},
           {-y, f},
           {-t, f},
           {-t, -f},
           {-y, -f},
           {-y, -z},
           {y, -z},
           {y, -f},
           {t, -f},
           {t, f},
           {y, f}}};
}

bool Section::is_uniform() const {
  return bending_stiffness.is_constant() && mass_per_length.is_constant() && rotary_inertia.is_constant() &&
         (!shear_stiffness || shear_stiffness->is_constant()) &&
         (!axial_stiffness || axial_stiffness->is_constant());
}

}  // namespace beamid::fem
