// What a sweep varies, how its file states it, and the cases that this makes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/config/schema.hpp"
#include "experiments/text/toml_table.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

/// One key of the experiment file and what it is set to: the values of a grid, or a law to draw from.
struct VariedKey {
  enum class Law { grid, uniform, log_uniform, normal };
  std::string key;  ///< "beam.tip_mass_kg", "sensors[1].noise_m"; "truth." in front: of the truth only
  Law law = Law::grid;
  std::vector<filters::OptionValue> values;  ///< of a grid
  double first = 0.0, second = 0.0;          ///< from and to, or mean and deviation, of a law
  std::string text;                          ///< as the user wrote it

  bool is_drawn() const { return law != Law::grid; }
};

/// Grid points x samples x seeds. Cases are numbered from 0: the last seed fastest, the first key slowest.
struct SweepPlan {
  std::vector<VariedKey> varied;
  int samples = 1;         ///< drawn for every point of the grid
  int seeds = 1;           ///< for every sample
  std::uint64_t seed = 1;  ///< of case 0's noise; case i has seed + i. Also of what is drawn
  bool once = false;       ///< filter once from what is assumed (repeats.hpp), not as `beamid compare` does

  std::size_t points() const;  ///< of the grid; 1 without one
  std::size_t cases() const;
  std::size_t point_of(std::size_t number) const;
  std::size_t sample_of(std::size_t number) const { return number / static_cast<std::size_t>(seeds); }
  std::uint64_t seed_of(std::size_t number) const { return seed + number; }
};

/// Most cases of one sweep, so that every seed remains a whole number of the experiment file.
inline constexpr double most_cases = 1e8;

/// "KEY=FROM:TO:STEPS[:log]", "KEY=A,B,C", "KEY=uniform:FROM:TO", "KEY=log_uniform:FROM:TO" or
/// "KEY=normal:MEAN:DEVIATION". @throws std::invalid_argument saying what was found and what was expected.
VariedKey parse_varied(const std::string& text);

/// What the keys are set to in a case, in their order. Sample m of key j is the number j of the random stream
/// m of the plan's seed: the same on any machine, whatever ran before.
std::vector<filters::OptionValue> values_of(const SweepPlan& plan, std::size_t number);

/// The same of a point of the grid; what is drawn stands as the text of its law.
std::vector<filters::OptionValue> values_of_point(const SweepPlan& plan, std::size_t point);

/// @throws std::invalid_argument when a key occurs twice, samples are asked for with nothing to draw or the
/// other way round, or there are too many cases.
void check(const SweepPlan& plan);

// [sweep] of an experiment file, and the keys of the others that it may vary.

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
