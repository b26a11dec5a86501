// From an excitation to the loads of a structural system.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "experiments/config/channel_places.hpp"
#include "fem/response/response.hpp"

namespace beamid::experiments {

/// What an excitation is on one mesh and one time grid.
struct ExcitationHistory {
  fem::Loading loading;
  Eigen::VectorXd base_acceleration;  ///< (N) [m/s2]; empty: the base rests
  std::vector<std::string> notes;     ///< what a reader should know, a sentence each
};

/// @param input number of the input (and output) that the excitation acts on.
/// @param folder in which the excitation's file is looked for.
/// @param seed of random forces.
/// @throws InputError at the excitation's place when it cannot be followed: a pulse or a letting go shorter
/// than four steps, a static shape of a beam that moves without strain, a file without force, nothing that
/// moves.
ExcitationHistory excite(const Excitation& excitation, const fem::StructuralSystem& system,
                         Eigen::Index input, const fem::TimeGrid& grid, const std::filesystem::path& folder,
                         std::uint64_t seed = 1);

/// Whether the excitation goes on while the record runs: a force, or a motion of the base.
bool has_force_history(const Excitation& excitation);

/// What a further force or the motion of the base adds.
void add(const ExcitationHistory& further, ExcitationHistory& to);

}  // namespace beamid::experiments
