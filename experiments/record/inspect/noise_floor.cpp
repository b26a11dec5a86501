
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <unsupported/Eigen/FFT>

#include "experiments/record/inspect/defects.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Variances of white noise with the periodograms that windows of the signal have.
class WhiteVariance {
 public:
  explicit WhiteVariance(Index size) : place_(VectorXd::LinSpaced(size, -1, 1)), taper_(size) {
    const double turn = 2 * std::numbers::pi / static_cast<double>(size);
    for (Index k = 0; k < size; ++k) {
      taper_[k] = 1 - std::cos(turn * (static_cast<double>(k) + 0.5));
      taper_squares_ += taper_[k] * taper_[k];
    }
    tapered_.resize(static_cast<std::size_t>(size));
  }

  double of(const VectorXd& window) {
    const double slope = place_.dot(window) / place_.squaredNorm(), mean = window.mean();
    for (Index k = 0; k < window.size(); ++k)
      tapered_[static_cast<std::size_t>(k)] = taper_[k] * (window[k] - mean - slope * place_[k]);
    transform_.fwd(spectrum_, tapered_);
    std::vector<double> powers;
    for (Index k = window.size() / 8; k < 3 * window.size() / 8; ++k)
      powers.push_back(std::norm(spectrum_[static_cast<std::size_t>(k)]));
    return quantile(std::move(powers), 0.5) / std::numbers::ln2 / taper_squares_;
  }

 private:
  VectorXd place_, taper_;
  double taper_squares_ = 0.0;
  std::vector<double> tapered_;
  std::vector<std::complex<double>> spectrum_;
  Eigen::FFT<double> transform_;
};

}  // namespace

double noise_floor(const VectorXd& signal) {
  constexpr Index longest = 512, fewest = 64;
  if (signal.size() < fewest)
    throw std::invalid_argument("signal of " + std::to_string(signal.size()) +
                                " samples; expected at least 64 to find its noise");
  Index size = longest;
  while (size > signal.size()) size /= 2;
  WhiteVariance white(size);
  std::vector<double> variances;
  for (Index begin = 0; begin + size <= signal.size(); begin += size)
    variances.push_back(white.of(signal.segment(begin, size)));
  return std::sqrt(quantile(variances, 0.25));
}

namespace {

// Rising as numbers do: all bits of a negative one turned, the sign of others set.
std::uint64_t ordered_bits(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

double value_of(std::uint64_t ordered) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  return std::bit_cast<double>((ordered & sign) != 0 ? ordered & ~sign : ~ordered);
}

// Sorts values, as ordered bits, by their digits, the last first: four times as fast as comparisons with a
// million of them.
void sort_keys(std::vector<std::uint64_t>& keys) {
  constexpr std::size_t few = 4096;
  if (keys.size() < few) return std::sort(keys.begin(), keys.end());
  constexpr int digit_bits = 11, digits = 6;
  constexpr std::size_t buckets = std::size_t{1} << digit_bits;
  std::vector<std::uint64_t> moved(keys.size());
  std::vector<std::array<std::size_t, buckets>> counts(digits);
  for (const std::uint64_t key : keys)
    for (int d = 0; d < digits; ++d)
      ++counts[static_cast<std::size_t>(d)][(key >> (d * digit_bits)) % buckets];
  for (int d = 0; d < digits; ++d) {
    auto& places = counts[static_cast<std::size_t>(d)];
    if (places[(keys[0] >> (d * digit_bits)) % buckets] == keys.size()) continue;  // all have this digit
    std::size_t next = 0;
    for (std::size_t& place : places) next += std::exchange(place, next);
    for (const std::uint64_t key : keys) moved[places[(key >> (d * digit_bits)) % buckets]++] = key;
    keys.swap(moved);
  }
}

}  // namespace

ValueSteps::ValueSteps(const std::vector<double>& signal) {
  std::vector<std::uint64_t> keys;
  keys.reserve(signal.size());
  for (const double value : signal)
    if (std::isfinite(value)) keys.push_back(ordered_bits(value));
  sort_keys(keys);
  if (keys.empty()) return;
  const double same = 1e-12 * std::max(std::abs(value_of(keys.front())), std::abs(value_of(keys.back())));
  values_.reserve(keys.size());
  counts_.reserve(keys.size());
  for (const std::uint64_t key : keys) {
    const double value = value_of(key);
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

namespace {

/// The least difference of a reading from the one before it, where they differ.
double smallest_step(const std::vector<double>& read) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < read.size(); ++k)
    if (read[k] != read[k - 1]) least = std::min(least, std::abs(read[k] - read[k - 1]));
  return least;
}

}  // namespace

bool is_dead(const std::vector<double>& samples) {
  constexpr double far_larger = 1e3, out_of_reach = 1e4, noise_only = 2;
  constexpr double few_steps = 8;  // of the resolution, where a slow quantity's digits flicker
  constexpr Index fewest = 64;
  const std::vector<double> read = finite(samples);
  if (read.empty() ||
      *std::max_element(read.begin(), read.end()) == *std::min_element(read.begin(), read.end()))
    return true;
  const Eigen::Map<const VectorXd> signal(read.data(), static_cast<Index>(read.size()));
  const double middle = median(read), power = (signal.array() - middle).square().mean();
  if (std::abs(middle) > out_of_reach * std::sqrt(power) &&
      std::sqrt(power) < few_steps * smallest_step(read))
    return true;
  if (signal.size() < fewest || !(std::abs(middle) > far_larger * std::sqrt(power))) return false;
  const double noise = noise_floor(signal);
  return power < noise_only * noise * noise;
}

}  // namespace beamid::experiments
