// Where the fields of rows of text stand, found again when a message needs it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/record/record_table.hpp"

namespace beamid::experiments {

/// Keeps a text and where its rows begin: 12 bytes a row, numbers of lines by their runs.
class TextCells {
 public:
  TextCells(std::string file, std::shared_ptr<const std::string> text);

  /// @param line a view into the text; @param number its line's, from 1.
  void add(std::string_view line, std::size_t number);

  /// @param columns of the text that the table's columns are, from 0; empty: the same ones.
  std::function<TextField(std::size_t, std::size_t)> cells(char separator,
                                                           std::vector<std::size_t> columns = {}) const;

 private:
  struct Rows {
    std::string file;
    std::shared_ptr<const std::string> text;
    std::vector<std::size_t> begins;
    std::vector<std::uint32_t> lengths;
    /// Of rows from the first of a pair on, the number of that row's line; each row a line until the next
    /// pair.
    std::vector<std::pair<std::size_t, std::size_t>> runs;

    std::string_view line(std::size_t row) const;
    std::size_t number(std::size_t row) const;
  };
  std::shared_ptr<Rows> rows_;
};

}  // namespace beamid::experiments
