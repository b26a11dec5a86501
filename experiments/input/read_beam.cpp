#include "experiments/input/read_beam.hpp"

#include <fmt/format.h>

#include "experiments/input/method_choice.hpp"
#include "experiments/input/spelling.hpp"

namespace beamid::experiments {
namespace {

/// The one key of several that is given. @throws InputError when none or more are.
std::string only_one(const TomlTable& table, const std::string& what, const std::vector<std::string>& keys) {
  std::vector<std::string> given;
  for (const std::string& key : keys)
    if (table.contains(key)) given.push_back(key);
  if (given.size() == 1) return given.front();
  throw InputError(table.place(), fmt::format("{} is given by {}; expected exactly one of {}", what,
                                              given.empty() ? "nothing" : joined(given), joined(keys)));
}

struct Section {
  double width, height;
};

/// @param owner the key whose value means nothing without a section.
Section read_section(const TomlTable& table, const std::string& owner) {
  for (const std::string key : {"width_m", "height_m"})
    if (!table.contains(key)) table.miss(key, "a positive number beside " + owner);
  return {table.number("width_m", Sign::positive), table.number("height_m", Sign::positive)};
}

}  // namespace

fem::Beam read_beam(const TomlTable& table) {
  fem::Cantilever beam;
  beam.length = table.number("length_m", Sign::positive);

  const std::string stiffness =
      only_one(table, "bending stiffness", {"youngs_modulus_pa", "bending_stiffness_n_m2"});
  beam.bending_stiffness = table.number(stiffness, Sign::positive);
  if (stiffness == "youngs_modulus_pa") {
    const Section section = read_section(table, stiffness);
    beam.bending_stiffness *= fem::rectangle_second_moment(section.width, section.height);
  }

  const std::string mass =
      only_one(table, "mass", {"mass_kg", "mass_per_length_kg_per_m", "density_kg_per_m3"});
  beam.mass_per_length = table.number(mass, Sign::positive);
  if (mass == "mass_kg") beam.mass_per_length /= beam.length;
  if (mass == "density_kg_per_m3") {
    const Section section = read_section(table, mass);
    beam.mass_per_length *= section.width * section.height;
  }
  for (const std::string key : {"width_m", "height_m"})
    if (table.contains(key) && stiffness != "youngs_modulus_pa" && mass != "density_kg_per_m3")
      throw InputError(
          table.key_place(key),
          fmt::format(
              "{} has no use beside {} and {}; expected youngs_modulus_pa or density_kg_per_m3, or no "
              "section",
              table.path(key), stiffness, mass));

  beam.tip_mass = table.find_number("tip_mass_kg", Sign::not_negative).value_or(0) +
                  table.find_number("sensor_mass_kg", Sign::not_negative).value_or(0);
  beam.tip_rotary_inertia = table.find_number("tip_rotary_inertia_kg_m2", Sign::not_negative).value_or(0);
  at_place(table.place(), [&] { fem::validate(beam); });
  return beam;
}

}  // namespace beamid::experiments
