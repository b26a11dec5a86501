// Texts that are read without a word about them.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>

#include "experiments/record/read_record.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments {

inline Record recognised(const std::string& content, const RecordFormat& format = {}) {
  const TemporaryFile file("record.txt", content);
  return read_record(file.path(), format);
}

// A decay of 5 Hz, written as the caller likes; 400 Hz.
inline std::string signal_rows(int rows, const std::function<std::string(int, double)>& row) {
  std::string text;
  for (int k = 0; k < rows; ++k) text += row(k, std::exp(-0.002 * k) * std::cos(0.08 * k)) + "\n";
  return text;
}

inline std::string question_of(const std::string& content, const RecordFormat& format = {}) {
  try {
    return fmt::format("read at {:.6g} Hz", 1.0 / recognised(content, format).interval());
  } catch (const InputError& asked) {
    return asked.what();
  }
}

}  // namespace beamid::experiments
