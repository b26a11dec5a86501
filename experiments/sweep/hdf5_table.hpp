// The cases as a table of HDF5.
#pragma once

#include <filesystem>
#include <vector>

#include "experiments/sweep/rows.hpp"

namespace beamid::experiments {

/// One dataset "cases" of a compound type with the columns of cases.csv. Python reads it as a structured
/// array: `h5py.File("cases.h5")["cases"][:]`. Keys that vary are numbers where all their values are. The
/// same rows give the same bytes. @throws std::runtime_error when the file cannot be written.
void write_hdf5(const SweepPlan& plan, const std::vector<SweepRow>& rows, const std::filesystem::path& file);

}  // namespace beamid::experiments
