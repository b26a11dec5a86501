#include "experiments/identify/decay_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "experiments/identify/analysis.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/record/prepare/analysable_record.hpp"
#include "experiments/signal/local_motion.hpp"
#include "experiments/signal/median.hpp"
#include "experiments/signal/onsets.hpp"

namespace beamid::experiments {
namespace {

constexpr double trial = 16, least = 8;  // periods of the expected mode
constexpr double time_constants = 2;

enum class Beginning { at_rest, moving, starting_up };

/// Deviations from the straight line through a signal.
Eigen::ArrayXd without_line(const Eigen::VectorXd& signal) {
  const Eigen::ArrayXd at = Eigen::ArrayXd::LinSpaced(signal.size(), -1, 1),
                       deviation = signal.array() - signal.mean();
  return deviation - at * ((at * deviation).sum() / at.square().sum());
}

/// By the first sixteenth of a period: near the middle of the signal it is at rest; what is far from it and
/// does not swing to the other side within four fifths of a period is a sensor that starts, or a deflection
/// that is held.
Beginning beginning_of(const Eigen::VectorXd& signal, double samples_per_period) {
  constexpr double far = 0.25, swing = 0.3, periods = 0.8, few = 1.0 / 16;
  const Eigen::ArrayXd drifting = without_line(signal),
                       deviation = drifting - median(Eigen::VectorXd(drifting));
  const auto samples = [&](double count) {
    return std::clamp(static_cast<Eigen::Index>(std::ceil(count * samples_per_period)), Eigen::Index{3},
                      deviation.size());
  };
  const double first = deviation.head(3).mean();
  if (deviation.head(samples(few)).abs().maxCoeff() <= far * deviation.abs().maxCoeff())
    return Beginning::at_rest;
  const double opposite =
      -(first > 0 ? deviation : Eigen::ArrayXd(-deviation)).head(samples(periods)).minCoeff();
  return opposite > swing * std::abs(first) ? Beginning::moving : Beginning::starting_up;
}

/// Where the motion grows: from its least amplitude since the last rise to its greatest.
struct Rise {
  double low = 0, peak = 0;  ///< instants [s], from the first sample
};

/// A rise is to four times the least amplitude before it and to a tenth of the largest of all. A decay has
/// none; two modes that beat may have one.
std::vector<Rise> rises_of(const LocalMotion& motion) {
  constexpr double growth = 4, smallest = 0.1;
  constexpr Eigen::Index ahead = 8;  // two periods
  std::vector<Rise> rises;
  const Eigen::VectorXd& size = motion.amplitude;
  for (Eigen::Index k = 0, low = 0; k < size.size(); ++k) {
    if (size[k] < size[low]) low = k;
    if (!(size[k] > growth * size[low] && size[k] > smallest * size.maxCoeff())) continue;
    for (Eigen::Index step = 1; step > 0; k += step)
      size.segment(k, std::min(ahead, size.size() - k)).maxCoeff(&step);
    rises.push_back({motion.time[low], motion.time[k]});
    low = k;
  }
  return rises;
}

/// When the offset has settled that a sensor begins with [s], from the first sample: from there on it changes
/// by less than 3 % of the amplitude in a period.
double settled_from(const LocalMotion& motion) {
  constexpr double still = 0.03;
  constexpr auto period = static_cast<Eigen::Index>(LocalMotion::windows_per_period);
  const Eigen::Index count = motion.time.size();
  const double amplitude = motion.amplitude.tail(count - count / 10).maxCoeff();
  Eigen::Index k = 0;
  while (k < count / 2 && k + period < count &&
         std::abs(motion.offset[k + period] - motion.offset[k]) > still * amplitude)
    ++k;
  return motion.time[k];
}

struct DecayEvent {
  double time = 0;  ///< [s], from the first sample
  DecayWindow::Behind kind = DecayWindow::Behind::event;
};

/// The last hit or release: the last onset, but behind a start-up only where the motion at the mode's
/// frequency grows too. A hand that lets go slowly has no onset: the motion is then largest behind it.
std::optional<DecayEvent> last_event(const Eigen::VectorXd& signal, double interval, double period) {
  OnsetSettings settings;
  settings.apart = std::max(settings.apart, 2 * period);
  const Onsets onsets = find_onsets(signal, interval, settings);
  const Beginning beginning = beginning_of(signal, period / interval);
  const LocalMotion motion = local_motion(signal, interval, 1 / period);
  const bool sudden = !onsets.samples.empty();
  const double onset = sudden ? interval * static_cast<double>(onsets.samples.back()) : 0.0;
  if (motion.time.size() == 0 || (sudden && beginning != Beginning::starting_up))
    return sudden ? std::optional(DecayEvent{onset}) : std::nullopt;
  if (beginning == Beginning::moving) return {};
  if (beginning == Beginning::at_rest) {
    Eigen::Index largest = 0;
    motion.amplitude.maxCoeff(&largest);
    return DecayEvent{motion.time[largest]};
  }
  const std::vector<Rise> rises = rises_of(motion);
  if (rises.empty()) return DecayEvent{settled_from(motion), DecayWindow::Behind::start_up};
  return DecayEvent{sudden && onset >= rises.back().low - 2 * period ? onset : rises.back().peak};
}

/// The mode in the beginning of the record behind an instant; nothing where none is near the expected one:
/// what the identification says of it is clearer.
std::optional<ModalEstimate> mode_behind(const Record& record, double from, double period) {
  const Record beginning =
      record.window(from, std::min(record.time[record.size() - 1], from + trial * period));
  ModalAnalysisSettings expected;
  expected.expected_frequency_hz = 1 / period;
  try {
    return dominant_mode(beginning.samples.row(0).transpose(), record.interval(), expected);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

std::string DecayWindow::words() const {
  return fmt::format(
      "No window was given: identified is the decay from {:.4g} to {:.4g} s, from {:g} periods behind {}, at "
      "{:.4g} s, over two time constants of {:.3g} s. record.window_s or --window takes the place of this.",
      from, to, settling,
      behind == Behind::start_up ? "the end of the sensor's start-up"
      : behind == Behind::gap    ? "a gap"
                                 : "the last event",
      event, time_constant);
}

std::optional<DecayWindow> decay_window(const Experiment& experiment, const Record& whole) {
  const Record record = analysable(whole).record;
  const double last = record.time[record.size() - 1];
  const double period = 1 / described_frequency_hz(experiment, record);
  auto happened = last_event(record.samples.row(0).transpose(), record.interval(), period);
  const bool begins_behind_gap = record.time[0] > whole.time[0] + record.interval();
  if (!happened && begins_behind_gap) happened = DecayEvent{0.0, DecayWindow::Behind::gap};
  if (!happened) return {};
  const double event = record.time[0] + happened->time;
  std::optional<DecayWindow> window;
  for (const double settling : {3.0, 6.0, 12.0}) {
    const double from = event + settling * period;
    if (last - from < least * period) break;
    const auto mode = mode_behind(record, from, period);
    if (!mode || !(mode->rate().real() < 0)) continue;
    const double time_constant = -1 / mode->rate().real();
    const double to = from + std::max(time_constants * time_constant, least * period);
    window = {event, settling, from, std::min(last, to), time_constant, happened->kind};
    if (mode->companions.empty()) break;
  }
  return window;
}

}  // namespace beamid::experiments
