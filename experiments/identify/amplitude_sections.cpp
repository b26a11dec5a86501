#include "experiments/identify/amplitude_sections.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "experiments/modal/damped_sine_fit.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;

constexpr double section_samples_per_cycle = 8, fewest_periods = 3, wished_periods = 4;
constexpr int fewest_sections = 3, most_sections = 10;
constexpr double significant = 0.01;

struct FittedSection {
  DecaySection section;  // deviations per unit of noise
  double squares = 0, freedom = 0;
};

FittedSection fit_section(const DecimatedSignal& coarse, Index begin, Index count, Complex rate) {
  const DampedSineFit fit = fit_damped_sines(coarse.samples.segment(begin, count), coarse.interval, {rate});
  const Complex s = fit.sines[0].rate;
  const double w_d = s.imag(), d = -s.real(), w = std::abs(s);
  const Eigen::Matrix2d covariance = fit.cofactors.topLeftCorner<2, 2>();
  const Eigen::Vector2d frequency_slope = Eigen::Vector2d(w_d, d) / (2 * std::numbers::pi * w),
                        damping_slope = Eigen::Vector2d(-d * w_d, w_d * w_d) / (w * w * w);
  const double length = coarse.interval * static_cast<double>(count),
               from = coarse.start + coarse.interval * static_cast<double>(begin);
  FittedSection result;
  result.section = {from,
                    from + length,
                    std::abs(fit.sines[0].amplitude) * std::exp(-d * length / 2),
                    w / (2 * std::numbers::pi),
                    std::sqrt(frequency_slope.dot(covariance * frequency_slope)),
                    d / w,
                    std::sqrt(damping_slope.dot(covariance * damping_slope))};
  result.squares = fit.residuals.squaredNorm();
  result.freedom = static_cast<double>(count) - 5;
  return result;
}

/// Weighted line through the sections' values, a + b u.
struct SectionLine {
  double a = 0, b = 0, b_deviation = 0, u_mean = 0, squares = 0;
};

SectionLine section_line_through(const VectorXd& u, const VectorXd& v, const VectorXd& deviation) {
  const Eigen::ArrayXd weight = deviation.array().square().inverse();
  const double sum = weight.sum(), u_mean = (weight * u.array()).sum() / sum,
               v_mean = (weight * v.array()).sum() / sum;
  const Eigen::ArrayXd du = u.array() - u_mean, dv = v.array() - v_mean;
  const double spread = (weight * du.square()).sum();
  SectionLine line;
  line.b = (weight * du * dv).sum() / spread;
  line.a = v_mean - line.b * u_mean;
  line.u_mean = u_mean;
  line.b_deviation = std::sqrt(1 / spread);
  line.squares = (weight * (dv - line.b * du).square()).sum();
  return line;
}

/// log A at instants evenly spread from the first sample to `end`, straight between the sections' middles and
/// beyond.
VectorXd log_amplitudes(const std::vector<DecaySection>& sections, double end) {
  constexpr Index instants = 60;
  VectorXd result(instants);
  for (Index k = 0; k < instants; ++k) {
    const double time = end * (static_cast<double>(k) + 0.5) / instants;
    const auto middle = [&](std::size_t i) { return 0.5 * (sections[i].from + sections[i].to); };
    std::size_t i = 0;
    while (i + 2 < sections.size() && time > middle(i + 1)) ++i;
    const double share = (time - middle(i)) / (middle(i + 1) - middle(i));
    result[k] = (1 - share) * std::log(sections[i].amplitude) + share * std::log(sections[i + 1].amplitude);
  }
  return result;
}

/// The line at the instants u, with slopes as its own may be: z deviations off, which have a variance of one.
/// The first value and the last are those of the line itself.
VectorXd section_values_of(const SectionLine& line, const VectorXd& u) {
  constexpr std::array<double, 6> z{0, -1.57, 1.57, -0.73, 0.73, 0};
  const Index count = u.size();
  VectorXd values(count * static_cast<Index>(z.size()));
  for (std::size_t i = 0; i < z.size(); ++i)
    values.segment(static_cast<Index>(i) * count, count) =
        line.a + line.b * u.array() + z[i] * line.b_deviation * (u.array() - line.u_mean);
  return values;
}

SectionTrend trend_of(const std::vector<DecaySection>& sections, const VectorXd& value,
                      const VectorXd& deviation, double noise_freedom, double end) {
  const auto count = static_cast<Index>(sections.size());
  VectorXd log_amplitude(count);
  for (Index i = 0; i < count; ++i)
    log_amplitude[i] = std::log(sections[static_cast<std::size_t>(i)].amplitude);
  const double origin = log_amplitude.mean();
  const std::function<VectorXd(const VectorXd&)> shapes[] = {
      [&](const VectorXd& x) { return VectorXd((x.array() - origin).exp()); },
      [&](const VectorXd& x) { return VectorXd(x.array() - origin); },
      [&](const VectorXd& x) { return VectorXd((origin - x.array()).exp()); }};
  SectionTrend trend;
  SectionLine best;
  VectorXd values;
  for (const auto& shape : shapes) {
    const SectionLine line = section_line_through(shape(log_amplitude), value, deviation);
    if (values.size() > 0 && line.squares >= best.squares) continue;
    best = line;
    values = section_values_of(line, shape(log_amplitudes(sections, end)));
  }
  const boost::math::students_t of_slope(noise_freedom);
  const boost::math::fisher_f of_scatter(static_cast<double>(count) - 2, noise_freedom);
  const double slope = 2 * cdf(complement(of_slope, std::abs(best.b) / best.b_deviation)),
               about = cdf(complement(of_scatter, best.squares / (static_cast<double>(count) - 2)));
  trend.probability = std::min(slope, about);
  if (!(trend.probability < significant)) return trend;
  trend.values = values;
  if (about < significant) {  // moments [dersimonian1986]
    const Eigen::ArrayXd weight = deviation.array().square().inverse();
    const double surplus = best.squares - (static_cast<double>(count) - 2);
    trend.scatter = std::sqrt(surplus / (weight.sum() - weight.square().sum() / weight.sum()));
  }
  return trend;
}

}  // namespace

AmplitudeSections amplitude_sections(const VectorXd& signal, double interval, const ModalEstimate& modal) {
  constexpr double largest_share_missing = 0.02, least_over_noise = 3;
  constexpr Index kernel_and_more = 50;
  AmplitudeSections result;
  const auto measured = static_cast<double>(signal.array().isFinite().count());
  if (!modal.companions.empty() ||
      measured < (1 - largest_share_missing) * static_cast<double>(signal.size()))
    return result;
  const double wanted = 1 / (interval * modal.frequency_hz * section_samples_per_cycle),
               possible = static_cast<double>(signal.size() / kernel_and_more);
  const DecimatedSignal coarse = decimate(bridged_straight(signal), interval,
                                          static_cast<int>(std::max(1.0, std::min(wanted, possible))));
  const double periods = coarse.interval * static_cast<double>(coarse.samples.size()) * modal.frequency_hz;
  if (periods < fewest_sections * fewest_periods) return result;
  const int count = std::clamp(static_cast<int>(periods / wished_periods), fewest_sections, most_sections);
  const Index length = coarse.samples.size() / count;
  std::vector<FittedSection> fitted;
  double squares = 0, freedom = 0;
  for (Index i = 0; i < count; ++i) {
    try {
      FittedSection one = fit_section(coarse, i * length, length, modal.rate());
      const double deviation = std::sqrt((squares + one.squares) / (freedom + one.freedom));
      if (one.section.amplitude < least_over_noise * deviation) break;
      squares += one.squares, freedom += one.freedom;
      fitted.push_back(std::move(one));
    } catch (const std::exception&) {
      break;
    }
  }
  if (fitted.size() < static_cast<std::size_t>(fewest_sections) || !(squares > 0)) return result;
  const double noise = std::sqrt(squares / freedom);  // as dense as this at the coarse rate
  result.noise = noise / coarse.kernel.norm();
  const auto sections = static_cast<Index>(fitted.size());
  VectorXd frequency(sections), frequency_deviation(sections), damping(sections), damping_deviation(sections);
  // white noise passes the kernel as dense as it was: 1 / factor of its variance
  const double scale = result.noise / std::sqrt(static_cast<double>(coarse.factor));
  for (Index i = 0; i < sections; ++i) {
    DecaySection& section = fitted[static_cast<std::size_t>(i)].section;
    frequency[i] = section.frequency_hz;
    frequency_deviation[i] = section.frequency_deviation_hz *= scale;
    damping[i] = section.damping_ratio;
    damping_deviation[i] = section.damping_ratio_deviation *= scale;
    result.sections.push_back(section);
  }
  const double end =
      sections == count ? interval * static_cast<double>(signal.size()) : result.sections.back().to;
  result.frequency = trend_of(result.sections, frequency, frequency_deviation, freedom, end);
  result.damping = trend_of(result.sections, damping, damping_deviation, freedom, end);
  return result;
}

double section_half_width(const SectionTrend& trend, double estimate, double deviation) {
  if (!trend.varies()) return quantile_95 * deviation;
  const double s = std::max(std::hypot(deviation, trend.scatter), 1e-12 * std::abs(estimate));
  const Eigen::ArrayXd off = (trend.values.array() - estimate).abs();
  const boost::math::normal normal;
  const auto held = [&](double h) {
    double sum = 0;
    for (const double d : off) sum += cdf(normal, (h - d) / s) - cdf(normal, (-h - d) / s);
    return sum / static_cast<double>(off.size());
  };
  double low = 0, high = off.maxCoeff() + 3 * s;
  constexpr int halvings = 60;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (low + high);
    (held(middle) < 0.95 ? low : high) = middle;
  }
  return high;
}

}  // namespace beamid::experiments
