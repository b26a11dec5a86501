// [sweep] of an experiment file, and the keys of the others that it may vary.
#pragma once

#include "experiments/config/schema.hpp"
#include "experiments/sweep/sweep_plan.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

/// @param table [sweep]. @throws InputError at an impossible value.
SweepPlan read_sweep(const TomlTable& table);

/// The keys of a table that a sweep may vary: those of one value. Numbers alone may be drawn from a law.
std::vector<std::string> keys_to_vary(const KeyTable& section);

/// Refuses a key that no experiment file has, as "beam.tip_mas_kg", and a value that the key cannot have.
/// @throws std::invalid_argument saying what was found and what was expected.
void check_key(const VariedKey& varied);

/// Keys beside "beam.mass_kg" that give the same quantity: what is varied takes their place.
std::vector<std::string> keys_instead(const std::string& key);

inline constexpr int most_samples = 100000000;

}  // namespace beamid::experiments
