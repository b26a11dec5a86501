#include "experiments/modal/amplitude_dependence.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXcd, Eigen::VectorXd;

EnvelopeLine line_through(const VectorXd& time, const VectorXcd& logarithm, double independent_share) {
  const VectorXd weight = (2 * (logarithm.real().array() - logarithm.real().maxCoeff())).exp();
  const double sum = weight.sum();
  EnvelopeLine line;
  line.time = weight.dot(time) / sum;
  const Complex mean = (weight.cast<Complex>().array() * logarithm.array()).sum() / sum;
  line.log_amplitude = mean.real();
  const VectorXd from_mean = time.array() - line.time;
  const double moment = (weight.array() * from_mean.array().square()).sum();
  line.slope = ((weight.array() * from_mean.array()).cast<Complex>() * logarithm.array()).sum() / moment;
  const VectorXcd left = logarithm.array() - mean - line.slope * from_mean.array().cast<Complex>();
  const double count = static_cast<double>(time.size());
  const double independent = std::max(count * independent_share, 2.5);  // two go into the line
  const double variance =
      (weight.array() * left.array().abs2()).sum() / (2 * count) * independent / (independent - 2);
  line.deviation = std::sqrt(variance / (independent_share * moment));
  return line;
}

VectorXcd unwrapped_logarithm(const VectorXcd& z) {
  VectorXcd logarithm(z.size());
  double turned = 0;
  for (Index m = 0; m < z.size(); ++m) {
    turned += std::arg(m > 0 ? z[m] * std::conj(z[m - 1]) : z[m]);
    logarithm[m] = {std::log(std::max(std::abs(z[m]), 1e-300)), turned};
  }
  return logarithm;
}

namespace {

using Complex = std::complex<double>;

using std::numbers::pi;

VectorXd kaiser(Index half) {
  constexpr double beta = 5.65;  // 60 dB
  VectorXd kernel(2 * half + 1);
  for (Index k = -half; k <= half; ++k) {
    const double edge = static_cast<double>(k) / static_cast<double>(half + 1);
    kernel[k + half] = std::cyl_bessel_i(0, beta * std::sqrt(1 - edge * edge));
  }
  return kernel / kernel.sum();
}

}  // namespace

Demodulated demodulate(const VectorXd& signal, double interval, Complex rate,
                       const std::vector<Complex>& others, double fewest_kernels) {
  const double w = rate.imag();
  double apart = w;
  for (const Complex& other : others)
    if (other.imag() != w) apart = std::min(apart, std::abs(other.imag() - w));
  constexpr double first_zero = 2.06;  // of the Kaiser window's transform, times its length
  const auto half = static_cast<Index>(std::ceil(0.5 * first_zero * 2 * pi / (apart * interval)));
  const Index length = 2 * half + 1;
  if (static_cast<double>(signal.size()) < fewest_kernels * static_cast<double>(length))
    throw std::invalid_argument(
        fmt::format("{:.3g} s of the mode at {:.4g} Hz, {:.3g} Hz from the next; expected {:.3g} s at least",
                    static_cast<double>(signal.size()) * interval, w / (2 * pi), apart / (2 * pi),
                    fewest_kernels * static_cast<double>(length) * interval));
  const VectorXd kernel = kaiser(half);
  VectorXcd turning(length);
  Complex gain = 0;
  for (Index k = -half; k <= half; ++k) {
    turning[k + half] = kernel[k + half] * std::exp(Complex(0, -w * interval * static_cast<double>(k)));
    gain += kernel[k + half] * std::exp(rate.real() * interval * static_cast<double>(k));
  }
  const Index hop = std::max<Index>(1, half / 6), count = (signal.size() - length) / hop + 1;
  Demodulated found{VectorXcd(count), static_cast<double>(half) * interval,
                    static_cast<double>(hop) * interval, interval / kernel.squaredNorm()};
  for (Index m = 0; m < count; ++m) {
    const double time = found.start + static_cast<double>(m) * found.interval;
    found.values[m] = (turning.array() * signal.segment(m * hop, length).array().cast<Complex>()).sum() *
                      std::exp(Complex(0, -w * time)) / gain;
  }
  return found;
}

std::vector<AmplitudePoint> amplitude_dependence(const VectorXd& signal, double interval, Complex rate,
                                                 const std::vector<Complex>& others,
                                                 const AmplitudeSettings& settings) {
  const Demodulated found = demodulate(signal, interval, rate, others);
  const Index count = found.values.size();
  VectorXd time(count);
  for (Index m = 0; m < count; ++m) time[m] = found.start + static_cast<double>(m) * found.interval;
  const VectorXcd logarithm = unwrapped_logarithm(found.values);
  constexpr double fall = 0.35, fewest_kernels = 4.5;
  const double wanted =
      settings.window > 0 ? settings.window
                          : std::max(fall / std::max(-rate.real(), 1e-9), fewest_kernels * found.correlation);
  const Index length = std::clamp<Index>(static_cast<Index>(std::lround(wanted / found.interval)), 6, count);
  std::vector<AmplitudePoint> points;
  for (Index begin = 0; begin + length <= count; begin += std::max<Index>(1, length / 2)) {
    const EnvelopeLine line = line_through(time.segment(begin, length), logarithm.segment(begin, length),
                                           found.interval / found.correlation);
    const double damping = -line.slope.real(), turn = rate.imag() + line.slope.imag();
    const double w = std::hypot(damping, turn);
    AmplitudePoint point{line.time,    2 * std::exp(line.log_amplitude),
                         w / (2 * pi), line.deviation / (2 * pi),
                         damping / w,  line.deviation / w};
    if (point.damping_ratio_deviation <= settings.largest_deviation * std::abs(point.damping_ratio))
      points.push_back(point);
    else if (!points.empty() || 2 * begin > count)  // else other motion is still dying out
      break;
  }
  return points;
}

std::optional<AmplitudeTrend> amplitude_trend(const std::vector<AmplitudePoint>& points) {
  constexpr std::size_t fewest = 3;
  constexpr double clearly = 5, between = 3, least_frequency = 0.002, least_damping = 0.2;
  if (points.size() < fewest) return {};
  const AmplitudePoint &first = points.front(), &middle = points[points.size() / 2], &last = points.back();
  const auto changes = [&](double AmplitudePoint::*value, double AmplitudePoint::*deviation, double least) {
    const double change = last.*value - first.*value, of_middle = middle.*value - first.*value,
                 off = std::max(0.0, std::abs(of_middle - 0.5 * change) - 0.5 * std::abs(change));
    return std::abs(change) > clearly * std::hypot(first.*deviation, last.*deviation) &&
           std::abs(change) > least * std::abs(last.*value) && off < between * middle.*deviation;
  };
  const AmplitudeTrend trend{
      first, last,
      changes(&AmplitudePoint::frequency_hz, &AmplitudePoint::frequency_deviation_hz, least_frequency),
      changes(&AmplitudePoint::damping_ratio, &AmplitudePoint::damping_ratio_deviation, least_damping)};
  if (trend.frequency || trend.damping) return trend;
  return {};
}

std::string AmplitudeTrend::changes() const {
  std::string text;
  if (frequency) text = fmt::format("frequency {:.4g} to {:.4g} Hz", first.frequency_hz, last.frequency_hz);
  if (damping)
    text += fmt::format("{}damping ratio {:.3g} to {:.3g} %", frequency ? ", " : "",
                        100 * first.damping_ratio, 100 * last.damping_ratio);
  return text;
}

double overtone_coherence(const VectorXd& signal, double interval, double frequency_hz, int n) {
  constexpr double first_zero = 2.06, fewest = 5;  // periods
  const double w = 2 * pi * frequency_hz * interval;
  const auto half = static_cast<Index>(std::ceil(pi * first_zero / w));
  const Index length = 2 * half + 1, hop = std::max<Index>(1, half / 4);
  if (static_cast<double>(signal.size()) < fewest * static_cast<double>(half)) return 0.0;
  const VectorXd kernel = kaiser(half);
  const auto turning = [&](int times) {
    VectorXcd wave(length);
    for (Index k = -half; k <= half; ++k)
      wave[k + half] = kernel[k + half] * std::polar(1.0, -w * times * static_cast<double>(k));
    return wave;
  };
  const VectorXcd one = turning(1), several = turning(n);
  Complex product = 0;
  double of_one = 0, of_several = 0;
  for (Index at = 0; at + length <= signal.size(); at += hop) {
    const auto part = signal.segment(at, length).cast<Complex>().array();
    const Complex power = std::pow((one.array() * part).sum(), n), other = (several.array() * part).sum();
    product += other * std::conj(power);  // both turn n w from part to part
    of_one += std::norm(power);
    of_several += std::norm(other);
  }
  return std::norm(product) / std::max(of_one * of_several, 1e-300);
}

namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Samples that were measured, at their instants [s].
struct Measured {
  VectorXd samples, time;
};

Measured measured_of(const VectorXd& signal, double interval) {
  std::vector<Index> at;
  for (Index k = 0; k < signal.size(); ++k)
    if (std::isfinite(signal[k])) at.push_back(k);
  Measured result{signal(at), VectorXd(static_cast<Index>(at.size()))};
  for (std::size_t i = 0; i < at.size(); ++i)
    result.time[static_cast<Index>(i)] = interval * static_cast<double>(at[i]);
  return result;
}

}  // namespace

std::string ThirdOvertone::words() const {
  return fmt::format(
      "An overtone at three times the frequency, {} it, has {:.2g} % of the amplitude at first. A sensor "
      "near the end of its range {} its largest readings by {:.2g} %, or the stiffness is not linear.",
      compression > 0 ? "against" : "in phase with", 100 * share, compression > 0 ? "lowers" : "raises",
      100 * std::abs(compression));
}

std::optional<ThirdOvertone> third_overtone(const VectorXd& signal, double interval,
                                            const ModalEstimate& mode) {
  constexpr double fewest = 7, clearly = 8, least_share = 0.005, in_phase = 0.44;  // [rad]
  constexpr int beside = 6;
  if (!(mode.frequency_hz * interval * fewest < 1)) return {};
  const Measured measured = measured_of(signal, interval);
  const Complex rate = mode.rate();
  const double d = -rate.real(), w = rate.imag(), length = measured.time.tail(1)[0];
  std::vector<Complex> known{rate};
  for (const CompanionMode& other : mode.companions) known.push_back(other.rate());
  std::vector<bool> oscillating(known.size(), true);
  known.emplace_back(0);
  oscillating.push_back(false);
  const ShapeFit motion = fit_shapes_at(measured.samples.transpose(), measured.time, known, oscillating);
  const MatrixXd left = measured.samples.transpose() - motion.reconstruction;
  const auto at = [&](double frequency) {
    return fit_shapes_at(left, measured.time, {{-d, frequency}, {-3 * d, frequency}}, {true, true});
  };
  const ShapeFit overtone = at(3 * w);
  const Complex amplitude = motion.shapes(0, 0), third = overtone.shapes.sum();
  const double share = std::abs(third) / std::abs(amplitude),
               phase = std::remainder(std::arg(third) - 3 * std::arg(amplitude), 2 * std::numbers::pi);
  const bool against = std::abs(phase) > std::numbers::pi / 2;
  const double off = against ? std::numbers::pi - std::abs(phase) : std::abs(phase);
  if (!(share > least_share) || off > in_phase) return {};
  // Lines of the two shapes are some d / pi wide, of a short signal 1 / length; even overtones are w away.
  const double line = std::max(4 * std::numbers::pi / length, 4 * std::abs(d)),
               nearest = std::min(2 * line, 0.3 * w), farthest = std::clamp(7 * line, nearest, 0.45 * w);
  std::vector<double> around;
  for (const double away : VectorXd::LinSpaced(beside, nearest, farthest))
    for (const int side : {-1, 1}) around.push_back(at(3 * w + side * away).reconstruction.squaredNorm());
  if (!(overtone.reconstruction.squaredNorm() > clearly * median(std::move(around)))) return {};
  return ThirdOvertone{share, against ? 3 * share : -3 * share};
}

}  // namespace beamid::experiments
