// The instants of a file that is inspected: which column they are, or how else they are known.
#pragma once

#include <optional>

#include "experiments/record/inspect/inspection.hpp"
#include "experiments/record/record_columns.hpp"

namespace beamid::experiments {

/// The column of time, what is said of it, and what would state it.
std::optional<RecordColumn> find_time(const RecordTable& table, const RecordFormat& format, std::string& text,
                                      std::string& key);

/// Instants of all rows from that column, the file's clock or the rate stated; else rows are counted.
void set_time(const RecordTable& table, const RecordFormat& format, const std::optional<RecordColumn>& column,
              Inspection& found);

}  // namespace beamid::experiments
