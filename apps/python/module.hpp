// What the compiled core gives to the Python side beside the filters: commands that run without Python's lock
// and end by Ctrl-C, the curves of their results, records, and the specification of the commands.
#pragma once

#include <pybind11/numpy.h>

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

/// {name: {caption, panels: [{title, x_label, y_label, curves: [{label, style, x, y, lower, upper}]}]}}; the
/// arrays (N) lie in the outcome's own memory, which they keep alive.
/// @param owner the Python object of the outcome
pybind11::dict figures(const Outcome& outcome, const pybind11::object& owner);

/// {(run, name): values (N, p)}, likewise; run "" where there is only one.
pybind11::dict arrays(const Outcome& outcome, const pybind11::object& owner);

/// Columns (N) of float64, of any stride and read where they lie, as comma-separated text that reads back the
/// same.
/// @throws std::invalid_argument when they differ in length
void write_columns(const std::string& file, const std::string& header,
                   const std::vector<pybind11::array_t<double>>& columns);

/// A record as a command takes it: read, prepared and cut as [record] of `toml` says.
/// @returns a dict: time (N) [s], samples (N, p) in SI units, channels, remarks, warnings
pybind11::dict read_record(const std::string& file, const std::string& toml);

/// What the commands take, and what an experiment file may hold, for the Python side to make its functions
/// of. JSON: "version"; "commands", with the options of apps::command_groups(); "tables", with the keys of
/// experiments::key_tables(); "quantities" and "time_units", with the symbols and suffixes of their units.
std::string specification();

}  // namespace beamid::python
