#include "experiments/identify/amplitude_sections.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>

#include "experiments/identify/section_trend.hpp"
#include "experiments/modal/damped_sine_fit.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;

constexpr double section_samples_per_cycle = 8, fewest_periods = 3, wished_periods = 4;
constexpr int fewest_sections = 3, most_sections = 10;

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

constexpr double law_powers[] = {2, 1, 0.5, 0, -1};  // friction that grows with velocity ... Coulomb's

/// Where the last sample that counts is: evenly spread instants up to there [s].
VectorXd instants_until(double end) {
  constexpr Index instants = 60;
  return VectorXd::LinSpaced(instants, 0.5, instants - 0.5) * (end / instants);
}

/// The laws that converge, from lines through the sections.
std::vector<AmplitudeLaw> laws_of(const DecimatedSignal& coarse, Index used, double end,
                                  const std::vector<DecaySection>& sections,
                                  const std::vector<VectorXd>& shapes, double log_reference,
                                  const SectionValues& frequency, const SectionValues& damping) {
  const DecaySection& first = sections.front();
  std::vector<AmplitudeLaw> laws;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const SectionLine f = section_line_through(shapes[i], frequency.value, frequency.deviation),
                      d = section_line_through(shapes[i], damping.value, damping.deviation);
    const double rate = 2 * std::numbers::pi * first.frequency_hz * first.damping_ratio;
    const AmplitudeLawStart start{f.a, f.b, d.a, d.b,
                                  std::log(first.amplitude) + 0.5 * rate * (first.to - first.from)};
    try {
      laws.push_back(fit_amplitude_law(coarse.samples.head(used), coarse.interval,
                                       {law_powers[i], log_reference}, start,
                                       instants_until(end).array() - coarse.start));
    } catch (const std::runtime_error&) {  // others remain, or the sections alone
    }
  }
  return laws;
}

}  // namespace

AmplitudeSections amplitude_sections(const VectorXd& signal, double interval, const ModalEstimate& modal,
                                     double read) {
  constexpr double least_over_noise = 3;
  constexpr Index kernel_and_more = 50;
  AmplitudeSections result;
  if (!modal.companions.empty()) return result;
  const int factor = decimation_factor(1 / (interval * modal.frequency_hz * section_samples_per_cycle),
                                       signal.size() / kernel_and_more);
  const DecimatedSignal coarse = decimate(signal, interval, factor);
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
      fitted.push_back(one);
    } catch (const std::exception&) {
      break;
    }
  }
  if (fitted.size() < static_cast<std::size_t>(fewest_sections) || !(squares > 0)) return result;
  const double noise = std::sqrt(squares / freedom);              // as dense as this at the coarse rate
  result.noise = noise / coarse.kernel.norm() / std::sqrt(read);  // what is filled in has none
  const auto sections = static_cast<Index>(fitted.size());
  SectionValues frequency{VectorXd(sections), VectorXd(sections)},
      damping{VectorXd(sections), VectorXd(sections)};
  VectorXd log_amplitude(sections);
  // white noise passes the kernel as dense as it was: 1 / factor of its variance
  const double scale = result.noise / std::sqrt(static_cast<double>(coarse.factor));
  for (Index i = 0; i < sections; ++i) {
    DecaySection& section = fitted[static_cast<std::size_t>(i)].section;
    frequency.value[i] = section.frequency_hz;
    frequency.deviation[i] = section.frequency_deviation_hz *= scale;
    damping.value[i] = section.damping_ratio;
    damping.deviation[i] = section.damping_ratio_deviation *= scale;
    log_amplitude[i] = std::log(section.amplitude);
    result.sections.push_back(section);
  }
  std::vector<VectorXd> shapes;
  for (const double power : law_powers)
    shapes.emplace_back(log_amplitude.unaryExpr(
        [shape = AmplitudeShape{power, log_amplitude.mean()}](double x) { return shape.at(x); }));
  const double end =
      sections == count ? interval * static_cast<double>(signal.size()) : result.sections.back().to;
  const std::vector<AmplitudeLaw> laws = laws_of(coarse, sections * length, end, result.sections, shapes,
                                                 log_amplitude.mean(), frequency, damping);
  // What joints, clamps and air commonly do to a beam over a decay: 0.4 % of its frequency, four fifths of
  // its damping.
  constexpr double usual_frequency = 0.004, usual_damping = 0.8;
  result.frequency = trend_of(laws, &AmplitudeLaw::frequency_hz, usual_frequency * modal.frequency_hz,
                              scatter_about_lines(shapes, frequency, freedom));
  result.damping = trend_of(laws, &AmplitudeLaw::damping_ratio, usual_damping * std::abs(modal.damping_ratio),
                            scatter_about_lines(shapes, damping, freedom));
  return result;
}

double section_half_width(const SectionTrend& trend, double estimate, double deviation,
                          double deviation_where_it_varies) {
  if (trend.possible.size() == 0 || !std::isfinite(estimate + deviation)) return quantile_95 * deviation;
  const double least = 1e-12 * std::abs(estimate), s0 = std::max(deviation, least),
               s = std::max(std::hypot(deviation_where_it_varies, trend.scatter), least);
  const Eigen::ArrayXXd off = (trend.possible.array() - estimate).abs();
  const auto above = [](double x) { return std::abs(x) < 6 ? std::erfc(x) : x > 0 ? 0.0 : 2.0; };  // to 2e-17
  const auto within = [&](double h, double d, double of) {
    return 0.5 * (above((d - h) / (std::numbers::sqrt2 * of)) - above((d + h) / (std::numbers::sqrt2 * of)));
  };
  constexpr double negligible = 1e-5;
  const auto held = [&](double h) {
    double sum = trend.constant * within(h, 0.0, s0);
    for (Eigen::Index i = 0; i < off.cols(); ++i)
      if (trend.weight[i] > negligible)
        sum += trend.weight[i] * off.col(i).unaryExpr([&](double d) { return within(h, d, s); }).mean();
    return sum / (trend.constant + trend.weight.sum());
  };
  // Where as much is held over a stretch, between two values: its beginning.
  constexpr double wanted = 0.95 - 1e-9;
  std::uintmax_t iterations = 200;
  return boost::math::tools::toms748_solve([&](double h) { return held(h) - wanted; }, 0.0,
                                           off.maxCoeff() + 4 * std::max(s, s0),
                                           boost::math::tools::eps_tolerance<double>(32), iterations)
      .second;
}

}  // namespace beamid::experiments
