// Universal File Format, dataset 58, "function at nodal degree of freedom": ASCII and binary (58b).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "experiments/record/files/uff/universal_function.hpp"
#include "experiments/record/record_reader.hpp"
#include "experiments/record/time_unit.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/text_file.hpp"

namespace beamid::experiments {
namespace {

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
    table.names.emplace_back("time"), table.units.push_back(unit.empty() || factor == 1.0 ? "s" : unit);
    table.columns.push_back(function.abscissa);
    table.precision.push_back(PrintedPrecision::of_digits(6));  // of E13.5
    if (factor == 1.0) table.time = 0;                          // else found by its unit
  }

  static void check_same_instants(const std::string& file, const UniversalFunction& first,
                                  const UniversalFunction& other) {
    if (first.even != other.even || first.points != other.points || first.start != other.start ||
        first.step != other.step || first.abscissa_unit != other.abscissa_unit ||
        first.abscissa != other.abscissa)
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
