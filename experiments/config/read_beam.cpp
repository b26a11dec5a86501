
#include "experiments/config/readers.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/memory_need.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/beam.hpp"
#include "fem/space_frame.hpp"

namespace beamid::experiments {
namespace {

// What sits on a beam: [[beam.bodies]], [[beam.supports]], [[beam.springs]], [[beam.dashpots]],
// [[beam.absorbers]], [[beam.damages]] and [[beam.added_masses]].

const Schema<fem::Body>& body_keys() {
  static const Schema<fem::Body> keys =
      Schema<fem::Body>("beam.bodies")
          .key("position_m", &fem::Body::position, on_beam, "where it is fixed", "0.55")
          .required()
          .key("mass_kg", &fem::Body::mass, not_negative, "its mass", "0.2")
          .key("rotary_inertia_kg_m2", &fem::Body::rotary_inertia, not_negative, "about its own centre",
               "1e-4")
          .key("eccentricity_m", &fem::Body::eccentricity,
               "of its centre, along the axis, positive towards the tip", "0.01")
          .at_least_one({"mass_kg", "rotary_inertia_kg_m2"});
  return keys;
}

/// A support by the name of its kind.
struct NamedSupport {
  double position = 0.0;
  std::string kind;
};

const Schema<NamedSupport>& support_keys() {
  static const Schema<NamedSupport> keys =
      Schema<NamedSupport>("beam.supports")
          .key("position_m", &NamedSupport::position, on_beam, "where", "0.6")
          .required()
          .key("kind", &NamedSupport::kind, "holds deflection and rotation, deflection, or rotation",
               "\"pinned\"")
          .one_of({"clamped", "pinned", "guided"})
          .required();
  return keys;
}

const Schema<fem::Spring>& spring_keys() {
  static const Schema<fem::Spring> keys =
      Schema<fem::Spring>("beam.springs")
          .key("position_m", &fem::Spring::position, on_beam, "where", "1.1")
          .required()
          .key("translational_n_per_m", &fem::Spring::translational, not_negative, "k of a force k w", "500")
          .key("rotational_n_m_per_rad", &fem::Spring::rotational, not_negative, "k of a moment k theta",
               "20")
          .key("cubic_n_per_m3", &fem::Spring::cubic,
               "k3 of a force k3 w^3; simulate only, and not by the modal method", "1e6")
          .at_least_one({"translational_n_per_m", "rotational_n_m_per_rad", "cubic_n_per_m3"});
  return keys;
}

const Schema<fem::Dashpot>& dashpot_keys() {
  static const Schema<fem::Dashpot> keys =
      Schema<fem::Dashpot>("beam.dashpots")
          .key("position_m", &fem::Dashpot::position, on_beam, "where", "1.1")
          .required()
          .key("translational_n_s_per_m", &fem::Dashpot::translational, not_negative, "c of a force c w'",
               "0.5")
          .key("rotational_n_m_s_per_rad", &fem::Dashpot::rotational, not_negative, "c of a moment c theta'",
               "0.01")
          .key("quadratic_n_s2_per_m2", &fem::Dashpot::quadratic, not_negative,
               "c2 of a force c2 w' abs(w'); simulate only, and not by the modal method", "0.1")
          .at_least_one({"translational_n_s_per_m", "rotational_n_m_s_per_rad", "quadratic_n_s2_per_m2"});
  return keys;
}

const Schema<fem::Absorber>& absorber_keys() {
  static const Schema<fem::Absorber> keys =
      Schema<fem::Absorber>("beam.absorbers")
          .key("position_m", &fem::Absorber::position, on_beam, "where it hangs", "1.1")
          .required()
          .key("mass_kg", &fem::Absorber::mass, positive, "its mass", "0.05")
          .required()
          .key("stiffness_n_per_m", &fem::Absorber::stiffness, positive, "of its spring", "20")
          .required()
          .key("damping_n_s_per_m", &fem::Absorber::damping, not_negative, "of its dashpot", "0.1");
  return keys;
}

constexpr Range behind_from{.least = 0.0, .on_beam = true, .greater_than = "from_m"};

const Schema<fem::Damage>& damage_keys() {
  static const Schema<fem::Damage> keys =
      Schema<fem::Damage>("beam.damages")
          .key("from_m", &fem::Damage::from, on_beam, "where it begins", "0.1")
          .required()
          .key("to_m", &fem::Damage::to, behind_from, "where it ends", "0.15")
          .required()
          .key("loss", &fem::Damage::loss, {.least = 0.0, .most = 1.0, .below = true},
               "E I becomes (1 - loss) E I", "0.2")
          .required();
  return keys;
}

const Schema<fem::AddedMass>& added_mass_keys() {
  static const Schema<fem::AddedMass> keys =
      Schema<fem::AddedMass>("beam.added_masses")
          .key("from_m", &fem::AddedMass::from, on_beam, "where it begins", "0.2")
          .required()
          .key("to_m", &fem::AddedMass::to, behind_from, "where it ends", "0.5")
          .required()
          .key("mass_per_length_kg_per_m", &fem::AddedMass::mass_per_length, not_negative, "how much", "0.3")
          .required();
  return keys;
}

const bool attachment_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return body_keys(); }),
    register_keys([]() -> const KeyTable& { return support_keys(); }),
    register_keys([]() -> const KeyTable& { return spring_keys(); }),
    register_keys([]() -> const KeyTable& { return dashpot_keys(); }),
    register_keys([]() -> const KeyTable& { return absorber_keys(); }),
    register_keys([]() -> const KeyTable& { return damage_keys(); }),
    register_keys([]() -> const KeyTable& { return added_mass_keys(); })};

template <class Item>
void read_all(const TomlTable& beam, const char* name, const Schema<Item>& keys, double length,
              std::vector<Item>& items) {
  for (const TomlTable& table : beam.find_tables(name)) items.push_back(keys.read(table, length));
}

/// Adds them to a beam whose segments are known.
/// @throws InputError for a place off the beam, a missing or a bad value, and one that has no effect.
void read_attachments(const TomlTable& table, fem::Beam& beam) {
  const double length = beam.length();
  read_all(table, "bodies", body_keys(), length, beam.bodies);
  std::vector<NamedSupport> supports;
  read_all(table, "supports", support_keys(), length, supports);
  for (const auto& [position, kind] : supports)
    beam.supports.push_back({position, kind != "guided", kind != "pinned"});
  read_all(table, "springs", spring_keys(), length, beam.springs);
  read_all(table, "dashpots", dashpot_keys(), length, beam.dashpots);
  read_all(table, "absorbers", absorber_keys(), length, beam.absorbers);
  read_all(table, "damages", damage_keys(), length, beam.damages);
  read_all(table, "added_masses", added_mass_keys(), length, beam.added_masses);
}

const std::vector<std::string> end_kinds{"clamped", "pinned", "guided", "free"};

/// What belongs to the whole beam, however many segments it has.
struct WholeBeam {
  std::string support = "clamped-free";
  std::optional<double> root_rotational, root_translational;
  double tip_mass = 0.0, tip_inertia = 0.0, tip_eccentricity = 0.0, sensor_mass = 0.0, axial_load = 0.0;
  fem::MassModel mass_model = fem::MassModel::consistent;
  int elements = 40;
};

const Schema<WholeBeam>& beam_keys() {
  using B = WholeBeam;
  static const Schema<B> keys =
      Schema<B>("beam")
          .like(segment_keys())
          .key("support", &B::support,
               "how the ends are held: a pair of `clamped`, `pinned`, `guided`, `free`", "\"clamped-pinned\"")
          .one_of(end_supports())
          .values("text, ROOT-TIP")
          .key("root_rotational_stiffness_n_m_per_rad", &B::root_rotational, not_negative,
               "elastic root: a spring in place of the held rotation", "2e4")
          .key("root_translational_stiffness_n_per_m", &B::root_translational, not_negative,
               "elastic root: a spring in place of the held deflection", "1e7")
          .key("tip_mass_kg", &B::tip_mass, not_negative, "rigid mass at the tip", "0.3605")
          .key("tip_rotary_inertia_kg_m2", &B::tip_inertia, not_negative,
               "of the tip mass about its own centre", "1e-4")
          .key("tip_eccentricity_m", &B::tip_eccentricity, "of that centre beyond the tip, along the axis",
               "0.02")
          .key("sensor_mass_kg", &B::sensor_mass, not_negative,
               "accelerometer riding on the tip, beside the tip mass", "0.054")
          .key("axial_load_n", &B::axial_load,
               "dead load, the same all along, positive in compression; below the load that buckles the beam",
               "100")
          .choice("mass_model", &B::mass_model,
                  {std::pair{"consistent", fem::MassModel::consistent}, {"lumped", fem::MassModel::lumped}},
                  "of the elements; frequencies err by h^4 or by h^2", "\"lumped\"")
          .key("elements", &B::elements, {1, most_elements}, "finite elements along the beam", "80")
          .tables({"segments", "bodies", "supports", "springs", "dashpots", "absorbers", "damages",
                   "added_masses"});
  return keys;
}

const bool beam_keys_registered = register_keys([]() -> const KeyTable& { return beam_keys(); });

void read_segments(const TomlTable& table, fem::Beam& beam) {
  const std::vector<TomlTable> segments = table.find_tables("segments");
  if (segments.empty()) {
    beam.segments = {read_segment(table)};
    return;
  }
  refuse_useless(table, segment_keys().names(), "beside beam.segments", "it in each of beam.segments");
  for (const TomlTable& segment : segments) beam.segments.push_back(read_segment(segment));
}

// An elastic root: a spring where the support would hold.
void add_root(const WholeBeam& given, fem::Beam& beam) {
  for (fem::Support& support : beam.supports) {
    if (support.position != 0.0) continue;
    support.rotation &= !given.root_rotational;
    support.deflection &= !given.root_translational;
  }
  std::erase_if(beam.supports, [](const fem::Support& one) { return !one.deflection && !one.rotation; });
  if (given.root_rotational || given.root_translational)
    beam.springs.push_back(
        {0.0, given.root_translational.value_or(0.0), given.root_rotational.value_or(0.0), 0.0});
}

void add_tip(const WholeBeam& given, fem::Beam& beam) {
  // The tip's body comes first, also without mass, so that the sensor is not taken for it.
  if (given.tip_mass > 0.0 || given.tip_inertia > 0.0 || given.sensor_mass > 0.0)
    beam.bodies.push_back({beam.length(), given.tip_mass, given.tip_inertia, given.tip_eccentricity});
  if (given.sensor_mass > 0.0) beam.bodies.push_back({beam.length(), given.sensor_mass, 0.0, 0.0});
}

// Closer to the buckling load than this, relative, a frequency has no digits.
constexpr double nearest_to_buckling = 1e-7;

void refuse_buckled(const TomlTable& table, const fem::Beam& beam) {
  if (!(beam.axial_load > 0.0)) return;
  const auto most = fem::buckling_load(beam);
  if (most && beam.axial_load > (1.0 - nearest_to_buckling) * *most)
    throw InputError(
        table.value_place("axial_load_n"),
        fmt::format("axial_load_n is {:.10g}; the beam buckles at {:.6g} N of compression, expected "
                    "less than that",
                    beam.axial_load, *most));
}

}  // namespace

const std::vector<std::string>& end_supports() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const std::string& root : end_kinds)
      for (const std::string& tip : end_kinds) all.push_back(root + "-" + tip);
    return all;
  }();
  return names;
}

std::vector<fem::Support> supports_of(const std::string& name, double length) {
  std::vector<fem::Support> supports;
  const auto hold = [&](const std::string& kind, double position) {
    const bool deflection = kind == "clamped" || kind == "pinned",
               rotation = kind == "clamped" || kind == "guided";
    if (deflection || rotation) supports.push_back({position, deflection, rotation});
  };
  const std::size_t dash = name.find('-');
  hold(name.substr(0, dash), 0.0);
  hold(name.substr(dash + 1), length);
  return supports;
}

fem::Beam read_beam(const TomlTable& table) {
  fem::Beam beam;
  read_segments(table, beam);
  const WholeBeam given = beam_keys().read(table);
  beam.supports = supports_of(given.support, beam.length());
  add_root(given, beam);
  add_tip(given, beam);
  beam.axial_load = given.axial_load;
  beam.mass_model = given.mass_model;
  read_attachments(table, beam);
  at_place(table.place(), [&] { fem::validate(beam); });
  refuse_buckled(table, beam);
  return beam;
}

int read_elements(const TomlTable& table) {
  const int elements = beam_keys().read(table).elements;
  at_place(table.value_place("elements"), [&] { require_mesh_memory(elements); });
  return elements;
}

void require_mesh_memory(double elements, double modes) {
  constexpr double mesh = 2000, mode = 64;  // [bytes of an element], measured
  require_memory(elements, modes > 0 ? fmt::format("elements with {:g} modes", modes) : "elements",
                 mesh + mode * modes);
}

}  // namespace beamid::experiments
