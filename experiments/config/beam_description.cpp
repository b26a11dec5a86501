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
  if (section.axial_stiffness) json["axial_stiffness_n"] = variation_json(*section.axial_stiffness);
  return json;
}

double total_mass(const fem::Beam& beam) {
  double sum = beam.mass();
  for (const fem::Body& body : beam.bodies) sum += body.mass;
  for (const fem::Absorber& absorber : beam.absorbers) sum += absorber.mass;
  return sum;
}

}  // namespace beamid::experiments
