#include "experiments/modal/poles.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {

double Pole::frequency_hz() const {
  return std::abs(rate) / (2 * std::numbers::pi);
}

double Pole::damping_ratio() const {
  return std::abs(rate) > 0 ? -rate.real() / std::abs(rate) : 0;
}

void Pole::take_deviations(const Eigen::Matrix2d& covariance) {
  const double w_d = rate.imag(), d = -rate.real(), w = std::abs(rate);
  const Eigen::Vector2d frequency_slope = Eigen::Vector2d(w_d, d) / (2 * std::numbers::pi * w);
  const Eigen::Vector2d damping_slope = Eigen::Vector2d(-d * w_d, w_d * w_d) / (w * w * w);
  frequency_deviation_hz = std::sqrt(frequency_slope.dot(covariance * frequency_slope));
  damping_ratio_deviation = std::sqrt(damping_slope.dot(covariance * damping_slope));
}

double modal_assurance(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  const double product = a.squaredNorm() * b.squaredNorm();
  return product > 0 ? std::norm(a.dot(b)) / product : 0;
}

double phase_collinearity(const Eigen::VectorXcd& shape) {
  const double xx = shape.real().squaredNorm(), yy = shape.imag().squaredNorm(),
               xy = shape.real().dot(shape.imag()), sum = xx + yy;
  return sum > 0 ? ((xx - yy) * (xx - yy) + 4 * xy * xy) / (sum * sum) : 0;
}

namespace {

// Poles that are near each other.

using Eigen::Index;

/// 1 where two poles merge at the latest.
double distance(const Pole& a, const Pole& b, const StabilisationSettings& settings) {
  const double larger = std::max(a.frequency_hz(), b.frequency_hz());
  const double apart = std::abs(a.frequency_hz() - b.frequency_hz()) / larger;
  const double all =
      apart + 0.5 * std::abs(a.damping_ratio() - b.damping_ratio()) + 1 - modal_assurance(a.shape, b.shape);
  return all / std::max(settings.cluster_distance, settings.resolution_hz / larger);
}

/// Indices of the poles of each cluster. Two clusters merge while the mean distance between their poles,
/// |df| / f + |d damping ratio| / 2 + 1 - MAC, is below settings.cluster_distance, or below what
/// settings.resolution_hz is of their frequency.
std::vector<std::vector<std::size_t>> clusters_of(const std::vector<DiagramPole>& poles,
                                                  const StabilisationSettings& settings) {
  const auto count = static_cast<Index>(poles.size());
  Eigen::MatrixXd apart(count, count);
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j) apart(i, j) = distance(poles[i].pole, poles[j].pole, settings);
  std::vector<std::vector<std::size_t>> clusters(poles.size());
  for (std::size_t i = 0; i < poles.size(); ++i) clusters[i] = {i};
  std::vector<Index> alive(poles.size());
  for (Index i = 0; i < count; ++i) alive[i] = i;
  for (;;) {
    double nearest = 1;
    Index first = -1, second = -1;
    for (std::size_t a = 0; a < alive.size(); ++a)
      for (std::size_t b = a + 1; b < alive.size(); ++b)
        if (const double d = apart(alive[a], alive[b]); d < nearest) {
          nearest = d;
          first = alive[a];
          second = alive[b];
        }
    if (first < 0) break;
    const auto m = static_cast<double>(clusters[first].size()),
               n = static_cast<double>(clusters[second].size());
    for (const Index other : alive)  // average linkage by Lance and Williams
      apart(first, other) = apart(other, first) =
          (m * apart(first, other) + n * apart(second, other)) / (m + n);
    clusters[first].insert(clusters[first].end(), clusters[second].begin(), clusters[second].end());
    clusters[second].clear();
    alive.erase(std::find(alive.begin(), alive.end(), second));
  }
  std::erase_if(clusters, [](const auto& cluster) { return cluster.empty(); });
  return clusters;
}

Stability stability_of(const Pole& pole, const std::vector<Pole>& before,
                       const StabilisationSettings& settings) {
  Stability best = Stability::unstable;
  for (const Pole& other : before) {
    if (std::abs(pole.frequency_hz() - other.frequency_hz()) >
        settings.frequency_tolerance * pole.frequency_hz())
      continue;
    const bool full = std::abs(pole.damping_ratio() - other.damping_ratio()) <=
                          settings.damping_tolerance * std::abs(pole.damping_ratio()) &&
                      1 - modal_assurance(pole.shape, other.shape) <= settings.assurance_tolerance;
    best = std::max(best, full ? Stability::full : Stability::frequency);
  }
  return best;
}

/// The one value behind several: (value, deviation).
std::pair<double, double> merged_value(const std::vector<double>& values,
                                       const std::vector<double>& deviations) {
  double weight = 0, sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(deviations[i] > 0)) return {median(values), Pole::unknown};
    weight += 1 / (deviations[i] * deviations[i]);
    sum += values[i] / (deviations[i] * deviations[i]);
  }
  return {sum / weight, std::sqrt(static_cast<double>(values.size()) / weight)};
}

/// One pole of each order: the one nearest the median.
std::vector<const DiagramPole*> one_of_each_order(const std::vector<const DiagramPole*>& members) {
  std::vector<double> frequencies;
  for (const DiagramPole* member : members) frequencies.push_back(member->pole.frequency_hz());
  const double centre = median(frequencies);
  std::map<int, const DiagramPole*> chosen;
  for (const DiagramPole* member : members) {
    const DiagramPole*& best = chosen[member->order];
    if (!best ||
        std::abs(member->pole.frequency_hz() - centre) < std::abs(best->pole.frequency_hz() - centre))
      best = member;
  }
  std::vector<const DiagramPole*> result;
  for (const auto& [order, pole] : chosen) result.push_back(pole);
  return result;
}

Pole merged_pole(const std::vector<const DiagramPole*>& members) {
  std::vector<double> frequency, frequency_deviation, damping, damping_deviation;
  for (const DiagramPole* member : members) {
    frequency.push_back(member->pole.frequency_hz());
    frequency_deviation.push_back(member->pole.frequency_deviation_hz);
    damping.push_back(member->pole.damping_ratio());
    damping_deviation.push_back(member->pole.damping_ratio_deviation);
  }
  const auto [f, f_deviation] = merged_value(frequency, frequency_deviation);
  const auto [ratio, ratio_deviation] = merged_value(damping, damping_deviation);
  const DiagramPole* nearest =
      *std::min_element(members.begin(), members.end(), [f = f](const auto* a, const auto* b) {
        return std::abs(a->pole.frequency_hz() - f) < std::abs(b->pole.frequency_hz() - f);
      });
  Pole pole = nearest->pole;
  const double bounded = std::clamp(ratio, -0.999, 0.999);
  pole.rate = 2 * std::numbers::pi * f * std::complex<double>(-bounded, std::sqrt(1 - bounded * bounded));
  pole.frequency_deviation_hz = f_deviation;
  pole.damping_ratio_deviation = ratio_deviation;
  return pole;
}

std::string stabilisation_objection_to(const Pole& pole, std::size_t stable, std::size_t orders,
                                       const StabilisationSettings& settings) {
  const double needed = std::max(3.0, std::ceil(settings.fewest_orders * static_cast<double>(orders)));
  if (pole.damping_ratio() <= 0) return fmt::format("negative damping ratio, {:.3g}", pole.damping_ratio());
  if (pole.damping_ratio() > settings.largest_damping_ratio)
    return fmt::format("damping ratio {:.2g}, above {:.2g}", pole.damping_ratio(),
                       settings.largest_damping_ratio);
  if (static_cast<double>(stable) < needed)
    return fmt::format("stable at {} of {} orders, fewer than {:.0f}", stable, orders, needed);
  if (pole.frequency_deviation_hz > settings.largest_frequency_deviation * pole.frequency_hz())
    return fmt::format("too uncertain, standard deviation {:.2g} Hz", pole.frequency_deviation_hz);
  return "";
}

}  // namespace

Stabilisation stabilise(const std::vector<OrderPoles>& orders, const StabilisationSettings& settings) {
  Stabilisation result;
  static const std::vector<Pole> none;
  for (std::size_t i = 0; i < orders.size(); ++i)
    for (const Pole& pole : orders[i].poles) {
      const double f = pole.frequency_hz();
      if (f >= settings.band_hz.first && f <= settings.band_hz.second)
        result.poles.push_back(
            {orders[i].order, pole, stability_of(pole, i ? orders[i - 1].poles : none, settings)});
    }
  for (const std::vector<std::size_t>& members : clusters_of(result.poles, settings)) {
    std::vector<const DiagramPole*> all, stable;
    for (const std::size_t i : members) all.push_back(&result.poles[i]);
    all = one_of_each_order(all);
    std::copy_if(all.begin(), all.end(), std::back_inserter(stable),
                 [](const DiagramPole* one) { return one->stability == Stability::full; });
    PoleCluster cluster{merged_pole(stable.empty() ? all : stable), {}, ""};
    for (const DiagramPole* one : stable) cluster.orders.push_back(one->order);
    cluster.objection = stabilisation_objection_to(cluster.pole, stable.size(), orders.size(), settings);
    if (cluster.objection.empty())
      result.modes.push_back(std::move(cluster));
    else if (all.size() >= 3)
      result.rejected.push_back(std::move(cluster));
  }
  const auto rising = [](const PoleCluster& a, const PoleCluster& b) {
    return a.pole.frequency_hz() < b.pole.frequency_hz();
  };
  std::sort(result.modes.begin(), result.modes.end(), rising);
  std::sort(result.rejected.begin(), result.rejected.end(), rising);
  return result;
}

Eigen::VectorXd nearest_real(const Eigen::VectorXcd& shape) {
  const std::complex<double> square = shape.cwiseProduct(shape).sum();
  return (shape * std::polar(1.0, -0.5 * std::arg(square))).real();
}

}  // namespace beamid::experiments
