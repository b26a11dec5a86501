// Numbers and texts that are to be the same on every machine, up to rounding.
#pragma once

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace beamid::docs {

struct Tolerance {
  double relative = 1e-6;
  double absolute = 1e-12;  ///< below it a number is zero but for rounding

  bool holds(double golden, double found) const {
    return std::isnan(golden) ? std::isnan(found)
                              : golden == found || std::abs(found - golden) <=
                                                       std::max(absolute, relative * std::abs(golden));
  }
};

/// One unit of the last digit that is printed: 0.01 for "-3.14", 1e-7 for "1.2e-06", 0 for "12".
inline double last_digit(const std::string& number) {
  const std::size_t point = number.find('.'), exponent = number.find_first_of("eE");
  if (point == std::string::npos && exponent == std::string::npos) return 0;
  const auto end = std::min(exponent, number.size());
  const double decimals = point == std::string::npos ? 0 : double(end - point - 1);
  return std::pow(10.,
                  (exponent == std::string::npos ? 0 : std::stoi(number.substr(exponent + 1))) - decimals);
}

/// Whether two lines say the same: the words exactly, numbers with a decimal point or an exponent to `digits`
/// units of the last digit printed or within `tolerance`, counts exactly, spaces and ruled lines of any
/// length.
inline bool same_line(const std::string& golden, const std::string& found, double digits,
                      Tolerance tolerance) {
  static const std::regex token(R"([+-]?[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?|-{2,}|={2,}|\S)");
  std::sregex_iterator one(golden.begin(), golden.end(), token), other(found.begin(), found.end(), token),
      end;
  for (; one != end && other != end; ++one, ++other) {
    const std::string first = one->str(), second = other->str();
    const bool ruled = first.size() > 1 && (first.substr(0, 2) == "--" || first.substr(0, 2) == "==");
    if (first == second || (ruled && second.substr(0, 2) == first.substr(0, 2))) continue;
    if (!std::isdigit(first.back()) || !std::isdigit(second.back())) return false;
    const double unit = digits * std::max(last_digit(first), last_digit(second)),
                 difference = std::abs(std::stod(first) - std::stod(second));
    if (unit == 0 || (difference > 1.001 * unit && !tolerance.holds(std::stod(first), std::stod(second))))
      return false;
  }
  return one == end && other == end;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace beamid::docs
