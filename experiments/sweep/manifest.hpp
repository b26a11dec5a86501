// Which sweep the cases of a folder belong to.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/sweep/rows.hpp"

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

// The cases that are finished, kept so that nothing that ends a sweep can lose them.

/// The rows of a file, complete cases only, and where the last of these ends.
struct KeptCases {
  std::vector<SweepRow> rows;
  std::size_t size = 0;  ///< bytes up to the end of the last complete case; 0: not even the header is whole
};

/// @throws InputError at a line that is no row, unless it is the last and torn.
KeptCases read_cases(const std::filesystem::path& file, const SweepPlan& plan);

/// A folder with manifest.json and cases.csv, to which every case is appended by one write when it is
/// finished. A process killed within that write leaves a torn case at the end, which the next one cuts off.
class Journal {
 public:
  /// @param resume go on with what the folder holds; without it the folder must not be there.
  /// @throws std::invalid_argument when it is in use, else when it is there, or is that of another sweep.
  /// @throws std::runtime_error when it cannot be written.
  Journal(const std::filesystem::path& folder, const nlohmann::ordered_json& manifest, const SweepPlan& plan,
          bool resume);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::vector<SweepRow>& kept() const { return kept_.rows; }  ///< of earlier processes

  /// All rows of one case. Not to be called by two threads at once.
  /// @throws std::runtime_error when the disk is full; what was kept before stays whole.
  void append(const std::vector<SweepRow>& rows);

 private:
  std::filesystem::path folder_, file_;
  KeptCases kept_;
  int descriptor_ = -1;

  void write(const std::string& text);
  [[noreturn]] void fail() const;
};

/// Removes a journal, if there is one; false, and nothing is removed, where another process works on it.
/// @throws InputError when the folder holds something else
bool discard_journal(const std::filesystem::path& folder);

}  // namespace beamid::experiments
