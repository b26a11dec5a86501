#include "experiments/modal/dominant_mode.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "experiments/signal/decimation.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/spectrum.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Parameters w, d (damping rate), a, b of each sine e^(-d t) (a cos w t - b sin w t), then the offset.
struct SineLinearisation {
  MatrixXd normal;     ///< J^T J
  VectorXd gradient;   ///< J^T r
  VectorXd residuals;  ///< r = y - model
};

/// By blocks of rows: an exponential for one sample of 16, products for the others, and J^T J of a block at
/// once.
SineLinearisation linearise(const VectorXd& signal, double interval, const VectorXd& parameters) {
  constexpr Index block = 128, span = 16;
  const Index size = parameters.size(), sines = size / 4;
  SineLinearisation at{MatrixXd::Zero(size, size), VectorXd::Zero(size), VectorXd::Zero(signal.size())};
  MatrixXd rows(block, size);
  for (Index begin = 0; begin < signal.size(); begin += block) {
    const Index count = std::min(block, signal.size() - begin);
    const VectorXd time = interval * VectorXd::LinSpaced(count, static_cast<double>(begin),
                                                         static_cast<double>(begin + count - 1));
    VectorXd model = VectorXd::Constant(count, parameters[size - 1]);
    rows.col(size - 1).setOnes();
    for (Index m = 0; m < sines; ++m) {
      const Complex rate(-parameters[4 * m + 1], parameters[4 * m]), turn = std::exp(rate * interval);
      const double re = turn.real(), im = turn.imag(), a = parameters[4 * m + 2], b = parameters[4 * m + 3];
      double x = 0.0, y = 0.0;  // e^(rate t), by parts: the product of the library looks for infinities
      for (Index k = 0; k < count; ++k) {
        if (k % span == 0) {
          const Complex unit = std::exp(rate * time[k]);
          x = unit.real(), y = unit.imag();
        }
        rows(k, 4 * m) = -time[k] * (a * y + b * x);
        rows(k, 4 * m + 1) = -time[k] * (a * x - b * y);
        rows(k, 4 * m + 2) = x;
        rows(k, 4 * m + 3) = -y;
        model[k] += a * x - b * y;
        const double next = x * re - y * im;
        y = x * im + y * re;
        x = next;
      }
    }
    auto residuals = at.residuals.segment(begin, count);
    residuals = signal.segment(begin, count) - model;
    for (Index k = 0; k < count; ++k)
      if (!std::isfinite(signal[begin + k])) residuals[k] = 0.0, rows.row(k).setZero();
    at.normal.noalias() += rows.topRows(count).transpose() * rows.topRows(count);
    at.gradient.noalias() += rows.topRows(count).transpose() * residuals;
  }
  return at;
}

/// Amplitudes and offset that are best for the given rates: a linear problem. At zero amplitude the rates
/// have no influence; a unit on their diagonal keeps them where they are.
VectorXd with_best_amplitudes(const VectorXd& signal, double interval, const std::vector<Complex>& rates) {
  VectorXd parameters = VectorXd::Zero(4 * static_cast<Index>(rates.size()) + 1);
  for (Index i = 0; i + 1 < parameters.size(); i += 4)
    parameters.segment<2>(i) << rates[i / 4].imag(), -rates[i / 4].real();
  SineLinearisation at = linearise(signal, interval, parameters);
  for (Index i = 0; i + 1 < parameters.size(); i += 4) at.normal.diagonal().segment<2>(i).setOnes();
  return parameters + filters::solve_damped(at.normal, 0, at.gradient);
}

Index measured(const VectorXd& signal) {
  return signal.array().isFinite().count();
}

void check_damped_sine_fit(const VectorXd& signal, const std::vector<Complex>& start) {
  const std::size_t fewest = 2 * (4 * start.size() + 1);
  const bool oscillating = std::all_of(start.begin(), start.end(), [](Complex rate) {
    return rate.imag() > 0 && std::isfinite(rate.imag()) && std::isfinite(rate.real());
  });
  if (!start.empty() && oscillating && static_cast<std::size_t>(measured(signal)) >= fewest) return;
  std::ostringstream message;
  message << "fit of " << start.size() << " damped sines to " << measured(signal) << " samples";
  for (const Complex& rate : start) message << ", from " << rate.real() << " + " << rate.imag() << "i rad/s";
  message << "; expected at least " << fewest << " samples and one or more positive angular frequencies";
  throw std::invalid_argument(message.str());
}

DampedSineFit result_of(const VectorXd& parameters, const SineLinearisation& at, Index count) {
  const Index size = parameters.size();
  DampedSineFit fit;
  for (Index i = 0; i + 1 < size; i += 4)
    fit.sines.push_back({{-parameters[i + 1], parameters[i]}, {parameters[i + 2], parameters[i + 3]}});
  fit.offset = parameters[size - 1];
  fit.cofactors = filters::solve_damped(at.normal, 0, MatrixXd::Identity(size, size));
  fit.residuals = at.residuals;
  fit.residual_standard_deviation = std::sqrt(at.residuals.squaredNorm() / static_cast<double>(count - size));
  return fit;
}

}  // namespace

DampedSineFit fit_damped_sines(const VectorXd& signal, double interval, const std::vector<Complex>& start) {
  check_damped_sine_fit(signal, start);
  constexpr double tolerance = 1e-11;  // change of the model, relative to the signal
  const double smallest_change =
      tolerance * tolerance * signal.array().isFinite().select(signal, 0.0).squaredNorm();
  VectorXd parameters = with_best_amplitudes(signal, interval, start);
  SineLinearisation at = linearise(signal, interval, parameters);
  const auto step = [&](double damping) -> VectorXd {
    return filters::solve_damped(at.normal, damping, at.gradient);
  };
  const auto take = [&](const VectorXd& tried) {
    const bool settled = tried.dot(at.normal * tried) <= smallest_change;
    SineLinearisation next = linearise(signal, interval, parameters + tried);
    const bool lower = next.residuals.squaredNorm() <= at.residuals.squaredNorm();
    if (lower) parameters += tried, at = std::move(next);
    return filters::TriedStep{lower ? 1.0 : 0.0, settled};
  };
  const filters::MarquardtDamping rule;
  if (filters::levenberg_marquardt(rule, step, take) != filters::DescentEnd::exhausted)
    return result_of(parameters, at, measured(signal));
  std::ostringstream message;
  message << "the fit of " << start.size() << " damped sines has not converged after " << rule.most_steps
          << " iterations; the first stands at " << parameters[0] << " rad/s with damping rate "
          << parameters[1] << " 1/s";
  throw std::runtime_error(message.str());
}

namespace {

void check_dominant_mode(const Eigen::VectorXd& signal, double interval,
                         const ModalAnalysisSettings& settings) {
  constexpr Eigen::Index fewest = 32;
  std::ostringstream message;
  if (signal.size() < fewest)
    message << "free decay of " << signal.size() << " samples; expected at least " << fewest
            << " for a modal analysis";
  else if (!(interval > 0))
    message << "sampling interval " << interval << " s; expected a positive value";
  else if (signal.array().isInf().any())
    message << "free decay holds a value that is not a finite number";
  else if (const Eigen::Index measured = signal.array().isFinite().count(); measured < fewest)
    message << "free decay of which " << measured << " samples were measured; expected at least " << fewest
            << " for a modal analysis";
  else if (settings.expected_frequency_hz &&
           !(*settings.expected_frequency_hz > 0 && *settings.expected_frequency_hz < 0.5 / interval))
    message << "expected frequency " << *settings.expected_frequency_hz
            << " Hz; expected a value between 0 and " << 0.5 / interval << " Hz, half the sampling rate";
  if (const std::string text = message.str(); !text.empty()) throw std::invalid_argument(text);
}

/// As many samples per cycle as asked for, but enough of them for the realisation.
int factor_for_cycles(Eigen::Index count, double interval, double frequency_hz, double samples_per_cycle) {
  constexpr Eigen::Index enough = 50;  // of which the decimation's kernel takes 10
  return decimation_factor(1 / (interval * frequency_hz * samples_per_cycle), count / enough);
}

/// The strongest mode near a frequency; null where there is none.
const IdentifiedMode* strongest_near(const EigensystemRealisation& realisation, double frequency_hz,
                                     double tolerance) {
  const IdentifiedMode* best = nullptr;
  for (const IdentifiedMode& mode : realisation.modes)
    if (!mode.spurious && std::abs(mode.frequency_hz - frequency_hz) <= tolerance * frequency_hz &&
        (!best || mode.amplitude() > best->amplitude()))
      best = &mode;
  return best;
}

std::invalid_argument none_near(const EigensystemRealisation& realisation, double frequency_hz,
                                double tolerance) {
  std::ostringstream found, message;
  for (const IdentifiedMode& mode : realisation.modes)
    if (!mode.spurious) found << (found.tellp() > 0 ? ", " : "") << mode.frequency_hz;
  message << "no mode within " << 100 * tolerance << " % of " << frequency_hz << " Hz; found "
          << (found.tellp() > 0 ? found.str() + " Hz" : "none");
  return std::invalid_argument(message.str());
}

/// Modes beside the dominant one that are strong enough to matter.
std::vector<const IdentifiedMode*> strong_modes(const EigensystemRealisation& realisation,
                                                const IdentifiedMode& dominant, double smallest_amplitude) {
  std::vector<const IdentifiedMode*> modes;
  for (const IdentifiedMode& mode : realisation.modes)
    if (&mode != &dominant && !mode.spurious && mode.amplitude() >= smallest_amplitude * dominant.amplitude())
      modes.push_back(&mode);
  return modes;
}

bool resolved(const IdentifiedMode& a, const IdentifiedMode& b, double duration) {
  constexpr double cycles_apart = 1.5;
  return std::abs(a.frequency_hz - b.frequency_hz) * duration > cycles_apart;
}

struct Realised {
  IdentifiedMode dominant;
  std::vector<std::complex<double>> rates;  ///< the dominant mode's, then those of its companions
};

/// A mode whose frequency follows its amplitude is realised as several poles closer than the signal resolves:
/// the order is then lowered until one is left. Where that one grows, as half a beat of two modes does, the
/// strongest of the several stays.
Realised realise(const DecimatedSignal& coarse, double expected_hz, const ModalAnalysisSettings& settings) {
  const double duration = coarse.interval * static_cast<double>(coarse.samples.size());
  EigensystemSettings eigensystem = settings.eigensystem;
  std::optional<Realised> before;
  for (;; --eigensystem.order) {
    const EigensystemRealisation realisation =
        eigensystem_realisation(coarse.samples.transpose(), coarse.interval, eigensystem);
    const IdentifiedMode* const found =
        strongest_near(realisation, expected_hz, settings.frequency_tolerance);
    if (!found && before) return *before;
    if (!found) throw none_near(realisation, expected_hz, settings.frequency_tolerance);
    const IdentifiedMode& dominant = *found;
    Realised result{dominant, {dominant.rate}};
    bool split = false;
    for (const IdentifiedMode* mode : strong_modes(realisation, dominant, settings.companion_amplitude)) {
      const double ratio = mode->frequency_hz / dominant.frequency_hz;
      if (!resolved(*mode, dominant, duration))
        split = true;
      else if (ratio > 0.5 && ratio < 2)
        result.rates.push_back(mode->rate);
    }
    if (!split || realisation.order <= 2 || settings.eigensystem.order > 0) return result;
    eigensystem.order = realisation.order;
    before = std::move(result);
  }
}

/// A mode damped by more than the realisation's limit, which keeps out the poles that noise makes; taken
/// where its least squares know it well enough for it to be none of these. @throws as realise() with the
/// limit
Realised realise_to_any_damping(const DecimatedSignal& coarse, double expected_hz,
                                const ModalAnalysisSettings& settings) {
  constexpr double any_oscillation = 0.7,
                   well = 0.1;  // well: of the pole's real part and of its imaginary part
  try {
    return realise(coarse, expected_hz, settings);
  } catch (const std::invalid_argument&) {
    ModalAnalysisSettings heavy = settings;
    heavy.eigensystem.largest_damping_ratio = any_oscillation;
    try {
      Realised found = realise(coarse, expected_hz, heavy);
      const DampedSineFit fit = fit_damped_sines(coarse.samples, coarse.interval, {found.rates.front()});
      const double noise = fit.residual_standard_deviation;
      const std::complex<double> rate = fit.sines.front().rate;
      found.rates.resize(1);
      if (noise * std::sqrt(fit.cofactors(1, 1)) < well * std::abs(rate.real()) &&
          noise * std::sqrt(fit.cofactors(0, 0)) < well * std::abs(rate.imag()) &&
          -rate.real() < any_oscillation * std::abs(rate))
        return found;
    } catch (const std::exception&) {  // none there either
    }
    throw;
  }
}

/// A sine in the decimated signal's time and amplitude, returned to those of the signal itself.
DampedSine undo_decimation(DampedSine sine, const DecimatedSignal& coarse) {
  sine.amplitude *= std::exp(-sine.rate * coarse.start) / coarse.response(sine.rate);
  return sine;
}

Eigen::VectorXd dominant_mode_motion_of(const DampedSineFit& fit, double interval, Eigen::Index count) {
  Eigen::VectorXd motion = Eigen::VectorXd::Constant(count, fit.offset);
  for (Eigen::Index k = 0; k < count; ++k)
    for (const DampedSine& sine : fit.sines)
      motion[k] += (sine.amplitude * std::exp(sine.rate * (interval * static_cast<double>(k)))).real();
  return motion;
}

/// Of the samples that were measured.
double residual_standard_deviation(const Eigen::VectorXd& signal, double interval, const DampedSineFit& fit) {
  const Eigen::ArrayXd left = (signal - dominant_mode_motion_of(fit, interval, signal.size())).array();
  return std::sqrt(left.isFinite().select(left.square(), 0.0).sum() /
                   static_cast<double>(left.isFinite().count()));
}

/// All sines, or the dominant one and as many of its companions as the least squares converge with.
DampedSineFit polish_dominant_mode(const DecimatedSignal& coarse, std::vector<std::complex<double>> rates) {
  for (;; rates.pop_back()) {
    try {
      DampedSineFit fit = fit_damped_sines(coarse.samples, coarse.interval, rates);
      for (DampedSine& sine : fit.sines) sine = undo_decimation(sine, coarse);
      return fit;
    } catch (const std::exception&) {  // no convergence, or too few samples for so many
      if (rates.size() == 1) throw;
    }
  }
}

/// A first fill of missing samples: one damped sine, by least squares of the samples that were measured, from
/// the largest line of the spectrum near the expected frequency and several damping ratios. A realisation of
/// what is bridged straight would see a clipped decay as one that does not decay.
Eigen::VectorXd filled_by_one_sine(const Eigen::VectorXd& signal, double interval, double expected_hz,
                                   double tolerance) {
  const Eigen::VectorXd bridged = bridged_straight(signal);
  const AmplitudeSpectrum spectrum = amplitude_spectrum(bridged, interval);
  double frequency = expected_hz, largest = 0;
  for (Eigen::Index k = 0; k < spectrum.amplitude.size(); ++k)
    if (std::abs(spectrum.frequency_hz[k] / expected_hz - 1) <= tolerance && spectrum.amplitude[k] > largest)
      largest = spectrum.amplitude[k], frequency = spectrum.frequency_hz[k];
  const double w = 2 * std::numbers::pi * frequency;
  DampedSineFit best;
  for (const double ratio : {0.001, 0.003, 0.01, 0.03}) {
    try {
      DampedSineFit fit = fit_damped_sines(signal, interval, {{-ratio * w, w}});
      if (best.sines.empty() || fit.residual_standard_deviation < best.residual_standard_deviation)
        best = std::move(fit);
    } catch (const std::runtime_error&) {  // another start may do
    }
  }
  if (best.sines.empty()) return bridged;
  return signal.array().isFinite().select(signal, dominant_mode_motion_of(best, interval, signal.size()));
}

/// Missing samples take the values of the motion found, which is then found anew, until both stand still: at
/// the least squares of the samples that were measured, behind the decimation's low-pass. The cofactors are
/// those of the measured samples alone.
void fit_measured_samples(const Eigen::VectorXd& signal, double interval, DecimatedSignal& coarse,
                          DampedSineFit& fit) {
  constexpr int most = 300;
  constexpr double settled = 1e-8;  // of the signal
  const auto measured = signal.array().isFinite();
  const double smallest = settled * settled * measured.select(signal, 0.0).squaredNorm();
  std::vector<std::complex<double>> rates(fit.sines.size());
  const auto take_rates = [&] {
    for (std::size_t m = 0; m < rates.size(); ++m) rates[m] = fit.sines[m].rate;
  };
  Eigen::VectorXd before = Eigen::VectorXd::Zero(signal.size());
  for (int i = 0; i < most; ++i) {
    const Eigen::VectorXd filled =
        measured.select(signal, dominant_mode_motion_of(fit, interval, signal.size()));
    const bool still = (filled - before).squaredNorm() <= smallest;
    before = filled;
    take_rates();
    coarse = decimate(filled, interval, coarse.factor);
    fit = polish_dominant_mode(coarse, rates);
    rates.resize(fit.sines.size());
    if (still) break;
  }
  take_rates();
  // samples that were filled leave nothing of the noise
  fit.residual_standard_deviation *=
      std::sqrt(static_cast<double>(signal.size()) / static_cast<double>(measured.count()));
  try {
    fit.cofactors = coarse.factor * fit_damped_sines(signal, interval, rates).cofactors;
  } catch (const std::runtime_error&) {  // higher modes in the way: as if samples were missing at random
    fit.cofactors *= static_cast<double>(signal.size()) / static_cast<double>(measured.count());
  }
}

std::complex<double> rate_of(double frequency_hz, double damping_ratio) {
  return 2 * std::numbers::pi * frequency_hz *
         std::complex<double>(-damping_ratio, std::sqrt(1 - damping_ratio * damping_ratio));
}

}  // namespace

std::complex<double> ModalEstimate::rate() const {
  return rate_of(frequency_hz, damping_ratio);
}

std::complex<double> CompanionMode::rate() const {
  return rate_of(frequency_hz, damping_ratio);
}

ModalEstimate dominant_mode(const Eigen::VectorXd& signal, double interval,
                            const ModalAnalysisSettings& settings) {
  check_dominant_mode(signal, interval, settings);
  const double expected = settings.expected_frequency_hz
                              ? *settings.expected_frequency_hz
                              : strongest_frequency(bridged_straight(signal), interval);
  const int factor = factor_for_cycles(signal.size(), interval, expected, settings.samples_per_cycle);
  const bool whole = signal.allFinite();
  DecimatedSignal coarse =
      decimate(whole ? signal : filled_by_one_sine(signal, interval, expected, settings.frequency_tolerance),
               interval, factor);
  const Realised realised = realise_to_any_damping(coarse, expected, settings);
  DampedSineFit fit = polish_dominant_mode(coarse, realised.rates);
  if (!whole) fit_measured_samples(signal, interval, coarse, fit);

  const DampedSine& sine = fit.sines.front();
  const double w_d = sine.rate.imag(), d = -sine.rate.real(), w = std::abs(sine.rate);
  ModalEstimate estimate;
  estimate.frequency_hz = w / (2 * std::numbers::pi);
  estimate.damping_ratio = d / w;
  estimate.amplitude = std::abs(sine.amplitude);
  estimate.phase = std::arg(sine.amplitude);
  estimate.offset = fit.offset;
  estimate.residual_standard_deviation = residual_standard_deviation(signal, interval, fit);
  estimate.noise_standard_deviation = fit.residual_standard_deviation / coarse.kernel.norm();
  estimate.realised_frequency_hz = realised.dominant.frequency_hz;
  estimate.realised_damping_ratio = realised.dominant.damping_ratio;
  // Noise that passes the kernel unchanged is as dense as white noise of this variance at the new rate.
  const double variance = std::pow(estimate.noise_standard_deviation, 2) / coarse.factor;
  const Eigen::Matrix2d covariance = fit.cofactors.topLeftCorner<2, 2>() * variance;
  const Eigen::Vector2d frequency_slope = Eigen::Vector2d(w_d, d) / (2 * std::numbers::pi * w);
  const Eigen::Vector2d damping_slope = Eigen::Vector2d(-d * w_d, w_d * w_d) / (w * w * w);
  estimate.frequency_standard_deviation_hz = std::sqrt(frequency_slope.dot(covariance * frequency_slope));
  estimate.damping_ratio_standard_deviation = std::sqrt(damping_slope.dot(covariance * damping_slope));
  for (std::size_t i = 1; i < fit.sines.size(); ++i) {
    const DampedSine& other = fit.sines[i];
    estimate.companions.push_back({std::abs(other.rate) / (2 * std::numbers::pi),
                                   -other.rate.real() / std::abs(other.rate), std::abs(other.amplitude)});
  }
  return estimate;
}

}  // namespace beamid::experiments
