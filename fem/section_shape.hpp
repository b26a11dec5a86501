// Sections of a space frame's members by their dimensions.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace beamid::fem {

/// About the principal axes y and z, along which the dimensions lie: widths along y, heights along z.
struct SectionShape {
  double area = 0.0;                          ///< A [m2]
  double second_moment_y = 0.0;               ///< I_y, of z^2 dA [m4]
  double second_moment_z = 0.0;               ///< I_z, of y^2 dA [m4]
  double torsion_constant = 0.0;              ///< J of Saint-Venant [m4]
  double shear_area_y = 0.0;                  ///< kappa A of a shear force along y [m2]
  double shear_area_z = 0.0;                  ///< along z [m2]
  std::vector<Eigen::Vector2d> outline = {};  ///< corners (y, z), counterclockwise seen against x [m]
};

/// J = a b^3 (1/3 - 64/pi^5 (b/a) sum_odd tanh(n pi a / 2b) / n^5), b the shorter side [timoshenko1970];
/// kappa is Cowper's [cowper1966].
SectionShape rectangle_shape(double width, double height, double poissons_ratio);

/// A ring, with `wall` half the diameter a full circle; J is the polar second moment. kappa is Cowper's
/// [cowper1966], with m the ratio of both diameters:
/// 6 (1 + nu) (1 + m^2)^2 / ((7 + 6 nu) (1 + m^2)^2 + (20 + 12 nu) m^2).
SectionShape tube_shape(double diameter, double wall, double poissons_ratio);

/// Two flanges of width x `flange`, joined by a web of thickness `web`. Thin-walled: J is a third of the sum
/// of length x thickness^3 of its plates; a shear force along z is carried by the web, height x web, and one
/// along y by the flanges, 5/6 of their area.
SectionShape i_shape(double width, double height, double web, double flange);

}  // namespace beamid::fem
