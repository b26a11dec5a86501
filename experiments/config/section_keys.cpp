#include "experiments/config/section_keys.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/useless_keys.hpp"
#include "fem/section.hpp"
#include "fem/space_frame.hpp"

namespace beamid::experiments {

const Schema<GivenSection>& section_keys() {
  using S = GivenSection;
  static const Schema<S> keys =
      Schema<S>("a section")
          .key("width_m", &S::width, positive, "rectangle: across the direction of bending", "0.060")
          .replaces({"diameter_m", "end_diameter_m"})
          .key("height_m", &S::height, positive, "rectangle: along the direction of bending", "0.006")
          .replaces({"diameter_m", "end_diameter_m"})
          .key("diameter_m", &S::diameter, positive, "circle, instead of width and height", "0.02")
          .excludes({"width_m", "height_m"}, "a rectangle or a circle")
          .replaces({"end_width_m", "end_height_m"})
          .key("end_width_m", &S::end_width, not_negative, "width at the segment's end; linear in between",
               "0.030")
          .fallback("the same")
          .key("end_height_m", &S::end_height, not_negative, "height there; 0 is a sharp tip", "0.003")
          .fallback("the same")
          .key("end_diameter_m", &S::end_diameter, not_negative, "diameter there", "0.01")
          .fallback("the same")
          .key("youngs_modulus_pa", &S::youngs_modulus, positive, "Young's modulus", "2.12e11")
          .fallback("either this, with the section,")
          .key("bending_stiffness_n_m2", &S::bending_stiffness, positive, "E I", "228.96")
          .fallback("or this")
          .excludes({"end_width_m", "end_height_m", "end_diameter_m"}, "youngs_modulus_pa")
          .key("mass_kg", &S::mass, positive, "mass of the segment alone, spread as its area", "3.055")
          .fallback("either this,")
          .key("mass_per_length_kg_per_m", &S::mass_per_length, positive, "rho A, the same all along",
               "2.777")
          .fallback("or this,")
          .key("density_kg_per_m3", &S::density, positive, "rho", "7850")
          .fallback("or this, with the section")
          .choice<bool S::*, bool>("theory", &S::timoshenko,
                                   {{"euler_bernoulli", false}, {"timoshenko", true}},
                                   "without or with shear deformation", "\"timoshenko\"")
          .key("poissons_ratio", &S::poissons_ratio, {.least = -1.0, .most = 0.5, .above = true},
               "gives the shear modulus, E / (2 (1 + nu)), and the shear factor", "0.3")
          .key("shear_modulus_pa", &S::shear_modulus, positive, "G", "8e10")
          .fallback("from Poisson's ratio")
          .key("shear_factor", &S::shear_factor, positive, "kappa of kappa G A", "0.8667")
          .fallback("Cowper's [cowper1966]")
          .key("shear_stiffness_n", &S::shear_stiffness, positive, "kappa G A itself", "2.5e7")
          .fallback("from those")
          .excludes({"poissons_ratio", "shear_modulus_pa", "shear_factor"})
          .key("rotary_inertia", &S::with_rotary_inertia,
               "of the section: rho I from its mass and dimensions", "true")
          .fallback("true for Timoshenko, else false")
          .key("rotary_inertia_kg_m", &S::rotary_inertia, not_negative, "rho I itself", "8.3e-6")
          .fallback("from those")
          .excludes({"rotary_inertia"})
          .exactly_one("bending stiffness", {"youngs_modulus_pa", "bending_stiffness_n_m2"})
          .exactly_one("mass", {"mass_kg", "mass_per_length_kg_per_m", "density_kg_per_m3"});
  return keys;
}

namespace {

/// What a file says of a section, in SI units; zero or absent: not said.
struct GivenSpaceSection {
  std::string name, shape = "rectangle";
  double width = 0.0, height = 0.0, diameter = 0.0, wall = 0.0, web = 0.0, flange = 0.0;
  double area = 0.0, second_moment_y = 0.0, second_moment_z = 0.0, torsion_constant = 0.0;
  std::optional<double> shear_area_y, shear_area_z;
  double youngs_modulus = 0.0;
  std::optional<double> poissons_ratio, shear_modulus, density, mass_per_length;
  bool timoshenko = false;
  std::optional<bool> rotary_inertia;
};

const Schema<GivenSpaceSection>& space_section_keys() {
  using S = GivenSpaceSection;
  static const Schema<S> keys =
      Schema<S>("space_frame.sections")
          .selected_by("shape")
          .key("name", &S::name, "by which members name it", "\"column\"")
          .required()
          .key("shape", &S::shape, "its outline, or `constants` where its areas and moments are given",
               "\"rectangle\"")
          .one_of({"rectangle", "circle", "tube", "i", "constants"})
          .required()
          .key("width_m", &S::width, positive, "along the section's y", "0.1")
          .needed_with({"rectangle", "i"})
          .key("height_m", &S::height, positive, "along the section's z", "0.2")
          .needed_with({"rectangle", "i"})
          .key("diameter_m", &S::diameter, positive, "outer diameter", "0.1683")
          .needed_with({"circle", "tube"})
          .key("wall_m", &S::wall, positive, "thickness of the tube's wall", "0.008")
          .needed_with({"tube"})
          .key("web_m", &S::web, positive, "thickness of the web, which stands along z", "0.0056")
          .needed_with({"i"})
          .key("flange_m", &S::flange, positive, "thickness of the flanges", "0.0085")
          .needed_with({"i"})
          .key("area_m2", &S::area, positive, "A", "0.00285")
          .needed_with({"constants"})
          .key("second_moment_y_m4", &S::second_moment_y, positive, "I_y, which resists a deflection along z",
               "1.943e-5")
          .needed_with({"constants"})
          .key("second_moment_z_m4", &S::second_moment_z, positive, "I_z, which resists a deflection along y",
               "1.424e-6")
          .needed_with({"constants"})
          .key("torsion_constant_m4", &S::torsion_constant, positive, "J of Saint-Venant", "6.98e-8")
          .needed_with({"constants"})
          .key("shear_area_y_m2", &S::shear_area_y, positive, "kappa A of a shear force along y", "0.0017")
          .fallback("the shape's")
          .key("shear_area_z_m2", &S::shear_area_z, positive, "kappa A of a shear force along z", "0.0014")
          .fallback("the shape's")
          .key("youngs_modulus_pa", &S::youngs_modulus, positive, "E", "2.1e11")
          .required()
          .key("poissons_ratio", &S::poissons_ratio, {.least = -1.0, .most = 0.5, .above = true},
               "gives the shear modulus, E / (2 (1 + nu))", "0.3")
          .fallback("either this")
          .key("shear_modulus_pa", &S::shear_modulus, positive, "G", "8.1e10")
          .fallback("or this")
          .key("density_kg_per_m3", &S::density, positive, "rho", "7850")
          .fallback("either this")
          .key("mass_per_length_kg_per_m", &S::mass_per_length, positive, "rho A", "22.4")
          .fallback("or this")
          .choice<bool S::*, bool>("theory", &S::timoshenko,
                                   {{"euler_bernoulli", false}, {"timoshenko", true}},
                                   "without or with shear deformation", "\"timoshenko\"")
          .key("rotary_inertia", &S::rotary_inertia,
               "of bending: rho I_y and rho I_z; torsion always has its own", "true")
          .fallback("true for Timoshenko, else false")
          .exactly_one("shear modulus", {"poissons_ratio", "shear_modulus_pa"})
          .exactly_one("mass", {"density_kg_per_m3", "mass_per_length_kg_per_m"});
  return keys;
}

const bool space_section_keys_registered =
    register_keys([]() -> const KeyTable& { return space_section_keys(); });

void require_thin(const TomlTable& table, const char* key, double thickness, double most, const char* of) {
  if (!(thickness < most)) table.refuse(key, fmt::format("a number below {:g}, {}", most, of));
}

fem::SectionShape shape_of(const TomlTable& table, const GivenSpaceSection& given, double ratio) {
  if (given.shape == "rectangle") return fem::rectangle_shape(given.width, given.height, ratio);
  if (given.shape == "circle") return fem::tube_shape(given.diameter, 0.5 * given.diameter, ratio);
  if (given.shape == "tube") {
    require_thin(table, "wall_m", given.wall, 0.5 * given.diameter, "half the diameter");
    return fem::tube_shape(given.diameter, given.wall, ratio);
  }
  if (given.shape == "i") {
    require_thin(table, "web_m", given.web, given.width, "the width");
    require_thin(table, "flange_m", given.flange, 0.5 * given.height, "half the height");
    return fem::i_shape(given.width, given.height, given.web, given.flange);
  }
  return {given.area, given.second_moment_y, given.second_moment_z, given.torsion_constant, 0.0, 0.0, {}};
}

fem::SpaceSection read_space_section(const TomlTable& table, const GivenSpaceSection& given) {
  const double young = given.youngs_modulus,
               shear =
                   given.shear_modulus ? *given.shear_modulus : young / (2.0 * (1.0 + *given.poissons_ratio)),
               ratio = given.poissons_ratio.value_or(young / (2.0 * shear) - 1.0);
  const fem::SectionShape shape = shape_of(table, given, ratio);
  fem::SpaceSection section;
  section.axial_stiffness = young * shape.area;
  section.bending_stiffness_y = young * shape.second_moment_y;
  section.bending_stiffness_z = young * shape.second_moment_z;
  section.torsional_stiffness = shear * shape.torsion_constant;
  section.mass_per_length = given.density ? *given.density * shape.area : *given.mass_per_length;
  const double density = section.mass_per_length / shape.area;
  section.torsional_inertia = density * (shape.second_moment_y + shape.second_moment_z);
  if (given.rotary_inertia.value_or(given.timoshenko)) {
    section.rotary_inertia_y = density * shape.second_moment_y;
    section.rotary_inertia_z = density * shape.second_moment_z;
  }
  section.outline = shape.outline;
  if (!given.timoshenko) {
    refuse_useless(table, {"shear_area_y_m2", "shear_area_z_m2"}, "with theory \"euler_bernoulli\"",
                   "theory = \"timoshenko\"");
    return section;
  }
  for (const auto& [key, own, of_shape, stiffness] :
       {std::tuple{"shear_area_y_m2", given.shear_area_y, shape.shear_area_y, &section.shear_stiffness_y},
        {"shear_area_z_m2", given.shear_area_z, shape.shear_area_z, &section.shear_stiffness_z}}) {
    if (!own && of_shape == 0.0)
      table.miss(key, "a positive number beside shape = \"constants\" and theory = \"timoshenko\"");
    *stiffness = shear * own.value_or(of_shape);
  }
  return section;
}

}  // namespace

std::map<std::string, fem::SpaceSection> read_space_sections(const TomlTable& table) {
  std::map<std::string, fem::SpaceSection> sections;
  const std::vector<TomlTable> tables = table.find_tables("sections");
  if (tables.empty()) table.miss("sections", "an array of at least one table");
  for (const TomlTable& one : tables) {
    const GivenSpaceSection given = space_section_keys().read(one);
    if (!sections.emplace(given.name, read_space_section(one, given)).second)
      one.refuse("name", "a name that no other section has");
  }
  return sections;
}

int read_joint(const TomlTable& table, const std::string& key, std::size_t joints) {
  const auto count = static_cast<int>(joints);
  const auto number = table.find_whole_number(key, 1, count);
  if (!number) table.miss(key, fmt::format("the number of a joint, from 1 to {}", count));
  return *number - 1;
}

std::vector<TomlTable> some_tables(const TomlTable& table, const std::string& key) {
  std::vector<TomlTable> tables = table.find_tables(key);
  if (tables.empty()) table.miss(key, "an array of at least one table");
  return tables;
}

void check_joints_connected(const TomlTable& table, std::size_t joints,
                            const std::vector<fem::MemberEnds>& members) {
  std::vector<bool> used(joints, false);
  for (const fem::MemberEnds& member : members)
    used[static_cast<std::size_t>(member.first)] = used[static_cast<std::size_t>(member.second)] = true;
  const std::vector<TomlTable> described = table.find_tables("joints");
  for (std::size_t i = 0; i < joints; ++i)
    if (!used[i])
      throw InputError(described[i].place(), described[i].name() + " ends no member; expected one at least");
  const int apart = fem::first_joint_apart(static_cast<int>(joints), members);
  if (apart < 0) return;
  const TomlTable& joint = described[static_cast<std::size_t>(apart)];
  throw InputError(
      joint.place(),
      joint.name() + " is not connected with the first; expected members between all parts of the frame");
}

namespace {

// On a mesh that serves for the buckling of members alone, too.
template <class AnyFrame>
void refuse_buckled_frame(const TomlTable& table, const AnyFrame& frame, std::size_t most_members) {
  const bool pressed = std::any_of(frame.members.begin(), frame.members.end(),
                                   [](const auto& member) { return member.axial_load > 0.0; });
  if (!pressed || frame.members.size() > most_members) return;
  const auto factor = fem::buckling_factor(frame);
  if (factor && *factor <= 1.0)
    throw InputError(
        table.place(),
        fmt::format("the frame buckles at {:.6g} times the axial_load_n of its members; expected "
                    "loads that it bears",
                    *factor));
}

}  // namespace

const Schema<GivenMember>& common_member_keys() {
  using M = GivenMember;
  static const Schema<M> keys =
      Schema<M>("members")
          .key("stiffness_factor", &M::stiffness_factor, positive,
               "of E I, E A, kappa G A and in space G J: `0.8` for a member that has lost a fifth", "0.8")
          .key("group", &M::group,
               "members of one group share a factor that `[[parameters]]` can request, `quantity = "
               "\"factor\"` with the group as `name`",
               "\"columns\"")
          .fallback("none")
          .key("axial_load_n", &M::axial_load,
               "P, positive in compression: what the member carries at rest, which softens it", "5e4");
  return keys;
}

void check_elements_per_member(const TomlTable& table, std::size_t members) {
  table.find_whole_number("elements_per_member", 1, std::max(1, most_elements / static_cast<int>(members)));
}

void refuse_buckled(const TomlTable& table, const fem::Frame& frame) {
  refuse_buckled_frame(table, frame, 150);
}

void refuse_buckled(const TomlTable& table, const fem::SpaceFrame& frame) {
  refuse_buckled_frame(table, frame, 75);  // of twice the coordinates
}

}  // namespace beamid::experiments
