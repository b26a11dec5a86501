
#include "experiments/config/readers.hpp"

#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/section_keys.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/section.hpp"

namespace beamid::experiments {
namespace {

// The dimensions of a rectangular or circular section, and what follows from them.

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

using fem::Variation;

const Schema<fem::Segment>& segment_schema() {
  static const Schema<fem::Segment> keys =
      Schema<fem::Segment>("beam.segments")
          .key("length_m", &fem::Segment::length, positive, "of this segment", "0.4")
          .required()
          .like(section_keys());
  return keys;
}

const bool segment_keys_registered = register_keys([]() -> const KeyTable& { return segment_schema(); });

/// What a section is made of, worked out from the values given.
class SectionReader {
 public:
  SectionReader(const TomlTable& table, double length)
      : table_(table), given_(section_keys().read(table)), dimensions_(table, given_), length_(length) {}

  fem::Section read() {
    read_stiffness();
    read_mass();
    if (given_.timoshenko)
      read_shear();
    else
      refuse_useless(table_, {"poissons_ratio", "shear_modulus_pa", "shear_factor", "shear_stiffness_n"},
                     "with theory \"euler_bernoulli\"", "theory = \"timoshenko\"");
    read_rotary_inertia();
    refuse_useless_dimensions();
    if (dimensions_.known()) section_.outline = dimensions_.outline();
    return section_;
  }

 private:
  const TomlTable& table_;
  const GivenSection given_;
  const SectionDimensions dimensions_;
  const double length_;
  fem::Section section_;
  bool dimensions_used_ = false;

  /// @param owner the key that means nothing without dimensions.
  const SectionDimensions& dimensions_for(const std::string& owner) {
    dimensions_.require(owner);
    dimensions_used_ = true;
    return dimensions_;
  }

  void read_stiffness() {
    if (given_.bending_stiffness) {
      section_.bending_stiffness = *given_.bending_stiffness;
      return;
    }
    const SectionDimensions& dimensions = dimensions_for("youngs_modulus_pa");
    section_.bending_stiffness = Variation(*given_.youngs_modulus) * dimensions.second_moment();
    section_.axial_stiffness = Variation(*given_.youngs_modulus) * dimensions.area();
  }

  void read_mass() {
    if (given_.density)
      section_.mass_per_length = Variation(*given_.density) * dimensions_for("density_kg_per_m3").area();
    else if (given_.mass && dimensions_.tapered())
      section_.mass_per_length =
          Variation(*given_.mass / length_ / dimensions_.area().mean()) * dimensions_.area();
    else
      section_.mass_per_length = given_.mass ? *given_.mass / length_ : *given_.mass_per_length;
  }

  void read_shear() {
    if (given_.shear_stiffness) {
      section_.shear_stiffness = *given_.shear_stiffness;
      return;
    }
    const std::optional<double>& youngs_modulus = given_.youngs_modulus;
    std::optional<double> modulus = given_.shear_modulus, ratio = given_.poissons_ratio;
    if (!modulus && ratio && youngs_modulus) modulus = *youngs_modulus / (2.0 * (1.0 + *ratio));
    if (!modulus)
      table_.miss(youngs_modulus ? "poissons_ratio" : "shear_modulus_pa",
                  "a number beside theory = \"timoshenko\", or shear_stiffness_n");
    if (!ratio && youngs_modulus) ratio = *youngs_modulus / (2.0 * *modulus) - 1.0;
    const SectionDimensions& dimensions = dimensions_for("shear_modulus_pa or poissons_ratio");
    if (!given_.shear_factor && !ratio)
      table_.miss("shear_factor", "a positive number, or poissons_ratio, from which it follows");
    const double factor = given_.shear_factor ? *given_.shear_factor : dimensions.shear_factor(*ratio);
    section_.shear_stiffness = Variation(factor * *modulus) * dimensions.area();
  }

  void read_rotary_inertia() {
    if (given_.rotary_inertia) {
      section_.rotary_inertia = *given_.rotary_inertia;
    } else if (given_.with_rotary_inertia.value_or(given_.timoshenko)) {
      if (!dimensions_.known() && !given_.with_rotary_inertia)
        table_.miss("rotary_inertia_kg_m",
                    "a number beside theory = \"timoshenko\" without dimensions, or rotary_inertia = false");
      // rho I with rho A given, or the same rho throughout
      const SectionDimensions& dimensions = dimensions_for("rotary_inertia");
      const bool follows_area = given_.density || (given_.mass && dimensions.tapered());
      section_.rotary_inertia = follows_area
                                    ? Variation(section_.mass_per_length.mean() / dimensions.area().mean()) *
                                          dimensions.second_moment()
                                    : section_.mass_per_length * dimensions.square_of_gyration();
    }
  }

  void refuse_useless_dimensions() const {
    if (dimensions_used_) return;
    for (const std::string& key : given_keys(table_, {"width_m", "height_m", "diameter_m"}))
      throw InputError(
          table_.key_place(key),
          fmt::format("{} has no use beside bending_stiffness_n_m2 and {}; expected youngs_modulus_pa or "
                      "density_kg_per_m3, or no section",
                      table_.path(key), given_.mass ? "mass_kg" : "mass_per_length_kg_per_m"));
  }
};

}  // namespace

const KeyTable& segment_keys() {
  return segment_schema();
}

fem::Segment read_segment(const TomlTable& table) {
  fem::Segment segment = segment_schema().read(table);
  segment.section = read_section(table, segment.length);
  return segment;
}

fem::Section read_section(const TomlTable& table, double length) {
  return SectionReader(table, length).read();
}

}  // namespace beamid::experiments
