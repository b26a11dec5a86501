// The lines of a LabVIEW measurement file, and the headers among them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

/// What a segment's header says of its channels; empty: nothing.
struct LvmSegment {
  std::vector<std::string> units, dimensions, x_units;
  std::vector<double> starts, intervals, samples;
  Place place = {};  ///< of the header's end

  bool over_time() const { return dimensions.empty() || dimensions[0] == "Time"; }
  std::string x_unit() const { return x_units.empty() ? "" : x_units[0]; }
};

/// Walks a file that is in memory.
class LvmLines {
 public:
  /// Behind the file's header, whose separator and decimal mark hold from there on.
  /// @param text must live as long as this
  /// @throws InputError where the header has no end.
  LvmLines(std::string file, std::string_view text);

  /// False at the file's end.
  bool next();
  /// Whether the line begins a block of keys, after rows or before the first of them.
  bool begins_segment() const;
  /// From there to its end. @throws InputError where it has none, or a number is none.
  LvmSegment read_segment();

  std::string_view line() const { return line_; }
  std::size_t number() const { return number_; }
  const std::vector<std::string_view>& fields() const { return fields_; }
  char separator() const { return separator_; }
  char decimal() const { return decimal_; }

  InputError bad(const std::string& message) const { return {{file_, number_, 1}, message}; }

 private:
  bool next_line();
  void read_file_header();
  std::vector<double> numbers(const std::vector<std::string>& words) const;

  std::string file_;
  std::string_view rest_, line_;
  std::size_t number_ = 0;
  char separator_ = '\t', decimal_ = '.';
  std::vector<std::string_view> fields_;
};

}  // namespace beamid::experiments
