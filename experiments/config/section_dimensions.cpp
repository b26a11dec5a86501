#include "experiments/config/section_dimensions.hpp"

#include <numbers>

namespace beamid::experiments {

using fem::Variation;
using std::numbers::pi;

SectionDimensions::SectionDimensions(const TomlTable& table, const GivenSection& given) : table_(table) {
  const auto dimension = [&](const std::string& name, const std::optional<double>& start,
                             const std::optional<double>& end) -> std::optional<Variation> {
    if (end && !start) table.miss(name + "_m", "a positive number beside end_" + name + "_m");
    if (!start) return std::nullopt;
    return end ? Variation::linear(*start, *end) : Variation(*start);
  };
  const auto width = dimension("width", given.width, given.end_width),
             height = dimension("height", given.height, given.end_height),
             diameter = dimension("diameter", given.diameter, given.end_diameter);
  if (diameter)
    outline_ = {fem::Outline::Shape::ellipse, *diameter, *diameter};
  else if (width && height)
    outline_ = {fem::Outline::Shape::rectangle, *width, *height};
}

void SectionDimensions::require(const std::string& owner) const {
  if (known()) return;
  for (const std::string key : {"width_m", "height_m"})
    if (!table_.contains(key)) {
      const bool neither = !table_.contains("width_m") && !table_.contains("height_m");
      table_.miss(key, "a positive number beside " + owner + (neither ? ", or diameter_m" : ""));
    }
}

Variation SectionDimensions::area() const {
  return Variation(circular() ? pi / 4.0 : 1.0) * outline_.width * outline_.height;
}

Variation SectionDimensions::second_moment() const {
  const Variation& height = outline_.height;
  return outline_.width * height * height * height * Variation(circular() ? pi / 64.0 : 1.0 / 12.0);
}

Variation SectionDimensions::square_of_gyration() const {
  return outline_.height * outline_.height * Variation(circular() ? 1.0 / 16.0 : 1.0 / 12.0);
}

double SectionDimensions::shear_factor(double poissons_ratio) const {
  return circular() ? fem::circle_shear_factor(poissons_ratio) : fem::rectangle_shear_factor(poissons_ratio);
}

}  // namespace beamid::experiments
