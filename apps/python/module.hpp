// What the compiled core gives to the Python side beside run() and the filters: curves, records,
// specification.
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <vector>

#include "apps/python/run.hpp"

namespace beamid::python {

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
