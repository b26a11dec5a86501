// Vibration records from whatever file holds them.
#pragma once

#include <filesystem>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// Reads the columns that `format` names, in SI units, and cuts its window. The file is of the kind that the
/// format names or that it shows to be (record_table.hpp).
///
/// Without channels in the format, the file must say itself what its columns are: by names with a quantity
/// and a unit (time_s, acceleration_m_per_s2, displacement_root_mm) or by units of its own. Without a time
/// column in the format, the header's time is taken. With a sampling rate the times are start + k / rate;
/// printed times then give the start only, and none may be half an interval, rounding set aside, from where
/// the rate puts it; an interval in the file's header must agree within 2 %. Without a rate, printed times
/// must increase at one interval within 5 %, rounding set aside, or, where the format takes stamps as they
/// are, only increase. Rows in which a used column holds no finite number are refused, or left out where the
/// format says so: Record::remarks counts and locates them.
///
/// @throws InputError naming file, line and column, what was found and what was expected; for a window
/// outside the
///         record at the window's own place where the format knows it.
Record read_record(const std::filesystem::path& file, const RecordFormat& format = {});

}  // namespace beamid::experiments
