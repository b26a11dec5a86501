#include "experiments/config/read_attachments.hpp"

#include "experiments/config/key_tables.hpp"

namespace beamid::experiments {
namespace {

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

}  // namespace

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

}  // namespace beamid::experiments
