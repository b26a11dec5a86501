// Readers of record files, found by name or by what a file begins with.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "experiments/record/record_format.hpp"
#include "experiments/record/record_table.hpp"
#include "filters/registry.hpp"

namespace beamid::experiments {

/// One kind of file; each is one file under record_files/ that registers itself.
class RecordReader {
 public:
  virtual ~RecordReader() = default;

  /// @param beginning of the file, at most 1024 bytes.
  virtual bool recognises(std::string_view beginning) const = 0;

  /// All columns of numbers.
  /// @param format where it speaks of separators, header lines and the like.
  /// @throws InputError naming the place as finely as the kind of file allows.
  virtual RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const = 0;
};

using RecordReaderRegistry = filters::Registry<RecordReader>;
RecordReaderRegistry& record_reader_registry();

/// The reader that `format` names, else the one that recognises the file, else delimited text, which is also
/// meant wherever the format states header lines or a separator.
/// @throws InputError when there is no such file, std::invalid_argument when there is no such reader.
std::string reader_of(const std::filesystem::path& file, const RecordFormat& format);

/// The file's columns, by reader_of(), with names and units cleaned (clean_text.hpp). @throws InputError.
RecordTable read_table(const std::filesystem::path& file, const RecordFormat& format);

}  // namespace beamid::experiments
