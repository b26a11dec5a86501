// The dimensions of a rectangular or circular section, and what follows from them.
#pragma once

#include "experiments/config/section_keys.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/section.hpp"

namespace beamid::experiments {

/// width_m and height_m, or diameter_m, and where they go linearly by the segment's end, end_width_m, ...
class SectionDimensions {
 public:
  /// @throws InputError at an end without its beginning.
  SectionDimensions(const TomlTable& table, const GivenSection& given);

  bool known() const { return outline_.shape != fem::Outline::Shape::none; }
  bool tapered() const { return !outline_.width.is_constant() || !outline_.height.is_constant(); }

  /// @throws InputError when dimensions are missing; `owner` is the key that needs them.
  void require(const std::string& owner) const;

  fem::Variation area() const;                ///< A [m2]
  fem::Variation second_moment() const;       ///< I [m4]
  fem::Variation square_of_gyration() const;  ///< I / A [m2]

  /// Cowper's, for a Poisson's ratio [cowper1966].
  double shear_factor(double poissons_ratio) const;

  const fem::Outline& outline() const { return outline_; }

 private:
  TomlTable table_;
  fem::Outline outline_;

  bool circular() const { return outline_.shape == fem::Outline::Shape::ellipse; }
};

}  // namespace beamid::experiments
