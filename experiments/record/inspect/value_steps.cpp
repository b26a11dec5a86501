#include "experiments/record/inspect/value_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beamid::experiments {

ValueSteps::ValueSteps(const std::vector<double>& signal) {
  std::vector<double> sorted;
  for (const double value : signal)
    if (std::isfinite(value)) sorted.push_back(value);
  std::sort(sorted.begin(), sorted.end());
  if (sorted.empty()) return;
  const double same = 1e-12 * std::max(std::abs(sorted.front()), std::abs(sorted.back()));
  for (const double value : sorted) {
    if (values_.empty() || value > values_.back() + same) values_.push_back(value), counts_.push_back(0);
    ++counts_.back();
  }
}

std::size_t ValueSteps::place(double value) const {
  const auto above = std::upper_bound(values_.begin(), values_.end(), value);
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, above - values_.begin() - 1));
}

double ValueSteps::near(double value) const {
  constexpr std::size_t reach = 8;
  const std::size_t at = place(value), from = at - std::min(at, reach),
                    to = std::min(at + reach + 1, values_.size());
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = from + 1; i < to; ++i) step = std::min(step, values_[i] - values_[i - 1]);
  return step;
}

std::size_t ValueSteps::count(double value) const {
  return values_.empty() ? 0 : counts_[std::min(place(value), values_.size() - 1)];
}

std::size_t ValueSteps::most_frequent_beside(double value) const {
  constexpr std::size_t looked_at = 8;
  if (values_.size() <= looked_at) return 0;
  const auto first = value == values_.front() ? counts_.begin() + 1
                                              : counts_.end() - 1 - static_cast<std::ptrdiff_t>(looked_at);
  return *std::max_element(first, first + static_cast<std::ptrdiff_t>(looked_at));
}

}  // namespace beamid::experiments
