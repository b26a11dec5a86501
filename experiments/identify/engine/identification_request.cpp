#include "experiments/identify/engine/identification_request.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "experiments/identify/engine/analysis.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/modal/decay_jump.hpp"
#include "experiments/modal/dominant_mode.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/onsets.hpp"
#include "experiments/signal/sway.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/choice.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

constexpr double least_periods = 8;

/// A stretch that a part may not hold [s].
struct Break {
  double from = 0, to = 0;
  std::string words = {};
};

std::vector<Break> clipped_stretches(const std::vector<RecordDefect>& defects, double period) {
  std::vector<Break> breaks;
  for (const RecordDefect& defect : defects) {
    if (!defect.clipped) continue;
    for (const auto& [first, last] : defect.spans) breaks.push_back({first - period, last + period});
  }
  return breaks;
}

struct Part {
  double from = 0, to = 0;
};

/// On frequency and damping, but for a factor: energy of the first channel times squared length.
double information_in(const Record& record, const Part& part) {
  double energy = 0;
  for (Index k = 0; k < record.size(); ++k)
    if (record.time[k] >= part.from && record.time[k] <= part.to)
      energy += record.samples(0, k) * record.samples(0, k);
  return energy * (part.to - part.from) * (part.to - part.from);
}

/// Nothing where all are shorter than eight periods.
std::optional<Part> best_between(const Record& record, std::vector<Break> breaks, double period) {
  std::sort(breaks.begin(), breaks.end(), [](const Break& a, const Break& b) { return a.from < b.from; });
  const double last = record.time[record.size() - 1];
  breaks.push_back({last, last});
  std::optional<Part> best;
  double from = record.time[0], most = 0;
  for (const Break& one : breaks) {
    const Part part{from, one.from};
    from = std::max(from, one.to);
    if (!(part.to - part.from >= least_periods * period)) continue;
    if (const double here = information_in(record, part); here > most) most = here, best = part;
  }
  return best;
}

std::optional<Break> jump_in(const Record& record, const Part& part, double period) {
  const Record decay = record.window(part.from, part.to);
  const Eigen::VectorXd signal = decay.samples.row(0).transpose();
  ModalAnalysisSettings expected;
  expected.expected_frequency_hz = 1 / period;
  try {
    const auto jump = decay_jump(signal, decay.interval(), dominant_mode(signal, decay.interval(), expected));
    if (!jump) return {};
    const double at = decay.time[0] + jump->time();
    Break found{at - period, at + period, fmt::format(" {:.4g} s {}", at, jump->words())};
    if (const FrequencyJump* const frequency = jump->frequency()) {  // on one side time runs at another rate
      const auto off = [&](double hz) { return std::abs(std::log(hz * period)); };
      if (off(frequency->behind_hz) > off(frequency->before_hz))
        found.to = part.to;
      else
        found.from = part.from;
    }
    return found;
  } catch (const std::exception&) {  // no mode there, or a part too short for it
    return {};
  }
}

/// "Readings are clipped, and at 8 s the motion jumps, by ..."
std::string reason_of(const std::vector<Break>& breaks) {
  std::string text = breaks.front().words.empty() ? "Readings are clipped" : "";
  for (const Break& one : breaks)
    if (!one.words.empty()) text += (text.empty() ? "At" : ", and at") + one.words;
  return text;
}

/// Of the mode that is described, as the record shows it: above half its sampling rate an alias [s].
double period_shown(const Experiment& experiment, const Record& record) {
  return 1.0 / shown_at(described_frequency_hz(experiment, record), 1.0 / record.interval());
}

}  // namespace

std::optional<SoundPart> sound_part(const Experiment& experiment, const Record& whole,
                                    const std::vector<RecordDefect>& defects) {
  const Record record = analysable(whole).record;
  const double period = period_shown(experiment, record);
  std::vector<Break> breaks = clipped_stretches(defects, period);
  const auto reaches = [&](const Break& one) {
    return one.to - period >= record.time[0] && one.from + period <= record.time[record.size() - 1];
  };
  std::erase_if(breaks, [&](const Break& one) { return !reaches(one); });
  std::optional<Part> part = best_between(record, breaks, period);
  while (part) {
    const auto jump = jump_in(record, *part, period);
    if (!jump) break;
    breaks.push_back(*jump);
    part = best_between(record, breaks, period);
  }
  if (!part || breaks.empty()) return {};
  return SoundPart{part->from, part->to,
                   fmt::format("{}: identified is the part from {} to {} s.", reason_of(breaks),
                               instant_text(part->from), instant_text(part->to))};
}

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
  ModalAnalysisSettings expected;
  expected.expected_frequency_hz = 1 / period;
  try {
    const Record beginning =
        record.window(from, std::min(record.time[record.size() - 1], from + trial * period));
    return dominant_mode(beginning.samples.row(0).transpose(), record.interval(), expected);
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace

std::string DecayWindow::words() const {
  return fmt::format(
      "Window chosen automatically: the decay from {} to {} s, from {:g} periods behind {}, at "
      "{} s, over two time constants of {:.3g} s. record.window_s or --window takes the place of this.",
      instant_text(from), instant_text(to), settling,
      behind == Behind::start_up ? "the end of the sensor's start-up"
      : behind == Behind::gap    ? "a gap"
                                 : "the last event",
      instant_text(event), time_constant);
}

std::optional<DecayWindow> decay_window(const Experiment& experiment, const Record& whole) {
  const Record record = analysable(whole).record;
  const double last = record.time[record.size() - 1];
  const double period = period_shown(experiment, record);
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

bool IdentificationRequest::is_free_oscillator() const {
  return asks_free_oscillator(experiment, prepared.record);
}

PreparedRecord IdentificationRequest::as_analysed() const {
  PreparedRecord result = prepared;
  if (const std::string remark = analysable(prepared.record).remark; !remark.empty())
    result.record.remarks.push_back("For the modal analysis and first estimates: " + remark);
  return result;
}

ComparedRecord IdentificationRequest::compared() const {
  ComparedRecord record = measured_record(file.filename().string(), prepared.record);
  if (experiment.noise_method.name == "before_event")  // of the whole record behind its preparation
    record.quiet_noise = at_place(experiment.noise_method.place, [&] {
      return noise_before_event(prepare(prepared.raw, experiment.format.preparation));
    });
  return record;
}

std::vector<std::string> IdentificationRequest::decisions() const {
  std::vector<std::string> said;
  if (!window.empty()) said.push_back(window);
  if (thinned)
    said.push_back(
        "Higher modes are a large part of this record, and a filter of one mode takes them for white noise. "
        "The record was low-passed and decimated first. [[record.prepare]] of the experiment file replaces "
        "this step.");
  return said;
}

namespace {

// Whether higher modes are noise to the model, as they are to one degree of freedom.
bool is_beam_of_one_mode(const IdentificationRequest& one, const Choice& reduction) {
  const auto& options = reduction.options.values();
  const auto modes = options.find("modes");
  const bool single = reduction.name == "rayleigh" ||
                      (reduction.name == "modal_truncation" &&
                       (modes == options.end() || modes->second == filters::OptionValue(1.0)));
  return one.experiment.model.name == "beam" && single && input_channels(one.prepared.record).empty();
}

}  // namespace

void cut_decay(IdentificationRequest& one) {
  RecordFormat& format = one.experiment.format;
  const bool driven = !input_channels(one.prepared.record).empty() || !one.experiment.unknown_forces.empty();
  if (format.window || driven) return;
  Record& record = one.prepared.record;
  if (const auto window = decay_window(one.experiment, record)) {
    format.window = {window->from, window->to};
    one.window = window->words();
  }
  const Record decay = format.window ? record.window(format.window->first, format.window->second) : record;
  if (const auto part = sound_part(one.experiment, decay, one.prepared.defects)) {
    format.window = {part->from, part->to};
    one.window += one.window.empty() ? "Window chosen automatically. " + part->words +
                                           " record.window_s or --window takes the place of this."
                                     : " " + part->words;
  }
  if (format.window) one.prepared.take(record, format, one.file);
}

void keep_out_higher_modes(IdentificationRequest& one, const std::vector<Choice>& reductions) {
  RecordFormat& format = one.experiment.format;
  if (!format.preparation.empty() || !one.experiment.unknown_forces.empty()) return;
  const std::vector<Choice> asked = reductions.empty() ? std::vector{one.experiment.reduction} : reductions;
  if (!one.is_free_oscillator() &&
      !std::all_of(asked.begin(), asked.end(), [&](const Choice& c) { return is_beam_of_one_mode(one, c); }))
    return;
  Experiment oscillator = one.experiment;  // the same question, whatever model asks it
  oscillator.model = {"sdof", model_registry().completed("sdof", {})};
  oscillator.parameters.clear();
  const auto step = step_against_higher_modes(oscillator, one.prepared.record);
  if (!step) return;
  format.preparation = {*step};
  Record left = prepare(one.prepared.raw, format.preparation, format.window);
  if (auto& window = format.window)  // the low-pass takes a little of both ends
    window = {std::max(window->first, left.time[0]), std::min(window->second, left.time[left.size() - 1])};
  one.prepared.take(std::move(left), format, one.file);
  one.thinned = true;
}

}  // namespace beamid::experiments
