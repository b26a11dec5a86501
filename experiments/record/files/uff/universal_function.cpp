#include "experiments/record/files/uff/universal_function.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/record/files/uff/universal_numbers.hpp"

namespace beamid::experiments {
namespace {

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

}  // namespace

std::vector<UniversalFunction> read_universal_functions(const std::string& name, const std::string& bytes) {
  UniversalLines lines(name, bytes);
  std::vector<UniversalFunction> all;
  while (lines.next()) {
    if (trimmed(lines.line()) != "-1") continue;
    if (!lines.next()) break;
    const std::string_view word =
        trimmed(lines.line().substr(0, std::min<std::size_t>(6, lines.line().size())));
    if (word == "-1") {  // an end without a beginning begins the next set
      lines.back();
      continue;
    }
    if (word != "58") {
      lines.skip_dataset();
      continue;
    }
    all.push_back(read_function(lines));
  }
  return all;
}

}  // namespace beamid::experiments
