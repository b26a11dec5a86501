// A structure in a sentence, and worked out, as results.json holds it.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "experiments/config/experiment.hpp"
#include "fem/beam.hpp"
#include "fem/frame.hpp"

namespace beamid::experiments {

// A plane frame in a sentence.

// What the sentences about plane and space frames share.

/// "1 member", "2 members"
inline std::string counted(std::size_t number, const char* what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

/// "; 2 bodies; 1 spring": what sits at joints, and loads of members.
template <class AnyFrame>
std::string attachments_text(const AnyFrame& frame) {
  std::string text;
  if (!frame.bodies.empty())
    text += frame.bodies.size() == 1 ? "; 1 body" : fmt::format("; {} bodies", frame.bodies.size());
  if (!frame.springs.empty()) text += "; " + counted(frame.springs.size(), "spring");
  if (!frame.dashpots.empty()) text += "; " + counted(frame.dashpots.size(), "dashpot");
  const auto loaded = std::count_if(frame.members.begin(), frame.members.end(),
                                    [](const auto& member) { return member.axial_load != 0.0; });
  if (loaded > 0) text += "; axial load in " + counted(static_cast<std::size_t>(loaded), "member");
  return text;
}

/// ". 8 elements per member, 240 degrees of freedom."
template <class AnyFrame>
std::string mesh_text(const AnyFrame& frame, int elements_per_member, Eigen::Index coordinates) {
  return fmt::format(". {} per member{}, {} degrees of freedom.",
                     counted(static_cast<std::size_t>(elements_per_member), "element"),
                     frame.mass_model == fem::MassModel::lumped ? " with lumped mass" : "", coordinates);
}

/// "clamped", "rolling_x", ...: what a support holds. Rolling and sliding are along the axis they name,
/// rolling with and sliding without a rotation; a guide holds the rotation alone.
const std::vector<std::pair<std::string, fem::Frame::Support>>& frame_support_kinds();

/// The kind of a support; "free" where it is none of them.
std::string frame_support_kind(const fem::Frame::Support& support);

/// The frame in a sentence or two: how much of it there is, its mass, what holds it, mesh.
std::string frame_text(const fem::Frame& frame, int elements_per_member, Eigen::Index coordinates);

/// Of members and bodies [kg].
double total_mass(const fem::Frame& frame);

// What is said of storeys that follow laws, and by whom they are not taken.

/// "storey 1 bouc_wen, storey 3 duffing"; empty where all are linear.
std::string storey_laws_text(const std::vector<StoreySpring>& springs);

/// That modes and frequency responses are those of small motion; empty where all storeys are linear.
std::string small_motion_note(const Experiment& experiment);

/// @throws InputError at the first law, "update takes linear storeys only; ..."
void require_linear_storeys(const Experiment& experiment, const std::string& command);

/// @throws InputError where the model is not `beam`, which alone moves them
void require_model_of_storeys(const Experiment& experiment);

/// What it is, its masses, what holds it, mesh. @param elements of a beam's mesh
std::string structure_text(const Experiment& experiment, Eigen::Index elements, Eigen::Index coordinates);

/// What the keys of the file come to: masses, mesh, and the stiffness and mass of segments or members; of
/// matrices their unknowns.
nlohmann::ordered_json describe(const fem::Structure& structure, int elements);

/// All of the mass that moves [kg]; of matrices r^T M r under a motion of the base, 0 where that is not
/// known.
double total_mass(const fem::Structure& structure);

/// " at 1.2 m", " at ridge.x"; empty where neither is known.
std::string at_place_text(const std::optional<double>& position, const std::string& place);

}  // namespace beamid::experiments
