// Vibration records as delimited text that read_record() reads without being told how.
#pragma once

#include <filesystem>
#include <string>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// Comma-separated rows under a header that carries SI units: time_s, acceleration_m_per_s2, force_root_n.
///
/// @param digits significant ones; 0 for as many as reading back the same doubles takes.
/// @throws std::invalid_argument when times, samples and channels differ in number or hold NaN or infinity.
std::string to_csv(const Record& record, int digits = 0);

/// Writes to_csv() to a file, which appears whole or not at all.
/// @throws std::runtime_error when it cannot be written.
void write_record(const Record& record, const std::filesystem::path& file, int digits = 0);

}  // namespace beamid::experiments
