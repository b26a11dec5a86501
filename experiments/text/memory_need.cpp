#include "experiments/text/memory_need.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>

namespace beamid::experiments {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number that a file of the system holds, behind a word; infinite where it holds none, as "max".
double system_number(const char* file, const std::string& behind = "") {
  std::ifstream stream(file);
  std::string word;
  while (!behind.empty() && stream >> word && word != behind) {
  }
  double number = unlimited;
  return stream >> number ? number : unlimited;
}

double machine_left() {
  return 1024.0 * system_number("/proc/meminfo", "MemAvailable:");
}

double limit_left() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const double taken = system_number("/proc/self/statm") * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::isfinite(taken) ? static_cast<double>(limit.rlim_cur) - taken : unlimited;
}

double container_left() {
  constexpr const char* files[][2] = {
      {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"},
      {"/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/memory.usage_in_bytes"}};
  for (const auto& [most, taken] : files)
    if (const double left = system_number(most) - system_number(taken); std::isfinite(left)) return left;
  return unlimited;
}

}  // namespace

double memory_left() {
  return std::max(0.0, std::min({machine_left(), limit_left(), container_left()}));
}

void require_memory(double count, const std::string& what, double bytes) {
  constexpr double always_there = 1e6;  // less is not worth the question, which reads five files
  if (count * bytes <= always_there) return;
  const double left = memory_left();
  if (count * bytes <= left) return;
  throw std::invalid_argument(
      fmt::format("{:.6g} {} need {} of memory; at most {:.2g} fit here, where {} are free", count, what,
                  bytes_text(count * bytes), std::floor(left / bytes), bytes_text(left)));
}

std::string bytes_text(double bytes) {
  const char* unit = "B";
  for (const char* larger : {"kB", "MB", "GB", "TB", "PB", "EB"}) {
    if (!(bytes >= 999.5)) break;
    bytes /= 1000;
    unit = larger;
  }
  return fmt::format("{:.3g} {}", bytes, unit);
}

}  // namespace beamid::experiments
