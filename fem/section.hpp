// What a beam is made of along one segment, and the sections it can be worked out from.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>

namespace beamid::fem {

// Sections of a space frame's members by their dimensions.

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

// How a property varies along a segment of a beam.

/// A polynomial in s, from 0 at the segment's root end to 1 at the other, of degree four at most: enough for
/// the second moment of area of a cone (height^4) and of a wedge (width height^3). It is kept in Bernstein's
/// form [farouki2012],
///
///     sum_i b_i C(n, i) (1 - s)^(n - i) s^i,
///
/// whose terms are all positive where the b_i are: nothing cancels near a sharp tip, where b_n = 0.
class Variation {
 public:
  constexpr Variation(double constant = 0.0) : coefficients_{constant, 0, 0, 0, 0} {}

  /// From `start` at s = 0 to `end` at s = 1 along a straight line.
  static constexpr Variation linear(double start, double end) {
    Variation result(start);
    if (start == end) return result;
    result.degree_ = 1;
    result.coefficients_[1] = end;
    return result;
  }

  /// By de Casteljau's repeated means.
  constexpr double operator()(double s) const {
    std::array<double, most + 1> mean = coefficients_;
    for (std::size_t left = degree_; left > 0; --left)
      for (std::size_t i = 0; i < left; ++i) mean[i] = (1.0 - s) * mean[i] + s * mean[i + 1];
    return mean[0];
  }

  constexpr bool is_constant() const {
    for (std::size_t i = 1; i <= degree_; ++i)
      if (coefficients_[i] != coefficients_[0]) return false;
    return true;
  }

  /// Mean over the segment, the integral from s = 0 to 1.
  constexpr double mean() const {
    double sum = 0.0;
    for (std::size_t i = 0; i <= degree_; ++i) sum += coefficients_[i];
    return sum / static_cast<double>(degree_ + 1);
  }

  /// The part from s = begin to s = end, stretched over 0 to 1: the first n - i arguments of its polar form
  /// are begin, the others end [farouki2012].
  constexpr Variation part(double begin, double end) const {
    Variation result;
    result.degree_ = degree_;
    for (std::size_t i = 0; i <= degree_; ++i) {
      std::array<double, most + 1> mean = coefficients_;
      for (std::size_t left = degree_; left > 0; --left) {
        const double s = degree_ - left < degree_ - i ? begin : end;
        for (std::size_t k = 0; k < left; ++k) mean[k] = (1.0 - s) * mean[k] + s * mean[k + 1];
      }
      result.coefficients_[i] = mean[0];
    }
    return result;
  }

  /// @throws std::invalid_argument when the product's degree is above four.
  friend constexpr Variation operator*(const Variation& a, const Variation& b) {
    if (a.degree_ + b.degree_ > most)
      throw std::invalid_argument("a section's properties vary as a polynomial of degree above four");
    Variation product;
    product.degree_ = a.degree_ + b.degree_;
    for (std::size_t i = 0; i <= a.degree_; ++i)
      for (std::size_t j = 0; j <= b.degree_; ++j)
        product.coefficients_[i + j] += choose(a.degree_, i) * choose(b.degree_, j) /
                                        choose(product.degree_, i + j) * a.coefficients_[i] *
                                        b.coefficients_[j];
    return product;
  }
  friend constexpr bool operator==(const Variation&, const Variation&) = default;

 private:
  static constexpr std::size_t most = 4;

  static constexpr double choose(std::size_t n, std::size_t k) {
    double value = 1.0;
    for (std::size_t i = 0; i < k; ++i)
      value = value * static_cast<double>(n - i) / static_cast<double>(i + 1);
    return value;
  }

  std::size_t degree_ = 0;
  std::array<double, most + 1> coefficients_;  // b_0 ... b_n, then zeros
};

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
