#include "experiments/record/sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "experiments/signal/median.hpp"

namespace beamid::experiments {
namespace {

constexpr const char* too_coarse = " (times printed this coarsely need record.sampling_rate_hz)";

}  // namespace

void PrintedPrecision::add(std::string_view token) {
  int decimals = 0, digits = 0, exponent = 0;
  bool point = false;
  for (std::size_t i = 0; i < token.size(); ++i) {
    if (token[i] == '.') {
      point = true;
    } else if (token[i] == 'e' || token[i] == 'E') {
      const std::size_t start = i + (token.substr(i + 1).starts_with('+') ? 2 : 1);
      std::from_chars(token.data() + start, token.data() + token.size(), exponent);
      break;
    } else if (token[i] >= '0' && token[i] <= '9') {
      decimals += point ? 1 : 0;
      digits += digits > 0 || token[i] != '0' ? 1 : 0;
    }
  }
  decimals_ = std::max(decimals_, decimals - exponent);
  digits_ = std::max(digits_, digits);
}

PrintedPrecision PrintedPrecision::of_digits(int digits) {
  PrintedPrecision precision;
  precision.decimals_ = 400;
  precision.digits_ = digits;
  return precision;
}

double PrintedPrecision::resolution(double value) const {
  const double fixed = std::pow(10.0, -decimals_);
  if (value == 0) return fixed;
  return std::max(fixed, std::pow(10.0, std::floor(std::log10(std::abs(value))) + 1 - digits_));
}

std::optional<SamplingFault> find_order_fault(const std::vector<double>& times) {
  const auto later = [&](std::size_t i) { return times[i] > times[i - 1]; };
  std::size_t i = 1;
  while (i < times.size() && later(i)) ++i;
  if (i >= times.size()) return std::nullopt;
  std::size_t equal = 0;
  for (std::size_t j = 1; j < times.size(); ++j) equal += times[j] == times[j - 1] ? 1 : 0;
  const bool coarse = 2 * equal > times.size();  // the seconds of a clock, printed without their decimals
  return SamplingFault{i, fmt::format("time {} after {}; expected increasing times{}", times[i], times[i - 1],
                                      coarse ? too_coarse : "")};
}

std::optional<SamplingFault> find_sampling_fault(const std::vector<double>& times,
                                                 const PrintedPrecision& precision) {
  if (auto fault = find_order_fault(times)) return fault;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times.size(); ++i) intervals.push_back(times[i] - times[i - 1]);
  if (intervals.empty()) return std::nullopt;
  const double usual = median(intervals);
  constexpr double tolerated = 0.05, slack = 1 + 1e-6;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double deviation = std::abs(intervals[i - 1] - usual);
    if (deviation <= tolerated * usual) continue;
    const double rounding = std::max(precision.resolution(times[i]), precision.resolution(times[i - 1]));
    const bool coarse = rounding > 0.5 * usual * slack;  // a missing sample would look the same
    if (coarse || deviation > (tolerated * usual + rounding) * slack)
      return SamplingFault{
          i, fmt::format(
                 "time {} after {}, an interval of {:.6g}; expected the median interval {:.6g} within 5 %{}",
                 times[i], times[i - 1], intervals[i - 1], usual, coarse ? too_coarse : "")};
  }
  return std::nullopt;
}

}  // namespace beamid::experiments
