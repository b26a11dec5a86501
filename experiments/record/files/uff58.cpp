// Universal File Format, dataset 58, "function at nodal degree of freedom": ASCII and binary (58b).
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "experiments/record/files/universal_lines.hpp"
#include "experiments/record/record.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

// The lines of Universal Files (universal_lines.hpp).

void UniversalLines::fail(const std::string& message, std::size_t column) const {
  throw InputError({name_, number_, column}, message);
}

bool UniversalLines::next() {
  if (at_ >= bytes_.size()) return false;
  begin_ = at_;
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  line_ = std::string_view(bytes_).substr(at_, end - at_);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  at_ = end + 1;
  ++number_;
  return true;
}

void UniversalLines::next_of_header(const char* what) {
  if (!next() || trimmed(line_) == "-1") fail(fmt::format("the dataset ends; expected {}", what));
}

bool UniversalLines::next_dataset(int& number) {
  while (next()) {
    if (trimmed(line_) != "-1") continue;
    if (!next()) return false;
    std::string_view word = trimmed(line_.substr(0, std::min<std::size_t>(6, line_.size())));
    if (word == "-1") {  // an end without a beginning begins the next set
      back();
      continue;
    }
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) number = 0;
    return true;
  }
  return false;
}

void UniversalLines::skip_dataset() {
  while (next())
    if (trimmed(line_) == "-1") return;
}

std::string_view UniversalLines::field(std::size_t from, std::size_t width) const {
  return from < line_.size() ? trimmed(line_.substr(from, width)) : std::string_view();
}

long long UniversalLines::whole(std::size_t from, std::size_t width, const char* what) const {
  const std::string_view text = field(from, width);
  long long value = 0;
  const char* const end = text.data() + text.size();
  if (text.empty()) return 0;
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end)
    fail(fmt::format("'{}'; expected {}, a whole number", text, what), from + 1);
  return value;
}

double UniversalLines::real(std::size_t from, std::size_t width, const char* what) const {
  const std::string_view text = field(from, width);
  if (text.empty()) return 0.0;
  const ParsedNumber parsed = parse_fortran(text);
  if (!parsed.finite) fail(fmt::format("'{}'; expected {}, a number", text, what), from + 1);
  return parsed.value;
}

ParsedNumber parse_fortran(std::string_view text) {
  std::string plain(text);
  for (char& letter : plain) letter = letter == 'D' || letter == 'd' ? 'e' : letter;
  return parse_number(plain);
}

namespace {

// Dataset 58 of a Universal File, "function at nodal degree of freedom".

/// A dataset's header, records 6 to 9, and its samples.
struct UniversalFunction {
  int type = 0, node = 0, direction = 0, ordinate = 0, kind = 0;
  std::string identity, label, unit, abscissa_unit;
  std::size_t points = 0;
  bool even = true;
  double start = 0.0, step = 0.0;
  std::vector<double> abscissa, values;

  bool single() const { return ordinate == 2 || ordinate == 5; }  ///< precision
  bool complex() const { return ordinate > 4; }
  /// Of a point: the ordinate's parts, and its abscissa where they are uneven.
  std::size_t numbers_per_point() const { return (complex() ? 2u : 1u) + (even ? 0u : 1u); }
  std::size_t numbers() const { return points * numbers_per_point(); }
};

// The samples of a dataset 58, in text or binary.

/// A line in the columns of the format: E13.5 in single precision and for abscissae, else E20.12.
void take_fixed(const UniversalLines& lines, const UniversalFunction& function,
                std::vector<double>& numbers) {
  const std::size_t group = function.numbers_per_point();
  numbers.resize(numbers.size() / group * group);
  std::size_t from = 0;
  for (std::size_t k = 0; from < lines.line().size(); ++k) {
    const bool abscissa = !function.even && k % group == 0;
    const std::size_t width = function.single() || abscissa ? 13 : 20;
    const std::string_view text = lines.field(from, width);
    if (text.empty()) break;
    const ParsedNumber parsed = parse_fortran(text);
    if (!parsed.finite) lines.fail(fmt::format("'{}'; expected a number", text), from + 1);
    numbers.push_back(parsed.value);
    from += width;
  }
}

/// From behind the header to the dataset's end. Abscissae of uneven data are in the ordinate's precision.
/// @param stated number of bytes in the header; 0: none
std::vector<double> read_binary_numbers(UniversalLines& lines, const UniversalFunction& function,
                                        bool big_endian, long long stated) {
  const std::string_view ahead = lines.ahead();
  const std::size_t width = function.single() ? 4 : 8, count = function.numbers(), bytes = width * count;
  if (bytes > ahead.size())
    lines.fail(
        fmt::format("{} bytes remain; expected {} for {} points", ahead.size(), bytes, function.points));
  std::vector<double> numbers(count);
  const bool swapped = big_endian != (std::endian::native == std::endian::big);
  for (std::size_t i = 0; i < count; ++i) {
    const char* const at = ahead.data() + i * width;
    numbers[i] = function.single() ? static_cast<double>(number_of_bytes<float>(at, swapped))
                                   : number_of_bytes<double>(at, swapped);
  }
  const std::size_t said = stated > 0 ? static_cast<std::size_t>(stated) : bytes;
  lines.skip_bytes(std::max(bytes, said <= ahead.size() ? said : bytes));
  if (const std::string_view left = lines.ahead(); left.starts_with('\n') || left.starts_with('\r'))
    lines.next();
  if (lines.next() && trimmed(lines.line()) != "-1") lines.skip_dataset();
  return numbers;
}

/// Fields are blank-parted in what every program writes, but negative numbers may touch: widths decide
/// then.
std::vector<double> read_text_numbers(UniversalLines& lines, const UniversalFunction& function) {
  const std::size_t count = function.numbers();
  std::vector<double> numbers;
  while (numbers.size() < count) {
    if (!lines.next())
      lines.fail(fmt::format("the file ends after {} numbers; expected {}", numbers.size(), count));
    if (trimmed(lines.line()) == "-1" && numbers.size() + 1 != count)
      lines.fail(fmt::format("the dataset ends after {} numbers; expected {}", numbers.size(), count));
    std::vector<std::string_view> words;
    split_fields(lines.line(), ' ', words);
    for (const std::string_view word : words) {
      const ParsedNumber parsed = parse_fortran(word);
      if (!parsed.number) {
        take_fixed(lines, function, numbers);
        break;
      }
      numbers.push_back(parsed.finite ? parsed.value : std::numeric_limits<double>::quiet_NaN());
      if (numbers.size() == count) break;
    }
  }
  while (lines.next() && trimmed(lines.line()) != "-1") {
    if (!trimmed(lines.line()).empty())
      lines.fail(fmt::format("more than {} numbers; expected the dataset's end, -1", count));
  }
  return numbers;
}

void share_out(UniversalFunction& function, std::vector<double> numbers) {
  if (function.complex()) return;  // complex: no history
  if (function.even) {
    function.values = std::move(numbers);
    return;
  }
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
    function.abscissa.push_back(numbers[i]);
    function.values.push_back(numbers[i + 1]);
  }
}

UniversalFunction read_function(UniversalLines& lines) {
  UniversalFunction function;
  const bool binary = lines.line().size() > 6 && (lines.line()[6] == 'b' || lines.line()[6] == 'B');
  const long long order = binary ? lines.whole(7, 6, "the byte order") : 0;
  const long long stated_bytes = binary ? lines.whole(31, 12, "the number of bytes") : 0;
  if (binary && lines.whole(13, 6, "the floating-point format") != 2)
    lines.fail("floating-point format of another machine; expected 2, IEEE 754");
  for (int id = 1; id <= 5; ++id) {
    lines.next_of_header("five lines of identification");
    if (id == 1) function.identity = trimmed(lines.line());
  }
  lines.next_of_header("record 6, the degree of freedom");
  function.type = static_cast<int>(lines.whole(0, 5, "the function's type"));
  function.node = static_cast<int>(lines.whole(41, 10, "the response node"));
  function.direction = static_cast<int>(lines.whole(51, 4, "the response direction"));
  lines.next_of_header("record 7, the form of the data");
  function.ordinate = static_cast<int>(lines.whole(0, 10, "the ordinate's data type"));
  const long long points = lines.whole(10, 10, "the number of points");
  function.even = lines.whole(20, 10, "the abscissa's spacing") == 1;
  function.start = lines.real(30, 13, "the abscissa's minimum");
  function.step = lines.real(43, 13, "the abscissa's increment");
  if (function.ordinate != 2 && function.ordinate != 4 && function.ordinate != 5 && function.ordinate != 6)
    lines.fail(
        fmt::format("ordinate data type {}; expected 2 or 4 (real), 5 or 6 (complex)", function.ordinate));
  if (points < 0 || static_cast<unsigned long long>(points) > lines.size())
    lines.fail(
        fmt::format("{} points in a file of {} bytes; expected a number it can hold", points, lines.size()));
  function.points = static_cast<std::size_t>(points);
  lines.next_of_header("record 8, the abscissa");
  function.abscissa_unit = lines.field(47, 20);
  lines.next_of_header("record 9, the ordinate");
  function.kind = static_cast<int>(lines.whole(0, 10, "the ordinate's kind"));
  function.label = lines.field(26, 20);
  function.unit = lines.field(47, 20);
  lines.next_of_header("record 10, the ordinate's denominator");
  lines.next_of_header("record 11, the z axis");
  std::vector<double> numbers = binary ? read_binary_numbers(lines, function, order == 2, stated_bytes)
                                       : read_text_numbers(lines, function);
  share_out(function, std::move(numbers));
  return function;
}

/// All datasets 58 of a file; others are passed over. @throws InputError at what does not fit the format.
std::vector<UniversalFunction> read_universal_functions(const std::string& name, const std::string& bytes) {
  UniversalLines lines(name, bytes);
  std::vector<UniversalFunction> all;
  for (int number = 0; lines.next_dataset(number);)
    if (number == 58)
      all.push_back(read_function(lines));
    else
      lines.skip_dataset();
  return all;
}

using std::string_view;

/// Node and direction, "12:+Z"; the identification line where there is no node.
std::string uff58_name_of(const UniversalFunction& function) {
  static const char* const directions[] = {"", "X", "Y", "Z", "RX", "RY", "RZ"};
  const int direction = std::abs(function.direction);
  if (function.node == 0 || direction > 6) return function.identity;
  return fmt::format("{}{}{}{}", function.node, direction ? ":" : "",
                     function.direction < 0 ? "-"
                     : direction            ? "+"
                                            : "",
                     directions[direction]);
}

/// The label's unit; without one the dataset's kind of quantity in the file's own units, which are not known
/// here.
std::string stated(const std::string& unit) {
  return unit == "NONE" ? "" : unit;
}

class UniversalFileReader final : public RecordReader {
 public:
  bool recognises(string_view beginning) const override {
    std::size_t at = 0;
    while (at < beginning.size()) {
      const std::size_t end = std::min(beginning.find('\n', at), beginning.size());
      string_view line = beginning.substr(at, end - at);
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (!trimmed(line).empty()) return line.starts_with("    -1") && trimmed(line) == "-1";
      at = end + 1;
    }
    return false;
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const override {
    const std::string bytes = read_bytes(file, "a Universal File");
    RecordTable table;
    table.file = file.string();
    std::size_t others = 0;
    std::set<std::string> taken;
    std::map<std::string, int> copies;  // of each name: the last number given
    const UniversalFunction* first = nullptr;
    const std::vector<UniversalFunction> functions = read_universal_functions(table.file, bytes);
    const auto is_history = [](const UniversalFunction& f) {
      return f.type <= 1 && f.ordinate <= 4 && f.points > 0;
    };
    for (const UniversalFunction& function : functions) {
      if (!is_history(function)) {
        ++others;
        continue;
      }
      if (first == nullptr) {
        first = &function;
        begin(table, function, format);
      }
      check_same_instants(table.file, *first, function);
      const std::string name = uff58_name_of(function);
      std::string unique = name;
      for (int& copy = copies[name]; !taken.insert(unique).second;
           unique = fmt::format("{} ({})", name, copy))
        copy = std::max(copy + 1, 2);
      table.names.push_back(unique);
      table.units.push_back(stated(function.unit));
      table.columns.push_back(function.values);
      table.precision.push_back(PrintedPrecision::of_digits(15));
    }
    if (first == nullptr)
      throw InputError({table.file}, fmt::format("no real time response among {} datasets 58; expected one",
                                                 functions.size()));
    cut_to_common_part(table);
    if (others > 0)
      table.remarks.push_back(fmt::format("{} dataset{} 58 that {} no real time response {} passed over.",
                                          others, others == 1 ? "" : "s", others == 1 ? "is" : "are",
                                          others == 1 ? "is" : "are"));
    return table;
  }

 private:
  static void begin(RecordTable& table, const UniversalFunction& function, const RecordFormat& format) {
    const std::string unit = stated(function.abscissa_unit);
    const std::optional<double> factor =
        seconds_per(unit, "the abscissa of '" + uff58_name_of(function) + "'", table.file, format);
    if (function.even) {
      if (!(function.step > 0))
        throw InputError({table.file},
                         fmt::format("abscissa increment {}; expected a positive one", function.step));
      if (factor) table.clock = {function.start * *factor, function.step * *factor};
      return;
    }
    const bool in_seconds = factor && (*factor == 1.0 || !stated_unit(unit));  // converted here: minutes
    table.names.emplace_back("time"), table.units.push_back(in_seconds ? "s" : unit);
    std::vector<double>& times = table.columns.emplace_back(function.abscissa);
    table.precision.push_back(PrintedPrecision::of_digits(6));  // of E13.5
    if (!in_seconds) return;                                    // found by its unit
    for (double& time : times) time *= *factor;
    table.time = 0;
  }

  static void cut_to_common_part(RecordTable& table) {
    std::size_t shortest = table.columns.front().size(), longest = shortest;
    for (const auto& column : table.columns)
      shortest = std::min(shortest, column.size()), longest = std::max(longest, column.size());
    if (shortest == longest) return;
    table.warnings.push_back(fmt::format("The datasets have {} to {} samples; the first {} of each are used.",
                                         shortest, longest, shortest));
    for (auto& column : table.columns) column.resize(shortest);
  }

  static void check_same_instants(const std::string& file, const UniversalFunction& first,
                                  const UniversalFunction& other) {
    const auto both = std::min(first.abscissa.size(), other.abscissa.size());  // one may go on for longer
    if (first.even != other.even || first.start != other.start || first.step != other.step ||
        first.abscissa_unit != other.abscissa_unit ||
        !std::equal(first.abscissa.begin(), first.abscissa.begin() + static_cast<std::ptrdiff_t>(both),
                    other.abscissa.begin()))
      throw InputError(
          {file}, fmt::format("'{}' and '{}' are sampled at different instants; expected the same for all",
                              uff58_name_of(first), uff58_name_of(other)));
  }
};

const bool uff58_registered = record_reader_registry().add(
    {"uff58",
     "Universal File Format, dataset 58: time responses in ASCII or binary",
     "",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<UniversalFileReader>(); }});

}  // namespace

}  // namespace beamid::experiments
