// Another program, run to its end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace beamid::experiments {

struct ProcessResult {
  int exit_code = 0;   ///< 128 + signal when a signal ended it
  std::string output;  ///< standard output and standard error, as they came
  bool ended = true;   ///< by itself, within its time
};

/// Runs a program found on PATH in a folder. The arguments reach it as they are: no shell reads them.
/// @param arguments the program first. @param longest [s] it may take, else it is killed; 0: as long as it
/// likes.
/// @throws std::runtime_error when the program cannot be started.
ProcessResult run_process(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                          double longest = 0.0);

}  // namespace beamid::experiments
