// Samples from numpy to a text file and from any file to numpy.
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <vector>

namespace beamid::python {

/// Columns (N) of float64, of any stride and read where they lie, as comma-separated text that reads back the
/// same.
/// @throws std::invalid_argument when they differ in length
void write_columns(const std::string& file, const std::string& header,
                   const std::vector<pybind11::array_t<double>>& columns);

/// A record as a command takes it: read, prepared and cut as [record] of `toml` says.
/// @returns a dict: time (N) [s], samples (N, p) in SI units, channels, remarks, warnings
pybind11::dict read_record(const std::string& file, const std::string& toml);

}  // namespace beamid::python
