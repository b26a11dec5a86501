// Matrices in the Matrix Market exchange format [boisvert1996]: "%%MatrixMarket matrix coordinate real
// symmetric", the sizes, then one entry a line (coordinate) or one value a line, column by column (array).
#pragma once

#include <Eigen/SparseCore>
#include <filesystem>
#include <string>

namespace beamid::experiments {

/// Real or whole numbers, general or symmetric; entries at one place are added.
/// @throws InputError with file and line: what was found and what was expected.
Eigen::SparseMatrix<double> read_matrix_market(const std::filesystem::path& file);

/// The same of a text. @param file its name, for messages
Eigen::SparseMatrix<double> parse_matrix_market(const std::string& text, const std::string& file);

}  // namespace beamid::experiments
