// Files that only a library can read, read where its faults do no harm.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "experiments/record/collected_signals.hpp"

namespace beamid::experiments {

/// What reading a file may take.
struct ReadingLimits {
  std::size_t numbers = 0;  ///< in all
  double seconds = 0.0;     ///< of processor time
  std::size_t bytes = 0;    ///< of memory, beside what this process has
};

/// By a file's size: as many numbers as compression can have put into it, but no more than 2^25 (256 MiB) or
/// one for each of its bytes, nor than fit here (memory_need.hpp); memory for three copies of them; one
/// second and four more for each megabyte.
ReadingLimits reading_limits(std::size_t file_bytes);

/// Collects signals in a child process, whose crashes, endless loops and hunger for memory end as a message.
/// Damaged files make HDF5 1.10 do all three.
///
/// @param library that reads, for messages: "HDF5".
/// @param read called in the child; prints to nowhere.
/// @throws InputError that of `read`, and where the child crashes, does not end, or needs more than its
/// limits.
CollectedSignals read_apart(const std::string& file, const std::string& library, const ReadingLimits& limits,
                            const std::function<void(CollectedSignals&)>& read);

}  // namespace beamid::experiments
