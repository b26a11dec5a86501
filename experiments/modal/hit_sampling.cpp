#include "experiments/modal/hit_sampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;

/// How far samples beside the pulse lie below zero and below the mean of those farther away, at most: a
/// sensor with alternating-current coupling is below zero for long.
double ringing(const VectorXd& pulse, Index peak) {
  constexpr Index beside = 8;
  double most = 0;
  for (const Index step : {-1, 1}) {
    const auto inside = [&](Index i) { return i >= 0 && i < pulse.size(); };
    Index edge = peak;
    while (inside(edge) && pulse[edge] > 0) edge += step;
    double farther = 0, lowest = 0;
    for (Index i = 0; i < 2 * beside && inside(edge + step * i); ++i) {
      const double value = pulse[edge + step * i];
      if (i < beside)
        lowest = std::min(lowest, value);
      else
        farther += value / beside;
    }
    most = std::max(most, std::min(-lowest, farther - lowest));
  }
  return most;
}

/// Standard deviation of what the channel shows between hits, from the median distance to its median.
double noise_between_hits(const VectorXd& force) {
  constexpr double of_normal = 0.6745;
  return median(VectorXd((force.array() - median(force)).abs())) / of_normal;
}

}  // namespace

HitSampling hit_sampling(const VectorXd& force, const Hit& hit) {
  constexpr double of_half_sine = 0.3, lowest_line = 0.3, highest_line = 0.5;
  constexpr Index around = 24;
  constexpr int lines = 9;
  const Index begin = std::max<Index>(0, hit.onset - around),
              end = std::min<Index>(force.size(), hit.end + around);
  Index peak = 0;
  hit.force.segment(begin, end - begin).cwiseAbs().maxCoeff(&peak);
  const double signed_peak = hit.force[begin + peak];
  const VectorXd all = (force.segment(begin, end - begin).array() - median(force)) / signed_peak,
                 own = hit.force.segment(begin, end - begin) / signed_peak;
  HitSampling found;
  found.noise_n = noise_between_hits(force);
  found.noise = found.noise_n / std::abs(signed_peak);
  found.above_half = static_cast<double>((own.array() > 0.5).count());
  found.ringing = ringing(all, peak);
  const double sum = own.sum();
  const double centre =
      own.dot(VectorXd::LinSpaced(own.size(), 0, static_cast<double>(own.size() - 1))) / sum;
  found.place = centre - std::floor(centre);
  double power = 0;
  for (int line = 0; line < lines; ++line) {
    const double turn =
        2 * std::numbers::pi * (lowest_line + (highest_line - lowest_line) * line / (lines - 1));
    Complex transformed = 0;
    for (Index i = 0; i < own.size(); ++i)
      transformed += own[i] * std::polar(1.0, -turn * static_cast<double>(i));
    power += std::norm(transformed) / lines;
  }
  power -= found.noise * found.noise * static_cast<double>((own.array() != 0).count());
  found.aliased = of_half_sine * std::sqrt(std::max(0.0, power)) / std::abs(sum);
  return found;
}

bool hits_ring(const std::vector<HitSampling>& hits) {
  constexpr double least = 0.01, lowest_of_noise = 1.8, more_of_one_hit = 2.2;
  double swings = 0, needed = 0;
  for (const HitSampling& hit : hits) {
    swings += hit.ringing;
    needed += std::max(
        least, hit.noise * (lowest_of_noise + more_of_one_hit / std::sqrt(static_cast<double>(hits.size()))));
  }
  return swings > needed;
}

double unresolved_at_once(const std::vector<HitSampling>& hits) {
  if (hits.empty() || hits_ring(hits)) return 0;
  double squares = 0;
  for (const HitSampling& hit : hits) squares += hit.aliased * hit.aliased;
  return std::sqrt(squares / static_cast<double>(hits.size()));
}

double unresolved_on_average(const std::vector<HitSampling>& hits) {
  if (hits.empty()) return 0;
  Complex together = 0;
  for (const HitSampling& hit : hits) together += std::polar(1.0, 2 * std::numbers::pi * hit.place);
  const double count = static_cast<double>(hits.size()), squared = std::norm(together) / (count * count);
  constexpr double chance = 3, together_surely = 0.9;  // places at random exceed 3 / m in one of e^3 records
  constexpr double worst_place = 1.5;
  if (squared >= std::min(together_surely, chance / count)) return unresolved_at_once(hits);
  return unresolved_at_once(hits) / (worst_place * std::sqrt(count));
}

std::string coarse_hits(const std::vector<HitSampling>& hits, double interval) {
  if (hits.empty()) return "";
  const double off = unresolved_at_once(hits);
  if (!(off > coarse_momentum)) return "";
  double longest = 0;
  for (const HitSampling& hit : hits) longest = std::max(longest, hit.above_half);
  return fmt::format(
      "At most {:.0f} sample{} of a hit lie{} above half of its largest force, and the record beside the "
      "pulse shows no anti-alias filter. Without one the momentum of each hit, and with it the mass, is off "
      "by about {:.2g} %. With one that does not ring, or whose ringing the noise hides, it is right. {} A "
      "softer tip, a filter or more than {:.3g} samples per second make it certain.",
      longest, longest > 1 ? "s" : "", longest > 1 ? "" : "s", 100 * off,
      off > lost_momentum ? "No mass is given; frequencies and damping do not depend on it."
                          : "The standard deviations of the masses hold that.",
      8 / std::max(1.0, 1.5 * longest) / interval);
}

}  // namespace beamid::experiments
