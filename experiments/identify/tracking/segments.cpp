#include "experiments/identify/tracking/segments.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "experiments/identify/tracking/ringing_model.hpp"
#include "experiments/modal/damped_sine_fit.hpp"
#include "experiments/signal/chi_square_limit.hpp"
#include "experiments/signal/median.hpp"
#include "filters/filter.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
using namespace ringing;

constexpr double tau = 2.0 * std::numbers::pi;
constexpr double look_ahead = 6;                        // cycles
constexpr double tracked_stiffness_uncertainty = 0.14;  // of ln K: 7 % of the frequency
constexpr double damping_guess = 0.005, tracked_damping_uncertainty = 0.02;

// Frequency of the largest Fourier amplitude within the band, under a Hann window.
double peak(const VectorXd& samples, double interval, std::pair<double, double> band) {
  const auto n = static_cast<double>(samples.size());
  VectorXd tapered = samples.array() - samples.mean();
  for (Index k = 0; k < samples.size(); ++k)
    tapered[k] *= 1.0 - std::cos(tau * (static_cast<double>(k) + 0.5) / n);
  const double step = 0.05 / (n * interval);
  double best = band.first, largest = -1.0;
  for (double f = band.first; f <= band.second; f += step) {
    const std::complex<double> turn = std::polar(1.0, -tau * f * interval);
    std::complex<double> phase = 1.0, sum = 0.0;
    for (const double sample : tapered) sum += sample * phase, phase *= turn;
    if (std::norm(sum) > largest) largest = std::norm(sum), best = f;
  }
  return best;
}

}  // namespace

Index Ringing::cycles(double count) const {
  return std::max<Index>(1, std::lround(count / (centre_hz * interval)));
}

filters::Measurements Ringing::span(Index first, Index last) const {
  const Index count = last - first + 1;
  return {time.segment(first, count), signal.segment(first, count).transpose(), {}, {}, 1e-3 * interval};
}

std::unique_ptr<filters::Filter> ringing_filter(const Ringing& ringing, const filters::Noise& noise) {
  return filters::filter_registry().make("ekf", {},
                                         ringing_model(ringing.centre_hz, ringing.interval, noise));
}

filters::Noise ringing_noise(const Ringing& ringing, double noise, double force, double walk) {
  filters::Noise result{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Constant(1, 1, noise * noise)};
  result.process(slope, slope) = force * force * ringing.interval;
  result.process(stiffness, stiffness) = walk * walk * ringing.interval;
  result.process(damping, damping) = 0.25 * walk * walk * ringing.interval;
  return result;
}

filters::Gaussian fresh_estimate(const Ringing& ringing, Index first) {
  const Index wanted = std::min(ringing.size(), ringing.cycles(look_ahead));
  const VectorXd ahead = ringing.signal.segment(std::min(first, ringing.size() - wanted), wanted);
  const double amplitude = std::max(3.0 * ringing.noise, (ahead.array() - ahead.mean()).abs().maxCoeff());
  const double f = peak(ahead, ringing.interval, ringing.band_hz);
  filters::Gaussian estimate{VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  estimate.mean[stiffness] = 2.0 * std::log(f / ringing.centre_hz);
  estimate.mean[damping] = damping_guess;
  estimate.mean[offset] = ahead.mean();
  VectorXd deviation(size);
  deviation << amplitude, tau * f * amplitude, 0.0, 0.0, tracked_stiffness_uncertainty,
      tracked_damping_uncertainty, amplitude;
  estimate.covariance = deviation.cwiseAbs2().asDiagonal();
  return estimate;
}

double typical_noise(const Ringing& ringing) {
  const Index count = ringing.cycles(look_ahead);
  std::vector<double> residuals;
  for (Index first = 0; first + count <= ringing.size(); first += count) {
    const VectorXd block = ringing.signal.segment(first, count);
    const double w = tau * peak(block, ringing.interval, ringing.band_hz);
    try {
      residuals.push_back(
          fit_damped_sines(block, ringing.interval, {{-damping_guess * w, w}}).residual_standard_deviation);
    } catch (const std::exception&) {
      continue;  // a span with a change in it need not be a damped sine
    }
  }
  if (residuals.empty())
    throw std::invalid_argument("no six cycles of the record are a damped sine within the band");
  return std::max(median(residuals), 1e-6 * ringing.signal.cwiseAbs().maxCoeff());
}

double typical_force(const Ringing& ringing) {
  return ringing.noise * tau * ringing.centre_hz * std::sqrt(2.0 * ringing.centre_hz / look_ahead);
}

Segments find_segments(const Ringing& ringing, double walk, double false_alarms) {
  Segments found;
  found.test_samples = ringing.cycles(1);
  found.threshold = chi_square_limit(static_cast<double>(found.test_samples),
                                     1.0 - false_alarms / static_cast<double>(ringing.size()));
  const double improbable = chi_square_limit(1, 1.0 - 1e-3);
  const auto filter =
      ringing_filter(ringing, ringing_noise(ringing, ringing.noise, typical_force(ringing), walk));
  const VectorXd none;
  for (Index begin = 0; begin < ringing.size();) {
    found.begins.push_back(begin);
    filter->reset(fresh_estimate(ringing, begin));
    std::vector<double> squares;
    Index k = begin, change = ringing.size();
    for (; k < ringing.size(); ++k) {
      try {
        if (k > begin) filter->predict(none);
        squares.push_back(filter->correct(ringing.signal.segment(k, 1), none).normalised_square);
      } catch (const filters::FilterFailure&) {
        change = std::max(begin + 1, k);
        break;
      }
      const auto window = std::min<std::ptrdiff_t>(found.test_samples, std::ssize(squares));
      double sum = 0.0;
      for (auto s = squares.end() - window; s != squares.end(); ++s) sum += *s;
      if (!(sum > found.threshold)) continue;
      const auto first = std::find_if(squares.end() - window, squares.end(),
                                      [&](double square) { return square > improbable; });
      change = std::max<Index>(begin + 1, begin + (first - squares.begin()));
      break;
    }
    begin = change;
  }
  return found;
}

}  // namespace beamid::experiments
