#include "experiments/record/files/uff/universal_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace beamid::experiments {
namespace {

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

}  // namespace

std::vector<double> read_binary_numbers(UniversalLines& lines, const UniversalFunction& function,
                                        bool big_endian, long long stated) {
  const std::string_view ahead = lines.ahead();
  const std::size_t width = function.single() ? 4 : 8, count = function.numbers(), bytes = width * count;
  if (bytes > ahead.size())
    lines.fail(fmt::format("{} bytes left; expected {} for {} points", ahead.size(), bytes, function.points));
  std::vector<double> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    unsigned char raw[8];
    std::memcpy(raw, ahead.data() + i * width, width);
    if (big_endian != (std::endian::native == std::endian::big)) std::reverse(raw, raw + width);
    if (function.single()) {
      float value;
      std::memcpy(&value, raw, width);
      numbers[i] = static_cast<double>(value);
    } else {
      std::memcpy(&numbers[i], raw, width);
    }
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

}  // namespace beamid::experiments
