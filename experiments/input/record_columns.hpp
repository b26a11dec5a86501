// Which columns of a file hold a record's time and channels.
#pragma once

#include <optional>
#include <vector>

#include "experiments/experiment.hpp"
#include "experiments/input/delimited_text.hpp"

namespace beamid::experiments {

struct RecordColumn {
  std::size_t index = 0;  ///< from 0
  double factor = 1;      ///< to SI units
  Channel channel;        ///< of no meaning for time
};

struct RecordColumns {
  std::optional<RecordColumn> time;
  std::vector<RecordColumn> channels;
};

/// Finds the columns a format names, or, where it names none, those the header names.
/// @throws InputError at the header or the first row.
RecordColumns find_columns(const DelimitedText& text, const RecordFormat& format);

}  // namespace beamid::experiments
