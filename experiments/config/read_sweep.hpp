// [sweep] of an experiment file.
#pragma once

#include "experiments/config/sweep_plan.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// @param table [sweep]. @throws InputError at an impossible value.
SweepPlan read_sweep(const TomlTable& table);

/// Refuses a key that no experiment file has, as "beam.tip_mas_kg".
/// @throws std::invalid_argument naming the known ones.
void refuse_unknown(const VariedKey& varied);

inline constexpr int most_samples = 100000000;

}  // namespace beamid::experiments
