// What the sentences about plane and space frames share.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <string>

#include "fem/beam.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
