// The samples of a dataset 58, in text or binary.
#pragma once

#include <vector>

#include "experiments/record/files/uff/universal_function.hpp"
#include "experiments/record/files/uff/universal_lines.hpp"

namespace beamid::experiments {

/// From behind the header to the dataset's end. Abscissae of uneven data are in the ordinate's precision.
/// @param stated number of bytes in the header; 0: none
std::vector<double> read_binary_numbers(UniversalLines& lines, const UniversalFunction& function,
                                        bool big_endian, long long stated);
std::vector<double> read_text_numbers(UniversalLines& lines, const UniversalFunction& function);

}  // namespace beamid::experiments
