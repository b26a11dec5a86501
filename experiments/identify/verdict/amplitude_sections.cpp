#include "experiments/identify/verdict/amplitude_sections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include "experiments/modal/dominant_mode.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/signal/decimation.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index law_unknowns = 7;  // w0, d0, w1, d1, Re and Im amplitude, offset
using Parameters = Eigen::Matrix<double, law_unknowns, 1>;
using Normal = Eigen::Matrix<double, law_unknowns, law_unknowns>;

/// log |z| a time later: the midpoint rule.
double decayed(const AmplitudeShape& shape, const Parameters& p, double log_amplitude, double time) {
  const double half = log_amplitude - 0.5 * time * (p[1] + p[3] * shape.at(log_amplitude));
  return log_amplitude - time * (p[1] + p[3] * shape.at(half));
}

struct LawStep {
  Normal normal = Normal::Zero();
  Parameters gradient = Parameters::Zero();
  double squares = 0;
};

/// At the parameters, with the amplitude that these make.
LawStep law_step(const VectorXd& signal, double interval, const AmplitudeShape& shape, const Parameters& p,
                 double log_amplitude) {
  LawStep at;
  double integral = 0, g = shape.at(log_amplitude);  // of g over time
  for (Index k = 0; k < signal.size(); ++k) {
    const double time = interval * static_cast<double>(k);
    const Complex unit = std::exp(Complex(-p[1], p[0]) * time + Complex(-p[3], p[2]) * integral),
                  value = Complex(p[4], p[5]) * unit;
    Parameters row;
    row << -time * value.imag(), -time * value.real(), -integral * value.imag(), -integral * value.real(),
        unit.real(), -unit.imag(), 1;
    const double residual = signal[k] - value.real() - p[6];
    at.normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
    at.gradient += residual * row;
    at.squares += residual * residual;
    log_amplitude = decayed(shape, p, log_amplitude, interval);
    const double next = shape.at(log_amplitude);
    integral += 0.5 * interval * (g + next);
    g = next;
  }
  at.normal.triangularView<Eigen::StrictlyUpper>() = at.normal.transpose();
  return at;
}

/// Amplitude and offset best for these rates.
void fit_amplitude(const VectorXd& signal, double interval, const AmplitudeShape& shape, double log_amplitude,
                   Parameters& p) {
  const LawStep at = law_step(signal, interval, shape, p, log_amplitude);
  p.tail<3>() += at.normal.bottomRightCorner<3, 3>().ldlt().solve(at.gradient.tail<3>());
}

LawLine law_line(double constant, double slope, double variance, double covariance, double unit) {
  const double pivot = -covariance / variance;
  return {(constant + slope * pivot) / unit, slope / unit, pivot, std::sqrt(variance) / unit};
}

VectorXd shape_at(const VectorXd& instants, double interval, const AmplitudeShape& shape, const Parameters& p,
                  double log_amplitude) {
  VectorXd values(instants.size());
  double time = 0;
  for (Index i = 0; i < instants.size(); ++i) {
    const int steps = 1 + static_cast<int>(std::abs(instants[i] - time) / interval);
    for (int k = 0; k < steps; ++k)
      log_amplitude = decayed(shape, p, log_amplitude, (instants[i] - time) / steps);
    time = instants[i];
    values[i] = shape.at(log_amplitude);
  }
  return values;
}

}  // namespace

double AmplitudeShape::at(double log_amplitude) const {
  return power == 0 ? log_amplitude - log_reference : std::exp(power * (log_amplitude - log_reference));
}

AmplitudeLaw fit_amplitude_law(const VectorXd& signal, double interval, const AmplitudeShape& shape,
                               const AmplitudeLawStart& start, const VectorXd& instants) {
  constexpr double settled = 1e-8, twice_pi = 2 * std::numbers::pi;
  const double w = twice_pi * start.frequency_hz;
  Parameters p;
  p << w, start.damping_ratio * w, twice_pi * start.frequency_slope, start.damping_slope * w, 0, 0, 0;
  double log_amplitude = start.log_amplitude;
  fit_amplitude(signal, interval, shape, log_amplitude, p);
  LawStep at = law_step(signal, interval, shape, p, log_amplitude);
  const auto step = [&](double damping) -> VectorXd {
    return filters::solve_damped(at.normal, damping, at.gradient);
  };
  const auto take = [&](const VectorXd& tried) {  // always: the amplitude is that of the step before
    p += tried;
    log_amplitude = std::log(std::hypot(p[4], p[5]));
    const double before = at.squares;
    at = law_step(signal, interval, shape, p, log_amplitude);
    return filters::TriedStep{1.0, std::abs(before - at.squares) <= settled * at.squares};
  };
  filters::MarquardtDamping rule;
  rule.most_steps = 30;
  if (filters::levenberg_marquardt(rule, step, take) != filters::DescentEnd::settled)
    throw std::runtime_error("the fit of a decay that follows its amplitude has not converged");
  AmplitudeLaw law;
  law.squares = at.squares;
  law.freedom = static_cast<double>(signal.size() - law_unknowns);
  const Normal covariance =
      at.squares / law.freedom * Normal(filters::solve_damped(at.normal, 0, Normal::Identity()));
  law.frequency_hz = law_line(p[0], p[2], covariance(2, 2), covariance(0, 2), twice_pi);
  const double omega_d = twice_pi * law.frequency_hz.value, omega = std::hypot(omega_d, p[1]);
  law.frequency_hz.value *= omega / omega_d;  // |s| of its imaginary part
  law.damping_ratio = law_line(p[1], p[3], covariance(3, 3), covariance(1, 3), omega);
  law.shape = shape_at(instants, interval, shape, p, log_amplitude);
  if (!law.shape.allFinite() || !(law.frequency_hz.slope_deviation > 0) ||
      !(law.damping_ratio.slope_deviation > 0))
    throw std::runtime_error("the fit of a decay that follows its amplitude determines no parameter");
  return law;
}

namespace {

// Whether a quantity of a decay follows its amplitude: laws weighed beside a constant.

/// Weighted line through the sections' values, a + b u.
struct SectionLine {
  double a = 0, b = 0, b_deviation = 0, u_mean = 0, squares = 0;
};

SectionLine section_line_through(const Eigen::VectorXd& u, const Eigen::VectorXd& v,
                                 const Eigen::VectorXd& deviation);

/// Frequency or damping of the sections.
struct SectionValues {
  Eigen::VectorXd value, deviation;
};

/// By how much they scatter about the nearest of the laws' lines: the probability of as much by noise, and
/// the standard deviation beyond it, by moments [dersimonian1986].
struct Scatter {
  double probability = 1, deviation = 0;
};

Scatter scatter_about_lines(const std::vector<Eigen::VectorXd>& shapes, const SectionValues& of,
                            double freedom);

constexpr double significant = 0.01;

/// log of Student's likelihood of a slope that is z deviations off.
double log_student(double z, double freedom) {
  return -0.5 * (freedom + 1) * std::log1p(z * z / freedom);
}

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

Scatter scatter_about_lines(const std::vector<VectorXd>& shapes, const SectionValues& of, double freedom) {
  double squares = std::numeric_limits<double>::infinity();
  for (const VectorXd& u : shapes)
    squares = std::min(squares, section_line_through(u, of.value, of.deviation).squares);
  const double left = static_cast<double>(of.value.size()) - 2;
  const boost::math::fisher_f distribution(left, freedom);
  Scatter scatter{cdf(complement(distribution, squares / left)), 0};
  if (!(scatter.probability < significant)) return scatter;
  const Eigen::ArrayXd weight = of.deviation.array().square().inverse();
  scatter.deviation = std::sqrt((squares - left) / (weight.sum() - weight.square().sum() / weight.sum()));
  return scatter;
}

/// Of a quantity by the laws: their probabilities beside that of a constant, and what it then is along the
/// decay.
/// @param usual standard deviation beforehand of the change over the decay, where there is one
SectionTrend trend_of(const std::vector<AmplitudeLaw>& laws, LawLine AmplitudeLaw::*line, double usual,
                      const Scatter& scatter) {
  constexpr double odds = 0.05;                                    // that a quantity varies, beforehand
  constexpr std::array<double, 5> z{0, -1.57, 1.57, -0.73, 0.73};  // slopes: their variance is one
  SectionTrend trend;
  if (laws.empty()) return trend;
  const auto best = std::min_element(laws.begin(), laws.end(),
                                     [](const auto& a, const auto& b) { return a.squares < b.squares; });
  const double share = 1 / static_cast<double>(laws.size());
  const auto prior_of = [usual](const AmplitudeLaw& law) {
    return usual / (law.shape.maxCoeff() - law.shape.minCoeff());
  };
  double constant = 0, all = 0;
  std::vector<double> weights;
  for (const AmplitudeLaw& law : laws) {
    const LawLine& l = law.*line;
    const double prior = prior_of(law), together = std::hypot(prior, l.slope_deviation);
    const double as_good = share * std::exp(-0.5 * law.freedom * (law.squares / best->squares - 1));
    constant += as_good * std::exp(log_student(l.slope / l.slope_deviation, law.freedom));
    weights.push_back(odds * as_good * l.slope_deviation / together *
                      std::exp(log_student(l.slope / together, law.freedom)));
    all += weights.back();
  }
  all += constant;
  trend.constant = constant / all;
  const Index instants = best->shape.size(), rounds = static_cast<Index>(z.size());
  trend.possible.resize(instants * rounds, static_cast<Index>(laws.size()));
  trend.weight.resize(trend.possible.cols());
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const LawLine& l = laws[i].*line;
    const double prior = prior_of(laws[i]),
                 kept = prior * prior / (prior * prior + l.slope_deviation * l.slope_deviation);
    trend.weight[static_cast<Index>(i)] = weights[i] / all;
    for (Index r = 0; r < rounds; ++r) {
      const double slope =
          kept * l.slope + z[static_cast<std::size_t>(r)] * std::sqrt(kept) * l.slope_deviation;
      trend.possible.col(static_cast<Index>(i)).segment(r * instants, instants) =
          l.value + slope * (laws[i].shape.array() - l.pivot);
    }
  }
  const LawLine& l = (*best).*line;
  const boost::math::students_t of_slope(best->freedom);
  trend.probability =
      std::min(2 * cdf(complement(of_slope, std::abs(l.slope) / l.slope_deviation)), scatter.probability);
  trend.scatter = scatter.deviation;
  if (trend.probability < significant) trend.values = l.value + l.slope * (best->shape.array() - l.pivot);
  return trend;
}

using Complex = std::complex<double>;

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
  deviation = std::hypot(deviation, trend.walk);
  if (trend.possible.size() == 0 || !std::isfinite(estimate + deviation)) return quantile_95 * deviation;
  const double least = 1e-12 * std::abs(estimate), s0 = std::max(deviation, least),
               s = std::max(std::hypot(deviation_where_it_varies, std::max(trend.scatter, trend.walk)),
                            least);
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
