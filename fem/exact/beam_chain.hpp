// The beam as a researcher describes it, as chains for harmonic motion.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fem/beam.hpp"
#include "fem/exact/harmonic_chain.hpp"

namespace beamid::fem {

/// A node at every break of the beam and a piece between neighbours; nothing where a piece is not uniform or
/// its compression is above two fifths of its shear stiffness.
/// @throws std::invalid_argument when the beam is impossible.
std::optional<HarmonicChain> chain_of(const Beam& beam);

/// The parts that a clamp at an inner node separates; they move independently.
std::vector<HarmonicChain> split_where_clamped(const HarmonicChain& whole);

/// Motions of a chain without strain (2 x 0, 1 or 2), each as (w at x = 0, slope): a translation, and a turn
/// about what holds the deflection or about the centre of mass.
Eigen::Matrix2Xd rigid_motions(const HarmonicChain& chain);

}  // namespace beamid::fem
