// A plane frame as its TOML file describes it, and in full, as results.json holds it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "fem/frame.hpp"

namespace beamid::experiments {

struct FrameExperiment {
  std::string title;
  fem::Frame frame;
  std::vector<std::string> joint_names;  ///< one for each joint; its number, from 1, where it has no other
  int elements_per_member = 20;
};

/// With a name for each joint: its own, or its number.
FrameExperiment as_frame_experiment(const fem::Frame& frame, int elements_per_member,
                                    const std::string& title);

/// "clamped", "rolling_x", ...: what a support holds. Rolling and sliding are along the axis they name,
/// rolling with and sliding without a rotation; a guide holds the rotation alone.
const std::vector<std::pair<std::string, fem::Frame::Support>>& frame_support_kinds();

/// The kind of a support; "free" where it is none of them.
std::string frame_support_kind(const fem::Frame::Support& support);

/// Every quantity of the frame, worked out, as describe(beam) does it (beam_description.hpp); joints by their
/// number, from 1. What the frame does not have is left out.
nlohmann::ordered_json describe(const FrameExperiment& experiment);

/// The frame in a sentence or two: how much of it there is, its mass, what holds it, mesh.
std::string frame_text(const FrameExperiment& experiment, Eigen::Index coordinates);

/// Of members and bodies [kg].
double total_mass(const fem::Frame& frame);

}  // namespace beamid::experiments
