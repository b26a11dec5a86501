#include "experiments/config/beam_description.hpp"

#include "experiments/config/read_attachments.hpp"
#include "fem/shear_building.hpp"

namespace beamid::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json variation_json(const fem::Variation& quantity) {
  if (quantity.is_constant()) return quantity(0.0);
  Json values = Json::array();
  for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) values.push_back(quantity(s));
  return values;
}

Json describe_chain(const fem::Beam& beam) {
  Json json;
  for (std::size_t i = 0; i < beam.segments.size(); ++i) {
    const fem::Segment& storey = beam.segments[i];
    json["masses_kg"].push_back(beam.bodies[i].mass);
    json["stiffnesses_n_per_m"].push_back(fem::storey_stiffness(storey));
    json["dashpots_n_s_per_m"].push_back(storey.dashpot);
    json["heights_m"].push_back(storey.length);
  }
  return json;
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

Json describe(const fem::Beam& beam, int elements) {
  if (beam.shear_building) return describe_chain(beam);
  Json json{{"length_m", beam.length()},
            {"mass_kg", beam.mass()},
            {"tip_mass_kg", beam.tip_mass()},
            {"elements", elements},
            {"mass_model", beam.mass_model == fem::MassModel::lumped ? "lumped" : "consistent"},
            {"axial_load_n", beam.axial_load}};
  for (const fem::Segment& segment : beam.segments) json["segments"].push_back(describe(segment));
  describe_attachments(beam, json);
  return json;
}

double total_mass(const fem::Beam& beam) {
  double sum = beam.mass();
  for (const fem::Body& body : beam.bodies) sum += body.mass;
  for (const fem::Absorber& absorber : beam.absorbers) sum += absorber.mass;
  return sum;
}

}  // namespace beamid::experiments
