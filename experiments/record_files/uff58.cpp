// Universal File Format, dataset 58, "function at nodal degree of freedom": ASCII and binary (58b).
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "experiments/input/fields.hpp"
#include "experiments/input/record_reader.hpp"
#include "experiments/input/text_file.hpp"

namespace beamid::experiments {
namespace {

using std::string_view;

/// A dataset's header, records 6 to 9, and its samples.
struct Function {
  int type = 0, node = 0, direction = 0, ordinate = 0, kind = 0;
  std::string identity, label, unit;
  std::size_t points = 0;
  bool even = true;
  double start = 0.0, step = 0.0;
  std::vector<double> abscissa, values;
};

class UniversalFile {
 public:
  UniversalFile(std::string name, const std::string& bytes) : name_(std::move(name)), bytes_(bytes) {}

  std::vector<Function> functions() {
    std::vector<Function> all;
    while (next_line()) {
      if (trimmed(line_) != "-1") continue;
      if (!next_line()) break;
      const string_view word = trimmed(line_.substr(0, std::min<std::size_t>(6, line_.size())));
      if (word == "-1") {  // an end without a beginning begins the next set
        at_ = line_begin_, --number_;
        continue;
      }
      if (word != "58") {
        skip_dataset();
        continue;
      }
      all.push_back(read_function());
    }
    return all;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError({name_, number_, 0}, message); }

  bool next_line() {
    if (at_ >= bytes_.size()) return false;
    line_begin_ = at_;
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    line_ = string_view(bytes_).substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    at_ = end + 1;
    ++number_;
    return true;
  }

  void skip_dataset() {
    while (next_line())
      if (trimmed(line_) == "-1") return;
  }

  string_view field(std::size_t from, std::size_t width) const {
    return from < line_.size() ? trimmed(line_.substr(from, width)) : string_view();
  }

  long long whole(std::size_t from, std::size_t width, const char* what) const {
    const string_view text = field(from, width);
    long long value = 0;
    const char* const end = text.data() + text.size();
    if (text.empty()) return 0;
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || rest != end)
      throw InputError({name_, number_, from + 1},
                       fmt::format("'{}'; expected {}, a whole number", text, what));
    return value;
  }

  double real(std::size_t from, std::size_t width, const char* what) const {
    const string_view text = field(from, width);
    if (text.empty()) return 0.0;
    const ParsedNumber parsed = parse(text);
    if (!parsed.finite)
      throw InputError({name_, number_, from + 1}, fmt::format("'{}'; expected {}, a number", text, what));
    return parsed.value;
  }

  /// Fortran writes exponents with E or D.
  static ParsedNumber parse(string_view text) {
    std::string plain(text);
    for (char& letter : plain) letter = letter == 'D' || letter == 'd' ? 'e' : letter;
    return parse_number(plain);
  }

  void header_line(const char* what) {
    if (!next_line() || trimmed(line_) == "-1") fail(fmt::format("the dataset ends; expected {}", what));
  }

  Function read_function() {
    Function function;
    const bool binary = line_.size() > 6 && (line_[6] == 'b' || line_[6] == 'B');
    const long long order = binary ? whole(7, 6, "the byte order") : 0;
    const long long stated_bytes = binary ? whole(31, 12, "the number of bytes") : 0;
    if (binary && whole(13, 6, "the floating-point format") != 2)
      fail("floating-point format of another machine; expected 2, IEEE 754");
    for (int id = 1; id <= 5; ++id) {
      header_line("five lines of identification");
      if (id == 1) function.identity = trimmed(line_);
    }
    header_line("record 6, the degree of freedom");
    function.type = static_cast<int>(whole(0, 5, "the function's type"));
    function.node = static_cast<int>(whole(41, 10, "the response node"));
    function.direction = static_cast<int>(whole(51, 4, "the response direction"));
    header_line("record 7, the form of the data");
    function.ordinate = static_cast<int>(whole(0, 10, "the ordinate's data type"));
    const long long points = whole(10, 10, "the number of points");
    function.even = whole(20, 10, "the abscissa's spacing") == 1;
    function.start = real(30, 13, "the abscissa's minimum");
    function.step = real(43, 13, "the abscissa's increment");
    if (function.ordinate != 2 && function.ordinate != 4 && function.ordinate != 5 && function.ordinate != 6)
      fail(fmt::format("ordinate data type {}; expected 2 or 4 (real), 5 or 6 (complex)", function.ordinate));
    if (points < 0 || static_cast<unsigned long long>(points) > bytes_.size())
      fail(fmt::format("{} points in a file of {} bytes; expected a number it can hold", points,
                       bytes_.size()));
    function.points = static_cast<std::size_t>(points);
    header_line("record 8, the abscissa");
    header_line("record 9, the ordinate");
    function.kind = static_cast<int>(whole(0, 10, "the ordinate's kind"));
    function.label = field(26, 20);
    function.unit = field(47, 20);
    header_line("record 10, the ordinate's denominator");
    header_line("record 11, the z axis");
    std::vector<double> numbers =
        binary ? read_binary(function, order == 2, stated_bytes) : read_ascii(function);
    share_out(function, std::move(numbers));
    return function;
  }

  static std::size_t numbers_of(const Function& function) {
    return function.points * ((function.ordinate > 4 ? 2u : 1u) + (function.even ? 0u : 1u));
  }

  /// Abscissae of uneven data are in the precision of the ordinate when binary.
  std::vector<double> read_binary(const Function& function, bool big_endian, long long stated) {
    const bool single = function.ordinate == 2 || function.ordinate == 5;
    const std::size_t width = single ? 4 : 8, count = numbers_of(function), bytes = width * count;
    if (at_ > bytes_.size() || bytes > bytes_.size() - at_)
      fail(fmt::format("{} bytes left; expected {} for {} points",
                       bytes_.size() - std::min(at_, bytes_.size()), bytes, function.points));
    std::vector<double> numbers(count);
    for (std::size_t i = 0; i < count; ++i) {
      unsigned char raw[8];
      std::memcpy(raw, bytes_.data() + at_ + i * width, width);
      if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw, raw + width);
      if (single) {
        float value;
        std::memcpy(&value, raw, width);
        numbers[i] = static_cast<double>(value);
      } else {
        std::memcpy(&numbers[i], raw, width);
      }
    }
    const std::size_t said = stated > 0 ? static_cast<std::size_t>(stated) : bytes;
    at_ += std::max(bytes, said <= bytes_.size() - at_ ? said : bytes);
    if (at_ < bytes_.size() && (bytes_[at_] == '\n' || bytes_[at_] == '\r')) next_line();
    if (next_line() && trimmed(line_) != "-1") skip_dataset();
    return numbers;
  }

  /// Fields are blank-parted in what every program writes, but negative numbers may touch: widths decide
  /// then.
  std::vector<double> read_ascii(const Function& function) {
    const std::size_t count = numbers_of(function);
    std::vector<double> numbers;
    while (numbers.size() < count) {
      if (!next_line())
        fail(fmt::format("the file ends after {} numbers; expected {}", numbers.size(), count));
      if (trimmed(line_) == "-1" && numbers.size() + 1 != count)
        fail(fmt::format("the dataset ends after {} numbers; expected {}", numbers.size(), count));
      std::vector<string_view> words;
      split_fields(line_, ' ', words);
      for (const string_view word : words) {
        const ParsedNumber parsed = parse(word);
        if (!parsed.number) {
          take_fixed(function, numbers);
          break;
        }
        numbers.push_back(parsed.finite ? parsed.value : std::numeric_limits<double>::quiet_NaN());
        if (numbers.size() == count) break;
      }
    }
    while (next_line() && trimmed(line_) != "-1") {
      if (!trimmed(line_).empty())
        fail(fmt::format("more than {} numbers; expected the dataset's end, -1", count));
    }
    return numbers;
  }

  /// A line in the columns of the format: E13.5 in single precision and for abscissae, else E20.12.
  void take_fixed(const Function& function, std::vector<double>& numbers) const {
    const bool single = function.ordinate == 2 || function.ordinate == 5;
    const std::size_t group = (function.ordinate > 4 ? 2u : 1u) + (function.even ? 0u : 1u);
    numbers.resize(numbers.size() / group * group);
    std::size_t from = 0;
    for (std::size_t k = 0; from < line_.size(); ++k) {
      const bool abscissa = !function.even && k % group == 0;
      const std::size_t width = single || abscissa ? 13 : 20;
      const string_view text = field(from, width);
      if (text.empty()) break;
      const ParsedNumber parsed = parse(text);
      if (!parsed.finite)
        throw InputError({name_, number_, from + 1}, fmt::format("'{}'; expected a number", text));
      numbers.push_back(parsed.value);
      from += width;
    }
  }

  static void share_out(Function& function, std::vector<double> numbers) {
    if (function.ordinate > 4) return;  // complex: no history
    if (function.even) {
      function.values = std::move(numbers);
      return;
    }
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
      function.abscissa.push_back(numbers[i]);
      function.values.push_back(numbers[i + 1]);
    }
  }

  std::string name_;
  const std::string& bytes_;
  std::size_t at_ = 0, line_begin_ = 0, number_ = 0;
  string_view line_;
};

/// Node and direction, "12:+Z"; the identification line where there is no node.
std::string name_of(const Function& function) {
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
std::string unit_of(const Function& function) {
  return function.unit == "NONE" ? "" : function.unit;
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

  RecordTable read(const std::filesystem::path& file, const RecordFormat&) const override {
    const std::string bytes = read_bytes(file, "a Universal File");
    RecordTable table;
    table.file = file.string();
    std::size_t others = 0;
    const Function* first = nullptr;
    const std::vector<Function> functions = UniversalFile(table.file, bytes).functions();
    const auto is_history = [](const Function& f) { return f.type <= 1 && f.ordinate <= 4 && f.points > 0; };
    for (const Function& function : functions) {
      if (!is_history(function)) {
        ++others;
        continue;
      }
      if (first == nullptr) {
        first = &function;
        begin(table, function);
      }
      check_same_instants(table.file, *first, function);
      std::string name = name_of(function), unique = name;
      for (int copy = 2; std::find(table.names.begin(), table.names.end(), unique) != table.names.end();
           ++copy)
        unique = fmt::format("{} ({})", name, copy);
      table.names.push_back(unique);
      table.units.push_back(unit_of(function));
      table.columns.push_back(function.values);
      table.precision.push_back(PrintedPrecision::of_digits(15));
    }
    if (first == nullptr)
      throw InputError({table.file}, fmt::format("no real time response among {} datasets 58; expected one",
                                                 functions.size()));
    if (others > 0)
      table.remarks.push_back(fmt::format("{} dataset{} 58 that {} no real time response {} passed over.",
                                          others, others == 1 ? "" : "s", others == 1 ? "is" : "are",
                                          others == 1 ? "is" : "are"));
    return table;
  }

 private:
  static void begin(RecordTable& table, const Function& function) {
    if (function.even) {
      if (!(function.step > 0))
        throw InputError({table.file},
                         fmt::format("abscissa increment {}; expected a positive one", function.step));
      table.clock = {function.start, function.step};
      return;
    }
    table.names.emplace_back("time"), table.units.emplace_back("s");
    table.columns.push_back(function.abscissa);
    table.precision.push_back(PrintedPrecision::of_digits(6));  // of E13.5
    table.time = 0;
  }

  static void check_same_instants(const std::string& file, const Function& first, const Function& other) {
    if (first.even != other.even || first.points != other.points || first.start != other.start ||
        first.step != other.step || first.abscissa != other.abscissa)
      throw InputError(
          {file}, fmt::format("'{}' and '{}' are sampled at different instants; expected the same for all",
                              name_of(first), name_of(other)));
  }
};

const bool registered = record_reader_registry().add(
    {"uff58",
     "Universal File Format, dataset 58: time responses in ASCII or binary",
     "",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<UniversalFileReader>(); }});

}  // namespace
}  // namespace beamid::experiments
