// What sits on a beam: [[beam.bodies]], [[beam.supports]], [[beam.springs]], [[beam.dashpots]],
// [[beam.absorbers]], [[beam.damages]] and [[beam.added_masses]].
#pragma once

#include "experiments/text/toml_table.hpp"
#include "fem/beam.hpp"

namespace beamid::experiments {

/// Adds them to a beam whose segments are known.
/// @throws InputError for a place off the beam, a missing or a bad value, and one that has no effect.
void read_attachments(const TomlTable& table, fem::Beam& beam);

}  // namespace beamid::experiments
