// Matrices of a structure in MATLAB files.
#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <string>

namespace beamid::experiments {

/// A real matrix of a MATLAB file of level 5 or 7.3, full or sparse, read in a child process
/// (read_apart.hpp).
/// @param variable its name; empty: the file's only matrix
/// @throws InputError where there is no such matrix, several without a name, or the file is damaged.
Eigen::SparseMatrix<double> read_mat_matrix(const std::filesystem::path& file, const std::string& variable);

}  // namespace beamid::experiments
