// Oracles: closed forms, tables of sections, and integrals over the outline.
#include "fem/section.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace beamid::fem::section_shape_test {
namespace {

using std::numbers::pi;

struct PolygonMoments {
  double area = 0.0, y = 0.0, z = 0.0;  // A, the integrals of z^2 and of y^2
};

// Green's theorem around the corners.
PolygonMoments moments_of(const std::vector<Eigen::Vector2d>& corners) {
  PolygonMoments sum;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double cross = a[0] * b[1] - b[0] * a[1];
    sum.area += cross / 2;
    sum.y += cross / 12 * (a[1] * a[1] + a[1] * b[1] + b[1] * b[1]);
    sum.z += cross / 12 * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]);
  }
  return sum;
}

TEST(SectionShape, HasTheMomentsOfItsOutline) {
  for (const SectionShape& shape : {rectangle_shape(0.1, 0.25, 0.3), i_shape(0.1, 0.2, 0.0056, 0.0085)}) {
    const PolygonMoments moments = moments_of(shape.outline);
    EXPECT_NEAR(shape.area / moments.area, 1.0, 1e-14);
    EXPECT_NEAR(shape.second_moment_y / moments.y, 1.0, 1e-13);
    EXPECT_NEAR(shape.second_moment_z / moments.z, 1.0, 1e-13);
  }
}

// Saint-Venant's constant of rectangles as tabulated, J / a b^3.
TEST(SectionShape, TwistsAsSaintVenantsRectangle) {
  for (const auto& [ratio, expected] :
       {std::pair{1.0, 0.1406}, {1.5, 0.1958}, {2.0, 0.2287}, {4.0, 0.2808}, {10.0, 0.3123}})
    for (const bool upright : {false, true}) {
      const double a = ratio, b = 1.0;
      const SectionShape shape = upright ? rectangle_shape(b, a, 0.3) : rectangle_shape(a, b, 0.3);
      EXPECT_NEAR(shape.torsion_constant / (a * b * b * b), expected, 6e-5) << ratio;
    }
}

TEST(SectionShape, OfATubeHasClosedForms) {
  const double d = 0.1683, t = 0.008, inner = d - 2 * t;
  const SectionShape tube = tube_shape(d, t, 0.3), circle = tube_shape(0.2, 0.1, 0.3);
  EXPECT_NEAR(tube.area / (pi / 4 * (d * d - inner * inner)), 1.0, 1e-14);
  EXPECT_NEAR(tube.second_moment_y / (pi / 64 * (std::pow(d, 4) - std::pow(inner, 4))), 1.0, 1e-14);
  EXPECT_NEAR(tube.torsion_constant / (2 * tube.second_moment_z), 1.0, 1e-14);
  EXPECT_NEAR(circle.area, pi / 4 * 0.04, 1e-16);
  EXPECT_NEAR(circle.shear_area_y / circle.area, 6 * 1.3 / (7 + 6 * 0.3), 1e-14);  // Cowper's circle
  EXPECT_NEAR(tube_shape(1.0, 1e-9, 0.3).shear_area_z / tube_shape(1.0, 1e-9, 0.3).area,
              2 * 1.3 / (4 + 3 * 0.3),
              1e-8);  // Cowper's thin tube, 2 (1 + nu) / (4 + 3 nu)
}

// IPE 200 without its fillets, 100 x 200 x 5.6 x 8.5 mm; the tables' A = 28.5 cm2, I_y = 1943 cm4, I_z = 142
// cm4 and J = 6.98 cm4 contain them, which matters least to I_z and most to J.
TEST(SectionShape, OfAnIIsNearTheTables) {
  const SectionShape ipe = i_shape(0.1, 0.2, 0.0056, 0.0085);
  EXPECT_NEAR(ipe.area / 28.5e-4, 1.0, 0.06);
  EXPECT_NEAR(ipe.second_moment_y / 1943e-8, 1.0, 0.06);
  EXPECT_NEAR(ipe.second_moment_z / 142e-8, 1.0, 0.01);
  EXPECT_NEAR(ipe.torsion_constant / ((2 * 0.1 * std::pow(0.0085, 3) + 0.1915 * std::pow(0.0056, 3)) / 3),
              1.0, 1e-14);
}

}  // namespace
}  // namespace beamid::fem::section_shape_test
