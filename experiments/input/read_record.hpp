// Vibration records from delimited text.
#pragma once

#include <filesystem>

#include "experiments/experiment.hpp"

namespace beamid::experiments {

/// Reads the columns that `format` names, in SI units, and cuts its window.
///
/// Without channels in the format, the file's header must name every column by quantity and unit (time_s,
/// acceleration_m_per_s2, displacement_root_mm). Without a time column in the format, the header's time is
/// taken. With a sampling rate the times are start + k / rate; printed times then give the start only, and
/// must have that rate within 2 %. Without one, printed times must increase at one interval within 5 %,
/// rounding set aside.
///
/// @throws InputError naming file, line and column, what was found and what was expected; for a window
/// outside the
///         record at the window's own place where the format knows it.
Record read_record(const std::filesystem::path& file, const RecordFormat& format = {});

}  // namespace beamid::experiments
