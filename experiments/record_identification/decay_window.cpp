#include "experiments/record_identification/decay_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/modal_analysis/dominant_mode.hpp"
#include "experiments/preparation/analysable_record.hpp"
#include "experiments/record_identification/record_identification.hpp"
#include "experiments/signal/onsets.hpp"

namespace beamid::experiments {
namespace {

constexpr double trial = 16, least = 8;  // periods of the expected mode
constexpr double time_constants = 2;

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
      "No window was given: identified is the decay from {:.4g} to {:.4g} s, from {:g} periods behind the "
      "last event, at {:.4g} s, over two time constants of {:.3g} s. record.window_s or --window takes the "
      "place of this.",
      from, to, settling, event, time_constant);
}

std::optional<DecayWindow> decay_window(const Experiment& experiment, const Record& whole) {
  const Record record = analysable(whole).record;
  const double last = record.time[record.size() - 1];
  const double period = 1 / expected_frequency_hz(experiment, record);
  OnsetSettings settings;
  settings.apart = std::max(settings.apart, 2 * period);
  const Onsets onsets = find_onsets(record.samples.row(0).transpose(), record.interval(), settings);
  if (onsets.samples.empty()) return {};
  const double event = record.time[onsets.samples.back()];
  std::optional<DecayWindow> window;
  for (const double settling : {3.0, 6.0, 12.0}) {
    const double from = event + settling * period;
    if (last - from < least * period) break;
    const auto mode = mode_behind(record, from, period);
    if (!mode || !(mode->rate().real() < 0)) continue;
    const double time_constant = -1 / mode->rate().real();
    const double to = from + std::max(time_constants * time_constant, least * period);
    window = {event, settling, from, std::min(last, to), time_constant};
    if (mode->companions.empty()) break;
  }
  return window;
}

}  // namespace beamid::experiments
