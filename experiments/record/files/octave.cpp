// The text that Octave's `save` writes: variables one after another, each with a header of its own.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/read_apart.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

using std::string_view;

/// Walks the lines of a text.
class VariableLines {
 public:
  VariableLines(std::string file, string_view text) : file_(std::move(file)), rest_(text) {}

  bool next() {
    if (rest_.empty()) return false;
    line_ = take_line(rest_), ++number_;
    return true;
  }
  /// The next line that is not blank.
  bool next_of_words() {
    while (next())
      if (!trimmed(line_).empty()) return true;
    return false;
  }
  string_view line() const { return line_; }
  InputError bad(const std::string& message) const { return {{file_, number_, 1}, message}; }

  /// Appends the numbers of the line. @throws InputError at one that is none
  void take_numbers(std::vector<double>& values) {
    split_fields(line_, ' ', fields_);
    for (const string_view field : fields_) {
      const ParsedNumber parsed = parse_number(field);
      if (!parsed.number) throw bad(fmt::format("'{}'; expected a number", field));
      values.push_back(parsed.finite ? parsed.value : std::nan(""));
    }
  }

 private:
  std::string file_;
  string_view rest_, line_;
  std::size_t number_ = 0;
  std::vector<string_view> fields_;
};

/// Behind "# rows:", in a comment; absent: the line is another.
std::optional<string_view> value_of(string_view line, string_view key) {
  if (!line.starts_with("# ") || !line.substr(2).starts_with(key)) return {};
  return trimmed(line.substr(2 + key.size()));
}

/// Variables: "# name: acc", "# type: matrix", "# rows: 4000", "# columns: 1", numbers.
class OctaveVariables {
 public:
  OctaveVariables(VariableLines& lines, CollectedSignals& signals) : lines_(lines), signals_(signals) {}

  void read() {
    while (lines_.next_of_words()) {
      const string_view line = lines_.line();
      if (const auto name = value_of(line, "name:"))
        name_ = *name, type_.clear(), rows_ = columns_ = 0;
      else if (const auto type = value_of(line, "type:"))
        type_ = *type;
      else if (const auto rows = value_of(line, "rows:"))
        rows_ = count(*rows);
      else if (const auto columns = value_of(line, "columns:"))
        columns_ = count(*columns), read_matrix();
      else if (value_of(line, "ndims:"))
        read_extent(), read_matrix();
      else if (value_of(line, "base, limit"))
        read_range();
      else if (!line.starts_with('#'))
        read_single();
    }
  }

 private:
  std::size_t count(string_view text) const {
    constexpr double most = 1e9;
    const ParsedNumber parsed = parse_number(text);
    if (!parsed.finite || parsed.value < 0.0 || parsed.value > most ||
        parsed.value != std::floor(parsed.value))
      throw lines_.bad(fmt::format("'{}'; expected a count", text));
    return static_cast<std::size_t>(parsed.value);
  }

  bool is_real() const { return type_.find("complex") == std::string::npos; }

  void read_extent() {
    rows_ = columns_ = 0;
    if (!lines_.next_of_words()) return;
    std::vector<string_view> extent;
    split_fields(lines_.line(), ' ', extent);
    std::erase(extent, string_view());
    if (extent.size() == 2) rows_ = count(extent[0]), columns_ = count(extent[1]);
  }

  void read_matrix() {
    if (!is_real() || type_.find("matrix") == std::string::npos || rows_ * columns_ == 0) return;
    signals_.announce(name_, {rows_, columns_});
    const std::size_t size = rows_ * columns_;
    std::vector<double> read;
    bool by_rows = false;
    while (read.size() < size && lines_.next_of_words()) {
      if (lines_.line().starts_with('#')) break;
      const std::size_t before = read.size();
      lines_.take_numbers(read);
      by_rows = by_rows || read.size() - before > 1;
    }
    if (read.size() != size)
      throw lines_.bad(fmt::format("'{}' holds {} numbers; expected {}, as its rows and columns state", name_,
                                   read.size(), size));
    std::vector<double> values(size);
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t column = 0; column < columns_; ++column)
        values[row + column * rows_] = by_rows ? read[row * columns_ + column] : read[row + column * rows_];
    constexpr int digits = 15;
    signals_.add_variable(name_, std::move(values), rows_, columns_, digits);
  }

  void read_range() {
    std::vector<double> range;
    if (lines_.next_of_words()) lines_.take_numbers(range);
    if (range.size() < 3 || !(range[2] != 0.0)) return;
    constexpr double slack = 1e-9, most = 1e9;
    const double steps = std::floor((range[1] - range[0]) / range[2] * (1.0 + slack));
    if (!(steps >= 1.0 && steps < most)) return;
    signals_.announce(name_, {static_cast<std::size_t>(steps) + 1});
    std::vector<double> values;
    for (double k = 0.0; k <= steps; ++k) values.push_back(range[0] + k * range[2]);
    signals_.add(name_, "", std::move(values), 15);
  }

  /// A number or a text alone.
  void read_single() {
    if (type_.ends_with("string")) signals_.add_text(name_, std::string(trimmed(lines_.line())));
    const ParsedNumber parsed = parse_number(trimmed(lines_.line()));
    if (type_.ends_with("scalar") && is_real() && parsed.finite) signals_.set(name_, parsed.value);
  }

  VariableLines& lines_;
  CollectedSignals& signals_;
  std::string name_, type_;
  std::size_t rows_ = 0, columns_ = 0;
};

class OctaveReader final : public RecordReader {
 public:
  bool recognises(string_view beginning) const override {
    return beginning.starts_with("# Created by Octave") ||
           (beginning.starts_with("# name: ") && beginning.find("# type: ") != beginning.npos);
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const override {
    const std::string text = read_text(file, "a text of Octave");
    CollectedSignals signals(file.string(), text.size() + 64);
    VariableLines lines(file.string(), text);
    OctaveVariables(lines, signals).read();
    return signals.table(format);
  }
};

const bool octave_registered =
    record_reader_registry().add({"octave",
                                  "text of Octave's save: matrices, ranges, scalars and texts beside them",
                                  "",
                                  {},
                                  {},
                                  [](const filters::Options&) { return std::make_unique<OctaveReader>(); }});

}  // namespace
}  // namespace beamid::experiments
