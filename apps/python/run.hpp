// A command run for Python: without its lock, ended by Ctrl-C, its results kept as they are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/command.hpp"
#include "experiments/results/results.hpp"

namespace beamid::python {

/// How a command ended.
struct Outcome {
  int code = 0;         ///< the command's exit code
  std::string printed;  ///< by a command that has no results, such as list
  std::optional<experiments::Results> results;
  std::optional<apps::Refusal> refusal;  ///< why there is nothing

  std::string json() const;    ///< results.json, as the command's --json prints it
  std::string report() const;  ///< what the command prints for a person, 100 columns wide
  /// The command's --out DIR. @throws std::invalid_argument, std::runtime_error as ResultDirectory
  void write(const std::string& folder, bool force, const std::string& command_line,
             const std::string& experiment_file);
};

/// Runs a command in a thread of its own, while the caller's waits without Python's lock and looks for
/// signals: with Ctrl-C the run ends at its next sample or case.
/// @param words behind the command's name
/// @throws pybind11::error_already_set of the signal's handler, such as KeyboardInterrupt
Outcome run(const std::string& command, const std::vector<std::string>& words);

/// `beamid WORDS...`, ended by Ctrl-C as a command is; its exit code.
int run_main(std::vector<std::string> words);

}  // namespace beamid::python
