#include "experiments/config/beam_description.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json variation_json(const fem::Variation& quantity) {
  if (quantity.is_constant()) return quantity(0.0);
  Json values = Json::array();
  for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) values.push_back(quantity(s));
  return values;
}

}  // namespace

Json describe(const fem::Segment& segment) {
  const fem::Section& section = segment.section;
  Json json{{"length_m", segment.length},
            {"bending_stiffness_n_m2", variation_json(section.bending_stiffness)},
            {"mass_per_length_kg_per_m", variation_json(section.mass_per_length)}};
  if (!section.rotary_inertia.is_constant() || section.rotary_inertia(0.0) != 0.0)
    json["rotary_inertia_kg_m"] = variation_json(section.rotary_inertia);
  if (section.shear_stiffness) json["shear_stiffness_n"] = variation_json(*section.shear_stiffness);
  const bool circle = section.outline.shape == fem::Outline::Shape::ellipse;
  if (circle) json["diameter_m"] = variation_json(section.outline.width);
  if (section.outline.shape == fem::Outline::Shape::rectangle) {
    json["width_m"] = variation_json(section.outline.width);
    json["height_m"] = variation_json(section.outline.height);
  }
  return json;
}

namespace {

Json attachment_json(const fem::Segment& segment) {
  return describe(segment);
}

Json attachment_json(const fem::Body& body) {
  return {{"position_m", body.position},
          {"mass_kg", body.mass},
          {"rotary_inertia_kg_m2", body.rotary_inertia},
          {"eccentricity_m", body.eccentricity}};
}

Json attachment_json(const fem::Support& support) {
  const char* const kind = !support.rotation ? "pinned" : support.deflection ? "clamped" : "guided";
  return {{"position_m", support.position}, {"kind", kind}};
}

Json attachment_json(const fem::Spring& spring) {
  return {{"position_m", spring.position},
          {"translational_n_per_m", spring.translational},
          {"rotational_n_m_per_rad", spring.rotational},
          {"cubic_n_per_m3", spring.cubic}};
}

Json attachment_json(const fem::Dashpot& dashpot) {
  return {{"position_m", dashpot.position},
          {"translational_n_s_per_m", dashpot.translational},
          {"rotational_n_m_s_per_rad", dashpot.rotational},
          {"quadratic_n_s2_per_m2", dashpot.quadratic}};
}

Json attachment_json(const fem::Absorber& absorber) {
  return {{"position_m", absorber.position},
          {"mass_kg", absorber.mass},
          {"stiffness_n_per_m", absorber.stiffness},
          {"damping_n_s_per_m", absorber.damping}};
}

Json attachment_json(const fem::Damage& damage) {
  return {{"from_m", damage.from}, {"to_m", damage.to}, {"loss", damage.loss}};
}

Json attachment_json(const fem::AddedMass& added) {
  return {{"from_m", added.from}, {"to_m", added.to}, {"mass_per_length_kg_per_m", added.mass_per_length}};
}

template <class Items>
void add(Json& json, const char* key, const Items& items) {
  for (const auto& item : items) json[key].push_back(attachment_json(item));
}

}  // namespace

Json describe(const fem::Beam& beam, int elements) {
  Json json{{"length_m", beam.length()},
            {"mass_kg", beam.mass()},
            {"tip_mass_kg", beam.tip_mass()},
            {"elements", elements},
            {"mass_model", beam.mass_model == fem::MassModel::lumped ? "lumped" : "consistent"},
            {"axial_load_n", beam.axial_load}};
  add(json, "segments", beam.segments);
  add(json, "supports", beam.supports);
  add(json, "bodies", beam.bodies);
  add(json, "springs", beam.springs);
  add(json, "dashpots", beam.dashpots);
  add(json, "absorbers", beam.absorbers);
  add(json, "damages", beam.damages);
  add(json, "added_masses", beam.added_masses);
  return json;
}

double total_mass(const fem::Beam& beam) {
  double sum = beam.mass();
  for (const fem::Body& body : beam.bodies) sum += body.mass;
  for (const fem::Absorber& absorber : beam.absorbers) sum += absorber.mass;
  return sum;
}

}  // namespace beamid::experiments
