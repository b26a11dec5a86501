#include "experiments/config/read_segment.hpp"

#include <fmt/format.h>

#include <optional>

#include "experiments/config/section_dimensions.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

using fem::Variation;

constexpr const char* youngs = "youngs_modulus_pa";
constexpr const char* density = "density_kg_per_m3";

class SegmentReader {
 public:
  /// @param length absent: the table's own.
  explicit SegmentReader(const TomlTable& table, std::optional<double> length = {})
      : table_(table), dimensions_(table), length_(length) {
    check_types();
  }

  fem::Segment read() {
    segment_.length = length_ ? *length_ : table_.number("length_m", Sign::positive);
    read_stiffness();
    read_mass();
    if (timoshenko_)
      read_shear();
    else
      refuse_useless(table_, {"poissons_ratio", "shear_modulus_pa", "shear_factor", "shear_stiffness_n"},
                     "with theory \"euler_bernoulli\"", "theory = \"timoshenko\"");
    read_rotary_inertia();
    refuse_useless_dimensions();
    if (dimensions_.known()) segment_.section.outline = dimensions_.outline();
    return segment_;
  }

 private:
  const TomlTable& table_;
  SectionDimensions dimensions_;
  std::optional<double> length_;
  fem::Segment segment_;
  std::string stiffness_, mass_;
  bool timoshenko_ = false, dimensions_used_ = false;
  std::optional<double> youngs_modulus_;

  // All of them first: a text where a number is due is the better message than "mass is given by nothing".
  void check_types() {
    for (const std::string& key : segment_keys()) {
      if (key == "theory")
        timoshenko_ = table_.find_text(key, {"euler_bernoulli", "timoshenko"}).value_or("") == "timoshenko";
      else if (key == "rotary_inertia")
        table_.find_truth(key);
      else if (key == "poissons_ratio") {
        if (const auto ratio = table_.find_number(key); ratio && (*ratio <= -1.0 || *ratio > 0.5))
          table_.refuse(key, "a number above -1, at most 0.5");
      } else {
        const bool may_vanish = key.starts_with("end_") || key == "rotary_inertia_kg_m";
        table_.find_number(key, may_vanish ? Sign::not_negative : Sign::positive);
      }
    }
  }

  /// The one key of several that is given. @throws InputError when none or more are.
  std::string only_one(const std::string& what, const std::vector<std::string>& keys) const {
    const std::vector<std::string> given = given_keys(table_, keys);
    if (given.size() == 1) return given.front();
    throw InputError(table_.place(), fmt::format("{} is given by {}; expected exactly one of {}", what,
                                                 given.empty() ? "nothing" : joined(given), joined(keys)));
  }

  /// @param owner the key that means nothing without dimensions.
  const SectionDimensions& dimensions_for(const std::string& owner) {
    dimensions_.require(owner);
    dimensions_used_ = true;
    return dimensions_;
  }

  void read_stiffness() {
    stiffness_ = only_one("bending stiffness", {youngs, "bending_stiffness_n_m2"});
    fem::Section& section = segment_.section;
    if (stiffness_ != youngs) {
      section.bending_stiffness = table_.number(stiffness_, Sign::positive);
      refuse_useless(table_, {"end_width_m", "end_height_m", "end_diameter_m"}, "beside " + stiffness_,
                     youngs);
      return;
    }
    youngs_modulus_ = table_.number(youngs, Sign::positive);
    const SectionDimensions& dimensions = dimensions_for(youngs);
    section.bending_stiffness = Variation(*youngs_modulus_) * dimensions.second_moment();
    section.axial_stiffness = Variation(*youngs_modulus_) * dimensions.area();
  }

  void read_mass() {
    mass_ = only_one("mass", {"mass_kg", "mass_per_length_kg_per_m", density});
    const double value = table_.number(mass_, Sign::positive);
    Variation& mass = segment_.section.mass_per_length;
    if (mass_ == density)
      mass = Variation(value) * dimensions_for(density).area();
    else if (mass_ == "mass_kg" && dimensions_.tapered())
      mass = Variation(value / segment_.length / dimensions_.area().mean()) * dimensions_.area();
    else
      mass = mass_ == "mass_kg" ? value / segment_.length : value;
  }

  void read_shear() {
    if (const auto given = table_.find_number("shear_stiffness_n", Sign::positive)) {
      segment_.section.shear_stiffness = *given;
      refuse_useless(table_, {"poissons_ratio", "shear_modulus_pa", "shear_factor"},
                     "beside shear_stiffness_n", "one or the other");
      return;
    }
    std::optional<double> modulus = table_.find_number("shear_modulus_pa", Sign::positive);
    std::optional<double> ratio = table_.find_number("poissons_ratio");
    if (!modulus && ratio && youngs_modulus_) modulus = *youngs_modulus_ / (2.0 * (1.0 + *ratio));
    if (!modulus)
      table_.miss(youngs_modulus_ ? "poissons_ratio" : "shear_modulus_pa",
                  "a number beside theory = \"timoshenko\", or shear_stiffness_n");
    if (!ratio && youngs_modulus_) ratio = *youngs_modulus_ / (2.0 * *modulus) - 1.0;
    std::optional<double> factor = table_.find_number("shear_factor", Sign::positive);
    const SectionDimensions& dimensions = dimensions_for("shear_modulus_pa or poissons_ratio");
    if (!factor && !ratio)
      table_.miss("shear_factor", "a positive number, or poissons_ratio, from which it follows");
    if (!factor) factor = dimensions.shear_factor(*ratio);
    segment_.section.shear_stiffness = Variation(*factor * *modulus) * dimensions.area();
  }

  void read_rotary_inertia() {
    fem::Section& section = segment_.section;
    const auto value = table_.find_number("rotary_inertia_kg_m", Sign::not_negative);
    if (value) {
      section.rotary_inertia = *value;
      refuse_useless(table_, {"rotary_inertia"}, "beside rotary_inertia_kg_m", "one or the other");
    } else if (table_.find_truth("rotary_inertia").value_or(timoshenko_)) {
      if (!dimensions_.known() && !table_.contains("rotary_inertia"))
        table_.miss("rotary_inertia_kg_m",
                    "a number beside theory = \"timoshenko\" without dimensions, or rotary_inertia = false");
      // rho I with rho A given, or the same rho throughout
      const SectionDimensions& dimensions = dimensions_for("rotary_inertia");
      const bool follows_area = mass_ == density || (mass_ == "mass_kg" && dimensions.tapered());
      section.rotary_inertia = follows_area
                                   ? Variation(section.mass_per_length.mean() / dimensions.area().mean()) *
                                         dimensions.second_moment()
                                   : section.mass_per_length * dimensions.square_of_gyration();
    }
  }

  void refuse_useless_dimensions() const {
    if (dimensions_used_) return;
    for (const std::string key : {"width_m", "height_m", "diameter_m"})
      if (table_.contains(key))
        throw InputError(
            table_.key_place(key),
            fmt::format(
                "{} has no use beside {} and {}; expected youngs_modulus_pa or density_kg_per_m3, or no "
                "section",
                table_.path(key), stiffness_, mass_));
  }
};

}  // namespace

const std::vector<std::string>& segment_keys() {
  static const std::vector<std::string> keys{"length_m",
                                             "width_m",
                                             "height_m",
                                             "diameter_m",
                                             "end_width_m",
                                             "end_height_m",
                                             "end_diameter_m",
                                             "youngs_modulus_pa",
                                             "bending_stiffness_n_m2",
                                             "mass_kg",
                                             "mass_per_length_kg_per_m",
                                             "density_kg_per_m3",
                                             "theory",
                                             "poissons_ratio",
                                             "shear_modulus_pa",
                                             "shear_factor",
                                             "shear_stiffness_n",
                                             "rotary_inertia",
                                             "rotary_inertia_kg_m"};
  return keys;
}

fem::Segment read_segment(const TomlTable& table) {
  return SegmentReader(table).read();
}

fem::Section read_section(const TomlTable& table, double length) {
  return SegmentReader(table, length).read().section;
}

}  // namespace beamid::experiments
