#include "experiments/identify/tracking/tracking.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "experiments/identify/tracking/ringing_model.hpp"
#include "experiments/modal/close_pair.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/poles.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/sway.hpp"
#include "experiments/signal/toolbox.hpp"
#include "filters/filter.hpp"
#include "filters/smoother.hpp"

namespace beamid::experiments {

using namespace ringing;

namespace {

using Eigen::Index, Eigen::VectorXd;

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

namespace {

constexpr double first_walk = 0.02;  // [1/sqrt(s)], of the search for changes, and where the tuning starts

// Levels tuned by the likelihood of one span.
struct Levels {
  filters::Noise noise;
  double output_share = std::numeric_limits<double>::infinity();  // standard error of the output's
};

// The beginning of a span, which shows near which maximum its levels lie.
filters::Measurements beginning_of(const filters::Measurements& span) {
  constexpr Index enough = 20'000;  // levels within a hundredth
  if (span.size() <= enough) return span;
  return {span.time.head(enough), span.outputs.leftCols(enough), {}, {}, span.time_resolution};
}

// The likelihood may have a maximum where force moves the mode and another where its stiffness wanders: the
// search begins at both, on the beginning of the span, and goes on with all of it where it has come highest.
Levels tuned(const Ringing& ringing, const filters::Measurements& span, const filters::Gaussian& initial,
             const TrackSettings& settings) {
  constexpr int first_iterations = 8, iterations = 60;
  const auto make_filter = [&](const filters::Noise& noise) { return ringing_filter(ringing, noise); };
  filters::NoiseSettings search;
  search.process_groups = {{ringing::slope}};
  if (!settings.walk) search.process_groups.push_back({ringing::stiffness, ringing::damping});
  search.max_iterations = first_iterations;
  search.tolerance = 1e-3;
  const filters::Measurements beginning = beginning_of(span);
  search.likelihoods = ringing_likelihoods(ringing, beginning, initial);
  std::vector<double> walks{first_walk, 0.01 * first_walk};
  if (settings.walk) walks = {*settings.walk};
  std::optional<filters::NoiseEstimate> best;
  for (const double walk : walks)
    for (const double share : {0.1, 1.0}) {
      search.guess = ringing_noise(ringing, ringing.noise, share * typical_force(ringing), walk);
      filters::NoiseEstimate found = filters::estimate_noise(make_filter, initial, beginning, search);
      if (found.status == filters::NoiseStatus::failed) continue;
      if (!best || found.log_likelihood > best->log_likelihood) best = std::move(found);
    }
  if (!best) return {ringing_noise(ringing, ringing.noise, 0.1 * typical_force(ringing), walks.front())};
  search.guess = best->noise;
  search.max_iterations = iterations;
  search.likelihoods = ringing_likelihoods(ringing, span, initial);
  const filters::NoiseEstimate found = filters::estimate_noise(make_filter, initial, span, search);
  if (found.status != filters::NoiseStatus::failed) best = found;
  return {best->noise, best->relative_deviations[0]};
}

std::vector<filters::Gaussian> smoothed(const Ringing& ringing, const filters::Measurements& span,
                                        const filters::Gaussian& initial, const filters::Noise& noise) {
  const auto smoothed_by = [&](const std::string& method) {
    const auto filter = ringing_filter(ringing, noise, method);
    const filters::FilterRun run = filters::run(*filter, initial, span, filters::Keep::all_estimates);
    if (run.failure) return run.filtered;
    const auto model = ringing_model(ringing.centre_hz, ringing.interval, noise);
    return filters::smooth(run, *model, span).estimates;
  };
  try {
    return smoothed_by("ekf");
  } catch (const filters::FilterFailure&) {  // a covariance that rounding over thousands of cycles has turned
    return smoothed_by("srukf");             // indefinite: a factor cannot become so
  }
}

void enter(const std::vector<filters::Gaussian>& estimates, Index first, double centre_hz, Tracking& result) {
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const VectorXd deviation = estimates[i].deviations();
    const Index k = first + static_cast<Index>(i);
    result.frequency_hz[k] = centre_hz * std::exp(0.5 * estimates[i].mean[ringing::stiffness]);
    result.frequency_deviation[k] = 0.5 * deviation[ringing::stiffness];
    result.damping_ratio[k] = estimates[i].mean[ringing::damping];
    result.damping_ratio_deviation[k] = deviation[ringing::damping];
  }
}

/// The modes of a free decay that are at least a tenth as strong as its strongest, that one first; empty
/// where their residual is larger than 1.5 times that of one damped sine over six cycles.
std::vector<Pole> constant_modes(const Ringing& ringing) {
  constexpr double as_well = 1.5, weakest = 0.1;
  ModalAnalysisSettings settings;
  settings.companion_amplitude = weakest;
  const Eigen::MatrixXd record = ringing.signal.transpose();
  JointDecayFit fit = fit_with_companions(record, ringing.interval,
                                          dominant_mode(ringing.signal, ringing.interval, settings));
  if (const auto pair = close_pair(record, ringing.interval, fit, 0); pair && pair->wins) fit = pair->fit;
  if (fit.residual_standard_deviation[0] > as_well * ringing.noise) return {};
  std::vector<Pole> modes;
  for (std::size_t m = 0; m < fit.rates.size(); ++m) modes.push_back(fitted_pole(fit, m));
  std::ranges::sort(modes, std::ranges::greater(), [](const Pole& mode) { return mode.shape.norm(); });
  std::erase_if(modes, [least = weakest * modes.front().shape.norm()](const Pole& mode) {
    return mode.shape.norm() < least;
  });
  return modes;
}

/// What the changes of one mode are where two of constant frequency explain the record as a whole.
std::string beat_sentence(const Ringing& ringing, const std::vector<Plateau>& plateaus) {
  if (plateaus.size() == 1 && !plateaus.front().companions_hz.empty()) return {};  // both are fitted there
  try {
    const std::vector<Pole> modes = constant_modes(ringing);
    if (modes.size() < 2) return {};
    return fmt::format(
        "Modes of constant frequency, the strongest at {:.4g} and {:.4g} Hz, explain the whole record: what "
        "one mode would do in time is their beat. beamid modal lists each of them.",
        modes[0].frequency_hz(), modes[1].frequency_hz());
  } catch (const std::exception&) {
    return {};  // no decay of constant modes
  }
}

/// Where two modes win, the stronger is followed and the other rings beside it. Where neither one nor two do,
/// the distances of both count as uncertainty, each by its share of the stronger.
void take_pair(const ClosePair& pair, Plateau& plateau) {
  Pole strong = pair.low(), weak = pair.high();
  if (strong.shape.norm() < weak.shape.norm()) std::swap(strong, weak);
  if (pair.wins) {
    plateau.modal_frequency_hz = strong.frequency_hz(), plateau.modal_damping_ratio = strong.damping_ratio();
    plateau.companions_hz.push_back(weak.frequency_hz());
    return;
  }
  if (!pair.speaks_against_one()) return;  // the walk follows a drift
  if (pair.is_indeterminate()) plateau.one_or_two = pair.sentence(plateau.frequency_hz);
  const PairSpread spread = pair.spread_about(plateau.frequency_hz, plateau.damping_ratio);
  plateau.frequency_deviation_hz = std::hypot(plateau.frequency_deviation_hz, spread.frequency_hz);
  plateau.damping_ratio_deviation = std::hypot(plateau.damping_ratio_deviation, spread.damping_ratio);
}

// What a beat with a mode nearby does to a wandering frequency, no wandering explains: there the modal
// analysis, which fits both modes, tells how far the mean may be off.
void compare_with_modal_analysis(const Ringing& ringing, Plateau& plateau) {
  constexpr double beyond = 3.0;  // deviations
  plateau.modal_frequency_hz = plateau.modal_damping_ratio = std::numeric_limits<double>::quiet_NaN();
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = plateau.frequency_hz;
  settings.frequency_tolerance = 0.03;
  settings.companion_amplitude = 0.02;
  try {
    const VectorXd span = ringing.signal.segment(plateau.first, plateau.last - plateau.first + 1);
    const ModalEstimate modal = dominant_mode(span, ringing.interval, settings);
    plateau.modal_frequency_hz = modal.frequency_hz, plateau.modal_damping_ratio = modal.damping_ratio;
    for (const CompanionMode& mode : modal.companions) plateau.companions_hz.push_back(mode.frequency_hz);
    if (const auto decay = fitted_decay(span, ringing.interval, modal))
      if (const auto pair = close_pair(*decay)) take_pair(*pair, plateau);
  } catch (const std::exception&) {
    return;  // too short, or no decay of constant stiffness: the plateau stands alone
  }
  // By what exceeds them: where it is about as large, rounding must not decide on the interval. Beside
  // another mode, which only the modal analysis fits, by all of it.
  const double allowed = plateau.companions_hz.empty() ? beyond : 0;
  const auto widen = [&](double difference, double& deviation) {
    const double excess = difference * difference - std::pow(allowed * deviation, 2);
    deviation = std::sqrt(deviation * deviation + std::max(0.0, excess));
  };
  widen(plateau.frequency_hz - plateau.modal_frequency_hz, plateau.frequency_deviation_hz);
  widen(plateau.damping_ratio - plateau.modal_damping_ratio, plateau.damping_ratio_deviation);
}

// A walk [1/sqrt(s)] of ln K, or zero where over the span [s] it moves it by next to nothing beside the
// deviation of the mean: the likelihood is flat there, and rounding would be printed.
double significant_walk(double walk, double span, double deviation) {
  constexpr double next_to_nothing = 0.1;
  return walk * std::sqrt(span) < next_to_nothing * deviation ? 0.0 : walk;
}

Plateau plateau_of(const Ringing& ringing, const std::vector<filters::Gaussian>& estimates, Index first,
                   const Levels& levels) {
  Plateau plateau;
  plateau.first = first, plateau.last = first + static_cast<Index>(estimates.size()) - 1;
  plateau.from = ringing.time[plateau.first], plateau.to = ringing.time[plateau.last];
  const double span = plateau.to - plateau.from;
  const filters::Gaussian& end = estimates.back();
  const VectorXd deviation = end.deviations();
  plateau.frequency_hz = ringing.centre_hz * std::exp(0.5 * end.mean[ringing::stiffness_integral] / span);
  plateau.frequency_deviation_hz = plateau.frequency_hz * 0.5 * deviation[ringing::stiffness_integral] / span;
  plateau.damping_ratio = end.mean[ringing::damping_integral] / span;
  plateau.damping_ratio_deviation = deviation[ringing::damping_integral] / span;
  const double w = 2.0 * std::numbers::pi * plateau.frequency_hz;
  const auto amplitude = [&](const filters::Gaussian& estimate) {
    return std::hypot(estimate.mean[ringing::signal], estimate.mean[ringing::slope] / w);
  };
  plateau.amplitude_from = amplitude(estimates.front()), plateau.amplitude_to = amplitude(end);
  compare_with_modal_analysis(ringing, plateau);
  plateau.noise = std::sqrt(levels.noise.output(0, 0));
  plateau.noise_relative_deviation = levels.output_share;
  plateau.walk = significant_walk(
      std::sqrt(levels.noise.process(ringing::stiffness, ringing::stiffness) / ringing.interval), span,
      2.0 * plateau.frequency_deviation_hz / plateau.frequency_hz);
  plateau.force = std::sqrt(levels.noise.process(ringing::slope, ringing::slope) / ringing.interval);
  return plateau;
}

Ringing ringing_in(const DecimatedSignal& low, double start, const std::pair<double, double>& band_hz) {
  const Index samples = low.samples.size();
  return {start + low.start +
              low.interval * VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1)).array(),
          low.samples,
          low.interval,
          band_hz,
          std::sqrt(band_hz.first * band_hz.second),
          0.0};
}

/// Of what moves below the band, where it is more than noise, the root mean square; `ringing` is then without
/// it. Its noise is found in either case.
double take_out_sway(Ringing& ringing, double shortest_cycles) {
  constexpr double share = 0.5;  // of the noise; of white noise 0.2 lie below the band
  const double period = 1 / ringing.centre_hz;
  const DecimatedSignal low{ringing.signal, ringing.interval, ringing.time[0], 1, {}};
  const DecimatedSignal freed = without_sway(without_sway(low, period), period);
  const VectorXd slow = sway({sway(low, 2 * period), low.interval, 0, 1, {}}, 2 * period);
  if (slow.size() > 0 && freed.samples.size() >= ringing.cycles(2 * shortest_cycles)) {
    Ringing without = ringing_in(freed, 0, ringing.band_hz);
    without.noise = typical_noise(without);
    const double sways = std::sqrt((slow.array() - slow.mean()).square().mean());
    if (sways > share * without.noise) {
      ringing = std::move(without);
      return sways;
    }
  }
  ringing.noise = typical_noise(ringing);
  return 0;
}

void check_tracking(const TrackSettings& settings, double interval) {
  const double highest = 0.5 / interval;
  if (settings.band_hz &&
      !(settings.band_hz->first > 0 && settings.band_hz->first < settings.band_hz->second &&
        settings.band_hz->second < highest))
    throw std::invalid_argument("band; expected 0 < from < to < " + std::to_string(highest) +
                                " Hz, half the sampling rate");
  if (settings.walk && !(*settings.walk >= 0 && std::isfinite(*settings.walk)))
    throw std::invalid_argument("walk; expected a number >= 0 [1/sqrt(s)]");
  if (!(settings.false_alarms > 0 && settings.false_alarms < 1))
    throw std::invalid_argument("false_alarms; expected a probability above 0 and below 1");
  if (!(settings.shortest_cycles >= 3)) throw std::invalid_argument("shortest_cycles; expected 3 at least");
}

}  // namespace

std::pair<double, double> track_band(const VectorXd& signal, double interval) {
  constexpr Index spans = 32, shortest = 16;
  const Index count = signal.size() / spans;
  if (count < shortest)
    throw std::invalid_argument("signal of " + std::to_string(signal.size()) +
                                " samples; expected 512 at least, or a band");
  std::vector<double> frequencies;
  for (Index i = 0; i < spans; ++i) {
    const VectorXd span = signal.segment(i * count, count);
    if (span.maxCoeff() > span.minCoeff()) frequencies.push_back(strongest_frequency(span, interval));
  }
  if (frequencies.empty()) throw std::invalid_argument("signal; expected one that varies");
  const double middle = median(frequencies);
  return {0.5 * middle, std::min(2.0 * middle, 0.45 / interval)};
}

Tracking track(const VectorXd& signal, double start, double interval, const TrackSettings& settings,
               const Progress& progress) {
  check_tracking(settings, interval);
  const auto say = [&](const std::string& words) {
    if (progress) progress(words);
  };
  Tracking result;
  result.band_hz = settings.band_hz ? *settings.band_hz : track_band(signal, interval);
  const int factor = decimation_factor(0.3 / (result.band_hz.second * interval), signal.size());
  Ringing ringing = ringing_in(decimate(signal, interval, factor), start, result.band_hz);
  if (ringing.size() < ringing.cycles(2 * settings.shortest_cycles))
    throw std::invalid_argument("signal of fewer than " + std::to_string(2 * settings.shortest_cycles) +
                                " cycles at the middle of the band");
  result.sway = take_out_sway(ringing, settings.shortest_cycles);
  result.decimation = factor, result.interval = ringing.interval, result.noise = ringing.noise;
  result.time = ringing.time, result.signal = ringing.signal;
  const Index samples = ringing.size();
  say("seeking changes");
  const Segments segments = find_segments(ringing, settings.walk.value_or(first_walk), settings.false_alarms);
  result.threshold = segments.threshold, result.test_samples = segments.test_samples;
  result.alarms.assign(segments.begins.begin() + 1, segments.begins.end());

  for (VectorXd* history : {&result.frequency_hz, &result.frequency_deviation, &result.damping_ratio,
                            &result.damping_ratio_deviation})
    *history = VectorXd::Constant(samples, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < segments.begins.size(); ++i) {
    const Index first = segments.begins[i];
    const Index last = (i + 1 < segments.begins.size() ? segments.begins[i + 1] : samples) - 1;
    const filters::Measurements span = ringing.span(first, last);
    const filters::Gaussian initial = fresh_estimate(ringing, first);
    if (last - first < 1) {
      enter({initial}, first, ringing.centre_hz, result);
      continue;
    }
    const bool plateau = last - first + 1 >= ringing.cycles(settings.shortest_cycles);
    if (plateau) say("plateau " + std::to_string(result.plateaus.size() + 1));
    const Levels levels = plateau ? tuned(ringing, span, initial, settings)
                                  : Levels{ringing_noise(ringing, ringing.noise, typical_force(ringing),
                                                         settings.walk.value_or(first_walk))};
    const auto estimates = smoothed(ringing, span, initial, levels.noise);
    enter(estimates, first, ringing.centre_hz, result);
    if (plateau && std::ssize(estimates) == last - first + 1)
      if (Plateau found = plateau_of(ringing, estimates, first, levels); found.rings())
        result.plateaus.push_back(std::move(found));
  }
  result.beat = beat_sentence(ringing, result.plateaus);
  return result;
}

}  // namespace beamid::experiments
