#include "experiments/identify/sound_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/identify/analysis.hpp"
#include "experiments/modal/decay_jump.hpp"
#include "experiments/record/prepare/analysable_record.hpp"

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

}  // namespace

std::optional<SoundPart> sound_part(const Experiment& experiment, const Record& whole,
                                    const std::vector<RecordDefect>& defects) {
  const Record record = analysable(whole).record;
  const double period = 1 / described_frequency_hz(experiment, record);
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
                   fmt::format("{}: identified is the part from {:.4g} to {:.4g} s.", reason_of(breaks),
                               part->from, part->to)};
}

}  // namespace beamid::experiments
