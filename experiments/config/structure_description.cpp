#include "experiments/config/structure_description.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/config/description.hpp"
#include "experiments/text/spelling.hpp"
#include "fem/beam.hpp"
#include "fem/space_frame.hpp"

namespace beamid::experiments {
namespace {

std::string joint_name(const fem::Frame& frame, int joint) {
  const std::string& name = frame.joints[static_cast<std::size_t>(joint)].name;
  return name.empty() ? fmt::format("{}", joint + 1) : name;
}

}  // namespace

const std::vector<std::pair<std::string, fem::Frame::Support>>& frame_support_kinds() {
  static const std::vector<std::pair<std::string, fem::Frame::Support>> kinds{
      {"clamped", {0, true, true, true}},     {"pinned", {0, true, true, false}},
      {"rolling_x", {0, false, true, false}}, {"rolling_y", {0, true, false, false}},
      {"sliding_x", {0, false, true, true}},  {"sliding_y", {0, true, false, true}},
      {"guided", {0, false, false, true}}};
  return kinds;
}

std::string frame_support_kind(const fem::Frame::Support& support) {
  for (const auto& [name, kind] : frame_support_kinds())
    if (kind.x == support.x && kind.y == support.y && kind.rotation == support.rotation) return name;
  return "free";
}

std::string frame_text(const fem::Frame& frame, int elements_per_member, Eigen::Index coordinates) {
  std::string text =
      fmt::format("Plane frame: {} between {}, {:.6g} kg", counted(frame.members.size(), "member"),
                  counted(frame.joints.size(), "joint"), total_mass(frame));
  std::string held;
  for (const auto& [name, kind] : frame_support_kinds()) {
    std::string joints;
    for (const fem::Frame::Support& support : frame.supports)
      if (frame_support_kind(support) == name)
        joints += (joints.empty() ? "" : ", ") + joint_name(frame, support.joint);
    if (!joints.empty()) held += fmt::format("; {} at {}", name, joints);
  }
  text += held.empty() ? "; nowhere held" : held;
  return text + attachments_text(frame) + mesh_text(frame, elements_per_member, coordinates);
}

double total_mass(const fem::Frame& frame) {
  double sum = 0.0;
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    sum += frame.members[i].section.mass_per_length.mean() * frame.length(i);
  for (const fem::Frame::Body& body : frame.bodies) sum += body.mass;
  return sum;
}

std::string storey_laws_text(const std::vector<StoreySpring>& springs) {
  std::string text;
  for (const StoreySpring& spring : springs)
    text += fmt::format("{}storey {} {}", text.empty() ? "" : ", ", spring.storey, spring.law.name);
  return text;
}

std::string small_motion_note(const Experiment& experiment) {
  if (experiment.storey_springs.empty()) return {};
  return fmt::format(
      "This is the small motion about rest, each storey a linear spring of its stiffness there: {} {} "
      "its law only where it moves more.",
      storey_laws_text(experiment.storey_springs),
      experiment.storey_springs.size() == 1 ? "follows" : "each follow");
}

void require_model_of_storeys(const Experiment& experiment) {
  if (experiment.storey_springs.empty() || experiment.model.name == "beam") return;
  throw InputError(
      experiment.model.place,
      fmt::format("model '{}' is linear or of one coordinate; storeys that follow laws ({}) are moved by "
                  "model beam. Expected [model] name = \"beam\"",
                  experiment.model.name, storey_laws_text(experiment.storey_springs)));
}

void require_linear_storeys(const Experiment& experiment, const std::string& command) {
  if (experiment.storey_springs.empty()) return;
  throw InputError(
      experiment.storey_springs.front().law.place,
      fmt::format("{} takes linear storeys only; found {}. Expected no [[chain.storeys]], or simulate, "
                  "identify, compare or identifiability, which take them",
                  command, storey_laws_text(experiment.storey_springs)));
}

namespace {

// A space frame in a sentence, and its members, worked out.

/// Its members, worked out: lengths, stiffnesses, masses, and where z of their sections points.
nlohmann::ordered_json describe_members(const fem::SpaceFrame& frame);

/// How much of it there is, its mass, what holds it, mesh.
std::string space_frame_text(const fem::SpaceFrame& frame, int elements_per_member, Eigen::Index coordinates);

/// Of members and bodies [kg].
double total_mass(const fem::SpaceFrame& frame);

using Json = nlohmann::ordered_json;
using fem::SpaceFrame;

std::vector<double> numbers_of(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

std::vector<std::string> held_by(const SpaceFrame::Support& s) {
  std::vector<std::string> held;
  for (const auto& [holds, motion] :
       {std::pair{s.x, "x"}, {s.y, "y"}, {s.z, "z"}, {s.rx, "rx"}, {s.ry, "ry"}, {s.rz, "rz"}})
    if (holds) held.emplace_back(motion);
  return held;
}

Json describe_space_section(const fem::SpaceSection& s) {
  Json json{{"axial_stiffness_n", s.axial_stiffness},
            {"bending_stiffness_y_n_m2", s.bending_stiffness_y},
            {"bending_stiffness_z_n_m2", s.bending_stiffness_z},
            {"torsional_stiffness_n_m2", s.torsional_stiffness},
            {"mass_per_length_kg_per_m", s.mass_per_length},
            {"torsional_inertia_kg_m", s.torsional_inertia}};
  if (s.shear_stiffness_y) json["shear_stiffness_y_n"] = *s.shear_stiffness_y;
  if (s.shear_stiffness_z) json["shear_stiffness_z_n"] = *s.shear_stiffness_z;
  if (s.rotary_inertia_y > 0.0) json["rotary_inertia_y_kg_m"] = s.rotary_inertia_y;
  if (s.rotary_inertia_z > 0.0) json["rotary_inertia_z_kg_m"] = s.rotary_inertia_z;
  return json;
}

Json describe_space_member(const SpaceFrame& frame, std::size_t i) {
  const SpaceFrame::Member& member = frame.members[i];
  Json json{{"length_m", frame.length(i)}, {"section_z", numbers_of(frame.axes(i).col(2))}};
  json.update(describe_space_section(member.section));
  return json;
}

std::string space_joint_name(const SpaceFrame& frame, int joint) {
  const std::string& name = frame.joints[static_cast<std::size_t>(joint)].name;
  return name.empty() ? fmt::format("{}", joint + 1) : name;
}

// "x y z rx ry rz at 1, 2", the joints of each kind of support together.
std::string supports_text(const SpaceFrame& frame) {
  constexpr std::size_t most_shown = 8;
  std::vector<std::pair<std::string, std::vector<std::string>>> kinds;
  for (const SpaceFrame::Support& support : frame.supports) {
    const std::vector<std::string> held = held_by(support);
    std::string kind;
    for (const std::string& motion : held) kind += (kind.empty() ? "" : " ") + motion;
    if (held.size() == 6) kind = "clamped";
    auto at =
        std::find_if(kinds.begin(), kinds.end(), [&](const auto& known) { return known.first == kind; });
    if (at == kinds.end()) at = kinds.insert(kinds.end(), {kind, {}});
    at->second.push_back(space_joint_name(frame, support.joint));
  }
  std::string text;
  for (const auto& [kind, joints] : kinds) {
    text += "; " + (kind == "clamped" ? kind : "held in " + kind) + " at ";
    if (joints.size() > most_shown)
      text += fmt::format("{} joints", joints.size());
    else
      text += fmt::format("{}", fmt::join(joints, ", "));
  }
  return text.empty() ? "; nowhere held" : text;
}

Json describe_members(const SpaceFrame& frame) {
  Json members = Json::array();
  for (std::size_t i = 0; i < frame.members.size(); ++i) members.push_back(describe_space_member(frame, i));
  return members;
}

std::string space_frame_text(const SpaceFrame& frame, int elements_per_member, Eigen::Index coordinates) {
  std::string text =
      fmt::format("Space frame: {} between {}, {:.6g} kg", counted(frame.members.size(), "member"),
                  counted(frame.joints.size(), "joint"), total_mass(frame)) +
      supports_text(frame);
  return text + attachments_text(frame) + mesh_text(frame, elements_per_member, coordinates);
}

double total_mass(const SpaceFrame& frame) {
  double sum = 0.0;
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    sum += frame.members[i].section.mass_per_length * frame.length(i);
  for (const SpaceFrame::Body& body : frame.bodies) sum += body.mass;
  return sum;
}

// Segments and masses, worked out.

/// A segment, or the member of a frame, worked out: what the file gives as dimensions and densities stands
/// here as E I and mass per length. A quantity that varies along it is an array of its values at 0, 1/4, 1/2,
/// 3/4 and all of the segment, which determine it.
nlohmann::ordered_json describe(const fem::Segment& segment);

using Json = nlohmann::ordered_json;

Json variation_json(const fem::Variation& quantity) {
  if (quantity.is_constant()) return quantity(0.0);
  Json values = Json::array();
  for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) values.push_back(quantity(s));
  return values;
}

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

/// All of the mass that moves: beam, bodies, absorbers [kg].
double total_mass(const fem::Beam& beam) {
  double sum = beam.mass();
  for (const fem::Body& body : beam.bodies) sum += body.mass;
  for (const fem::Absorber& absorber : beam.absorbers) sum += absorber.mass;
  return sum;
}

using Json = nlohmann::ordered_json;

std::string factors_text(const fem::Structure& structure) {
  const std::vector<std::string> names = fem::factor_names(structure);
  return names.empty() ? "" : fmt::format(" Factors: {}.", joined(names));
}

Json describe_matrices(const fem::MatrixSystem& system) {
  return {{"unknowns", system.labels},
          {"mass_entries", system.mass.nonZeros()},
          {"stiffness_entries", system.stiffness.nonZeros()},
          {"damping_entries", system.damping.nonZeros()}};
}

Json describe_members(const fem::Frame& frame) {
  Json members = Json::array();
  for (std::size_t i = 0; i < frame.members.size(); ++i)
    members.push_back(describe(fem::Segment{frame.length(i), frame.members[i].section}));
  return members;
}

Json describe_segments(const fem::Beam& beam) {
  Json segments = Json::array();
  for (const fem::Segment& segment : beam.segments) segments.push_back(describe(segment));
  return segments;
}

}  // namespace

std::string structure_text(const Experiment& experiment, Eigen::Index elements, Eigen::Index coordinates) {
  const fem::Structure& structure = experiment.structure;
  if (const fem::Frame* const frame = structure.frame())
    return frame_text(*frame, experiment.elements, coordinates) + factors_text(structure);
  if (const fem::SpaceFrame* const frame = structure.space_frame())
    return space_frame_text(*frame, experiment.elements, coordinates) + factors_text(structure);
  if (const fem::MatrixSystem* const matrices = structure.matrices())
    return fmt::format("System of {} unknowns, {} to {}, from matrices of its own{}.", coordinates,
                       matrices->labels.front(), matrices->labels.back(),
                       matrices->damping.nonZeros() > 0 ? ", damping included" : "") +
           factors_text(structure);
  const std::string laws = storey_laws_text(experiment.storey_springs);
  return beam_text(structure.beam(), static_cast<int>(elements), coordinates) +
         (laws.empty() ? "" : " Laws of storeys: " + laws + ".");
}

Json describe(const fem::Structure& structure, int elements) {
  if (const fem::MatrixSystem* const matrices = structure.matrices()) return describe_matrices(*matrices);
  Json json{{"total_mass_kg", total_mass(structure)}};
  if (structure.is_chain()) return json;
  if (structure.is_beam()) {
    const fem::Beam& beam = structure.beam();
    json.update({{"elements", elements},
                 {"length_m", beam.length()},
                 {"mass_kg", beam.mass()},
                 {"segments", describe_segments(beam)}});
  } else {
    json["elements_per_member"] = elements;
    json["members"] =
        structure.frame() ? describe_members(*structure.frame()) : describe_members(*structure.space_frame());
  }
  return json;
}

double total_mass(const fem::Structure& structure) {
  if (const fem::Frame* const frame = structure.frame()) return total_mass(*frame);
  if (const fem::SpaceFrame* const frame = structure.space_frame()) return total_mass(*frame);
  if (const fem::MatrixSystem* const matrices = structure.matrices()) {
    const Eigen::VectorXd& base = matrices->base_motion;
    return base.size() > 0 ? base.dot(matrices->mass * base) : 0.0;
  }
  return total_mass(structure.beam());
}

std::string at_place_text(const std::optional<double>& position, const std::string& place) {
  if (!place.empty()) return " at " + place;
  return position ? fmt::format(" at {:g} m", *position) : "";
}

}  // namespace beamid::experiments
