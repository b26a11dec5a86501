// The lines of a Universal File, and the numbers in their columns [uff].
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "experiments/text/fields.hpp"

namespace beamid::experiments {

/// Walks a file whose bytes are in memory; what does not fit is refused at its line and column.
class UniversalLines {
 public:
  /// @param bytes must live as long as this
  UniversalLines(std::string name, const std::string& bytes) : name_(std::move(name)), bytes_(bytes) {}

  /// False at the file's end.
  bool next();
  /// The next call of next() gives this line again.
  void back() { at_ = begin_, --number_; }
  /// The next line of a header. @throws InputError where the dataset or the file ends, naming `what` is
  /// missing.
  void next_of_header(const char* what);
  /// Behind the line "-1".
  void skip_dataset();
  /// Goes to the line that holds the next dataset's number, and gives its number: 58, also of "58b"; 0 where
  /// the line is none. False at the file's end.
  bool next_dataset(int& number);

  std::string_view line() const { return line_; }
  /// Columns [from, from + width) of the line, without blanks around.
  std::string_view field(std::size_t from, std::size_t width) const;
  /// Its number, 0 where it is blank. @throws InputError where it is none, naming `what`.
  long long whole(std::size_t from, std::size_t width, const char* what) const;
  double real(std::size_t from, std::size_t width, const char* what) const;

  /// The bytes behind the line, as they are, and what of them was taken.
  std::string_view ahead() const { return std::string_view(bytes_).substr(std::min(at_, bytes_.size())); }
  void skip_bytes(std::size_t count) { at_ += count; }
  std::size_t size() const { return bytes_.size(); }

  [[noreturn]] void fail(const std::string& message, std::size_t column = 0) const;

 private:
  std::string name_;
  const std::string& bytes_;
  std::size_t at_ = 0, begin_ = 0, number_ = 0;
  std::string_view line_;
};

/// Fortran writes exponents with E or D.
ParsedNumber parse_fortran(std::string_view text);

}  // namespace beamid::experiments
