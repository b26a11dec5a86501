// The segments of a TDMS file [tdms], read into its objects: the file, its groups and their channels.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/record/read_apart.hpp"

namespace beamid::experiments {

struct TdmsType;

struct TdmsProperty {
  double number = std::nan("");  ///< of a stamp: seconds since 1904
  std::string text;
  bool stamp = false;
};

/// What a chunk of raw data holds of a channel.
struct TdmsIndex {
  const TdmsType* type = nullptr;
  std::size_t count = 0, bytes = 0;
  std::vector<std::uint32_t> widths;   ///< of the rows of DAQmx's buffers [bytes]; empty: no DAQmx
  std::size_t buffer = 0, within = 0;  ///< the buffer of this channel, and its first byte in a row of it
  std::size_t scale = 0;               ///< the number that scales have for DAQmx's values
  std::string fault;                   ///< why its values are no numbers
};

/// The file, a group or a channel.
struct TdmsObject {
  std::string group_path;      ///< "/'Run 1'"
  std::string group, channel;  ///< the names of a channel's path /'group'/'channel', without the quotes
  std::map<std::string, TdmsProperty, std::less<>> properties;
  TdmsIndex index;                           ///< that of the last segment
  bool indexed = false, in_segment = false;  ///< it has had one; the last segment holds values of it
  int list = -1;                             ///< number of the last list that names it
  std::vector<double> values;                ///< as stored, without scales
  std::optional<std::int64_t> first_second;  ///< since 1904, from which stamps count
  int digits = 15;                           ///< significant ones of the values
  std::vector<std::pair<std::size_t, double>> starts;  ///< each wf_start_time, and how many values precede it
  std::string fault;                                   ///< why it has no values: "text"

  double number(const std::string& key) const;  ///< NaN where there is none
  std::string text(const std::string& key) const;
};

struct TdmsContent {
  std::map<std::string, TdmsObject, std::less<>> objects;  ///< by their paths
  std::vector<TdmsObject*> order;                          ///< in which they came
  bool unclosed = false;                                   ///< the last segment has no stated end
  std::size_t unfinished = 0;                              ///< [bytes] of it behind the last whole chunk
};

inline constexpr const char* tdms_export = "a file exported by LabVIEW or DIAdem as .lvm or CSV";

/// @param signals where values are announced before memory is taken for them.
/// @throws InputError for raw data whose place or type is uncertain, and where a size contradicts another.
TdmsContent read_tdms(const std::string& bytes, CollectedSignals& signals);

}  // namespace beamid::experiments
