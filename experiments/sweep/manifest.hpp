// Which sweep the cases of a folder belong to.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "experiments/sweep/case.hpp"

namespace beamid::experiments {

/// Part `index` of `count`, from 0: the cases whose number leaves this remainder.
struct Shard {
  std::size_t index = 0, count = 1;
  bool holds(std::size_t number) const { return number % count == index; }
};

/// Program, version, plan, the experiment files word by word, hashes of the files that these name (records,
/// forces, shapes), "hash" of all that, and which shard it is.
/// A sweep that identifies once names the processor's instructions too: its last digits depend on them.
nlohmann::ordered_json manifest_of(const SweepSource& source, const SweepPlan& plan, const Shard& shard);

/// @throws InputError when the file is no manifest of a sweep.
nlohmann::ordered_json read_manifest(const std::filesystem::path& file);

/// The plan that a manifest tells. @throws InputError naming `file`.
SweepPlan plan_of(const nlohmann::ordered_json& manifest, const std::filesystem::path& file);

/// FNV-1a of 64 bits, as 16 hexadecimal digits.
std::string hash_of(const std::string& text);

}  // namespace beamid::experiments
