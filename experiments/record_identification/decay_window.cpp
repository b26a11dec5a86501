#include "experiments/record_identification/decay_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "experiments/modal_analysis/dominant_mode.hpp"
#include "experiments/preparation/analysable_record.hpp"
#include "experiments/record_identification/record_identification.hpp"
#include "experiments/signal/local_motion.hpp"
#include "experiments/signal/onsets.hpp"

namespace beamid::experiments {
namespace {

constexpr double trial = 16, least = 8;  // periods of the expected mode
constexpr double time_constants = 2;

/// Where the motion grows: from its least amplitude since the last rise to its greatest.
struct Rise {
  double low = 0, peak = 0;  ///< instants [s], from the first sample
};

/// A rise is to four times the least amplitude before it and to a tenth of the largest of all. A decay has
/// none, nor has a start-up, which begins large.
std::vector<Rise> rises_of(const LocalMotion& motion) {
  constexpr double growth = 4, smallest = 0.1;
  constexpr Eigen::Index ahead = 8;  // two periods
  std::vector<Rise> rises;
  const Eigen::VectorXd& size = motion.amplitude;
  for (Eigen::Index k = 0, low = 0; k < size.size(); ++k) {
    if (size[k] < size[low]) low = k;
    if (!(size[k] > growth * size[low] && size[k] > smallest * size.maxCoeff())) continue;
    for (Eigen::Index better = k; better >= 0;) {
      Eigen::Index at = 0;
      const Eigen::Index count = std::min(ahead, size.size() - k);
      size.segment(k, count).maxCoeff(&at);
      better = at > 0 ? k + at : -1;
      k += at;
    }
    rises.push_back({motion.time[low], motion.time[k]});
    low = k;
  }
  return rises;
}

/// When the offset has settled that a sensor begins with [s], from the first sample; 0 where it does not
/// move: from there on it changes by less than 3 % of the amplitude in a period.
double settled_from(const LocalMotion& motion) {
  constexpr double still = 0.03;
  constexpr auto period = static_cast<Eigen::Index>(LocalMotion::windows_per_period);
  const Eigen::Index count = motion.time.size(), latest = count / 2;
  const double amplitude = motion.amplitude.tail(count - count / 10).maxCoeff();
  double settled = 0;
  for (Eigen::Index k = 0; k < latest && k + period < count; ++k) {
    if (std::abs(motion.offset[k + period] - motion.offset[k]) <= still * amplitude) break;
    settled = motion.time[k + period];
  }
  return settled;
}

/// The last hit or release [s], from the first sample: that of the onsets, where the motion at the mode's
/// frequency grows too or behind it, else the end of that growth: a hand that lets go slowly has no onset,
/// and what an instrument does while it starts moves nothing.
std::optional<double> last_event(const Eigen::VectorXd& signal, double interval, double period,
                                 const LocalMotion& motion) {
  OnsetSettings settings;
  settings.apart = std::max(settings.apart, 2 * period);
  const Onsets onsets = find_onsets(signal, interval, settings);
  const std::vector<Rise> rises = rises_of(motion);
  for (auto onset = onsets.samples.rbegin(); onset != onsets.samples.rend(); ++onset) {
    const double at = interval * static_cast<double>(*onset);
    for (const Rise& rise : rises)
      if (at >= rise.low - 2 * period) return at;
  }
  if (!rises.empty()) return rises.back().peak;
  if (onsets.samples.empty()) return {};
  return interval * static_cast<double>(onsets.samples.back());  // too early for a rise to be seen
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
      from, to, settling, start_up ? "the end of the sensor's start-up" : "the last event", event,
      time_constant);
}

std::optional<DecayWindow> decay_window(const Experiment& experiment, const Record& whole) {
  const Record record = analysable(whole).record;
  const double last = record.time[record.size() - 1];
  const double period = 1 / expected_frequency_hz(experiment, record);
  const Eigen::VectorXd signal = record.samples.row(0).transpose();
  const LocalMotion motion = local_motion(signal, record.interval(), 1 / period);
  if (motion.time.size() == 0) return {};
  const double settled = settled_from(motion);
  const double happened = last_event(signal, record.interval(), period, motion).value_or(0.0);
  if (!(std::max(settled, happened) > 0)) return {};
  const bool start_up = settled > happened;
  const double event = record.time[0] + std::max(settled, happened);
  std::optional<DecayWindow> window;
  for (const double settling : {3.0, 6.0, 12.0}) {
    const double from = event + settling * period;
    if (last - from < least * period) break;
    const auto mode = mode_behind(record, from, period);
    if (!mode || !(mode->rate().real() < 0)) continue;
    const double time_constant = -1 / mode->rate().real();
    const double to = from + std::max(time_constants * time_constant, least * period);
    window = {event, settling, from, std::min(last, to), time_constant, start_up};
    if (mode->companions.empty()) break;
  }
  return window;
}

}  // namespace beamid::experiments
