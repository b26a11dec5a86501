// Where the fields of rows of text stand, found again when a message needs it.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/record/record_table.hpp"

namespace beamid::experiments {

/// Keeps a text and where its rows begin.
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
    std::vector<std::string_view> lines;
    std::vector<std::size_t> numbers;
  };
  std::shared_ptr<Rows> rows_;
};

}  // namespace beamid::experiments
