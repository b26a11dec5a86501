// What a request needs of the machine's memory, asked before any of it is taken: a message instead of the
// kernel's killer.
#pragma once

#include <string>

namespace beamid::experiments {

/// Bytes that this process can still take: what the machine has left, or less where `ulimit -v` or a
/// container (its cgroup) says so; infinite where the system does not tell.
double memory_left();

/// @param count of `what`, as 1e6 of "elements with 1000 modes"
/// @param bytes that each of them takes at least
/// @throws std::invalid_argument "1e+06 elements with 1000 modes need 64 GB of memory; at most 190000 fit
/// here"
void require_memory(double count, const std::string& what, double bytes);

/// "950 kB", "64 GB", "4 PB"
std::string bytes_text(double bytes);

}  // namespace beamid::experiments
