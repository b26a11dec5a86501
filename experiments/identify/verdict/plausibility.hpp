// Is a structure one that somebody can have built?
#pragma once

#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// A sentence for everything that suggests wrong units or a description that does not mean what it says: a
/// height above a fifth of the length, Young's modulus outside 1e8 to 1e12 Pa, a density outside 100 to
/// 25,000 kg/m3, a first frequency below 0.01 Hz or above 20 kHz, a damping ratio of 1 or more; supports that
/// are joined, damages that overlap. Modulus and density are those of segments, or of members of a plane
/// frame, whose outline is known; a member's height is compared with the frame's extent. Of chains the first
/// frequency and the damping alone, of others nothing.
std::vector<std::string> implausible(const Experiment& experiment);

/// Puts them first, behind the heading, and into results.json as "beam_warnings".
void warn(Results& results, const Experiment& experiment);

/// Those of an experiment file, where one is named.
void warn_of_file(Results& results, const std::string& file);

}  // namespace beamid::experiments
