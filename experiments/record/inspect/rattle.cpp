#include "experiments/record/inspect/rattle.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "experiments/signal/median.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

double lower_quartile(std::vector<double> values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Of one window: broadband power, its share in the band's mean, and how far the signal moves.
struct Window {
  double power = 0, flatness = 0, size = 0;
};

double blackman_harris(double turn) {
  return 0.35875 - 0.48829 * std::cos(turn) + 0.14128 * std::cos(2 * turn) - 0.01168 * std::cos(3 * turn);
}

std::vector<Window> windows_of(const VectorXd& signal, Index length) {
  VectorXd differences = signal;
  for (int order = 0; order < 4; ++order)
    differences =
        (differences.tail(differences.size() - 1) - differences.head(differences.size() - 1)).eval();
  Eigen::FFT<double> transform;
  std::vector<Window> windows;
  for (Index begin = 0; begin + length <= differences.size(); begin += length) {
    double taper_squares = 0;
    std::vector<double> tapered(static_cast<std::size_t>(length));
    for (Index k = 0; k < length; ++k) {
      const double turn = 2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(length),
                   taper = blackman_harris(turn);
      tapered[k] = taper * differences[begin + k];
      taper_squares += taper * taper;
    }
    std::vector<std::complex<double>> spectrum;
    transform.fwd(spectrum, tapered);
    std::vector<double> powers;
    double sum = 0;
    for (Index k = length / 8; k < 3 * length / 8; ++k) {
      const double turn = std::numbers::pi * static_cast<double>(k) / static_cast<double>(length),
                   gain = std::pow(2 * std::sin(turn), 8);  // of fourth differences
      powers.push_back(std::norm(spectrum[static_cast<std::size_t>(k)]) / gain / taper_squares);
      sum += powers.back();
    }
    Window window;
    window.power = lower_quartile(powers);
    window.flatness = window.power / std::max(sum / static_cast<double>(powers.size()), 1e-300);
    const auto part = signal.segment(begin, length).array();
    window.size = std::sqrt((part - part.mean()).square().mean());
    windows.push_back(window);
  }
  return windows;
}

}  // namespace

std::optional<Rattle> find_rattle(const VectorXd& signal, double step) {
  constexpr Index fewest = 1024, longest = 512, shortest = 64, windows_wanted = 16;
  constexpr double louder = 9, flat = 0.1, least = 1e-8, most = 0.01;  // of the motion's mean square
  constexpr std::size_t in_succession = 3;
  if (signal.size() < fewest) return {};
  const auto share = static_cast<std::size_t>(signal.size() / windows_wanted);
  const Index length = std::clamp<Index>(static_cast<Index>(std::bit_floor(share)), shortest, longest);
  const std::vector<Window> windows = windows_of(signal, length);
  std::vector<double> powers, quiet_sizes;
  for (const Window& window : windows) powers.push_back(window.power);
  const double rounding = std::log(4.0 / 3) * step * step / 12,  // the quartile of white noise as strong
      floor = std::max(lower_quartile(powers), rounding);
  if (!(floor > 0)) return {};
  const auto loud = [&](const Window& window) {
    const double motion = window.size * window.size;
    return window.power > std::max(louder * floor, least * motion) && window.power < most * motion &&
           window.flatness > flat;
  };
  for (const Window& window : windows)
    if (!loud(window)) quiet_sizes.push_back(window.size);
  if (quiet_sizes.empty()) return {};
  const double quiet = median(quiet_sizes);
  std::optional<Rattle> found;
  for (std::size_t first = 0, end = 0; first < windows.size(); first = end + 1) {
    std::vector<double> loud_powers;
    for (end = first; end < windows.size() && loud(windows[end]) && windows[end].size > quiet; ++end)
      loud_powers.push_back(windows[end].power);
    if (end - first < in_succession) continue;
    const auto samples = static_cast<std::size_t>(length);
    if (!found) found = Rattle{first * samples, 0, 1};
    found->last = end * samples - 1;
    found->ratio = std::max(found->ratio, std::sqrt(median(loud_powers) / floor));
  }
  return found;
}

}  // namespace beamid::experiments
