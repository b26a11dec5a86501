// The table [beam] of an experiment file.
#pragma once

#include <string>
#include <vector>

#include "experiments/text/toml_table.hpp"
#include "fem/beam.hpp"

namespace beamid::experiments {

/// One segment described in [beam] itself, or several in [[beam.segments]] (read_segment.hpp); how its ends
/// are held; what sits on it (read_beam.cpp). The sensor's mass rides on the tip, beside the tip mass.
/// @throws InputError for missing, contradicting and useless keys at the table's place or the key's, for a
/// bad value at its own.
fem::Beam read_beam(const TomlTable& table);

/// Finite elements along the beam.
int read_elements(const TomlTable& table);

/// @throws std::invalid_argument where memory does not hold a mesh and so many of its modes
/// (memory_need.hpp).
void require_mesh_memory(double elements, double modes = 0);

/// "clamped-free" and every other pair of clamped, pinned, guided, free: root first, then tip.
const std::vector<std::string>& end_supports();

/// The supports at the ends of a beam. @param name one of end_supports(); "clamped-free", "pinned-guided",
/// ...
std::vector<fem::Support> supports_of(const std::string& name, double length);

}  // namespace beamid::experiments
