#include "experiments/record/inspect/defects.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <iterator>
#include <limits>
#include <numbers>
#include <vector>

#include <unsupported/Eigen/FFT>

#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {

namespace {

/// Visits neighbouring samples of one value, in order; NaN is one value. They are as many as samples in most
/// signals, and are therefore not kept.
template <class Visit>
void for_each_run(const std::vector<double>& signal, const Visit& visit) {
  for (std::size_t first = 0, end; first < signal.size(); first = end) {
    const bool missing = std::isnan(signal[first]);
    for (end = first + 1; end < signal.size(); ++end)
      if (!(signal[end] == signal[first] || (missing && std::isnan(signal[end])))) break;
    visit(Run{first, end - first, signal[first]});
  }
}

/// Those that `wanted` accepts.
template <class Wanted>
std::vector<Run> runs_where(const std::vector<double>& signal, const Wanted& wanted) {
  std::vector<Run> runs;
  for_each_run(signal, [&](const Run& run) {
    if (wanted(run)) runs.push_back(run);
  });
  return runs;
}

constexpr double jump = 4;  // smallest steps

/// Whether the signal differs from the run's value by at least `least`, just before it and just behind it.
struct Ends {
  bool before = false, after = false;
};

Ends jumps(const std::vector<double>& signal, const Run& run, double least) {
  const auto far = [&](std::size_t sample) { return std::abs(signal[sample] - run.value) >= least; };
  const std::size_t after = run.first + run.length;
  return {run.first > 0 && far(run.first - 1), after < signal.size() && far(after)};
}

/// Of the finite values, one at least.
struct RunSpread {
  explicit RunSpread(const std::vector<double>& signal) {
    std::vector<double> values = finite(signal);
    lowest = *std::min_element(values.begin(), values.end());
    highest = *std::max_element(values.begin(), values.end());
    middle = median(std::move(values));
  }
  double lowest, highest, middle;
};

/// Samples from a run to where the signal crosses `middle`, in steps of `direction`; to its end at most.
double way_to(const std::vector<double>& signal, std::size_t from, int direction, double middle) {
  const bool above = signal[from] > middle;
  double way = 0;
  for (auto k = static_cast<std::ptrdiff_t>(from); k >= 0 && k < std::ssize(signal); k += direction, ++way)
    if (std::isfinite(signal[k]) && (signal[k] > middle) != above) break;
  return way;
}

/// What was pulled slowly and held, or held for long before it was let go, met no limit.
bool held_by_hand(const std::vector<double>& signal, const Run& run, double middle) {
  constexpr double longest = 15, slower = 4, few = 8;
  const double before = way_to(signal, run.first, -1, middle),
               after = way_to(signal, run.first + run.length - 1, 1, middle),
               length = static_cast<double>(run.length);
  return length > longest * after || before > 0.5 * length + slower * after + few;
}

/// Whether a run lasts longer than the peak of a sine of this height, rounded to steps, can stay on its
/// highest value: 2 acos((c - s/2) / (c + s/2)) of the pi of half a period, c from the middle, s the step.
bool beyond_a_rounded_peak(const std::vector<double>& signal, const Run& run, double step, double middle) {
  constexpr double clearly = 1.3, few = 2;
  const double height = std::abs(run.value - middle), length = static_cast<double>(run.length),
               half_period = way_to(signal, run.first, -1, middle) - 1 +
                             way_to(signal, run.first + run.length - 1, 1, middle) - 1 + length;
  const double share = 2 / std::numbers::pi * std::acos((height - step / 2) / (height + step / 2));
  return height > step && length - few > clearly * share * half_period;
}

/// Whether a value, the highest or the lowest, is a limit. @param runs of that value
bool is_limit(const std::vector<double>& signal, const std::vector<Run>& runs, const ValueSteps& steps,
              double value, double middle) {
  constexpr std::size_t held = 3, met = 3, times_as_often = 3;
  const double least = jump * steps.near(value);
  std::size_t meetings = 0, samples = 0, stays = 0;
  for (const Run& run : runs) {
    samples += run.length;
    if (!held_by_hand(signal, run, middle) && beyond_a_rounded_peak(signal, run, steps.near(value), middle) &&
        ++stays >= met)
      return true;
    const Ends ends = jumps(signal, run, least);
    if (!ends.before || !ends.after || held_by_hand(signal, run, middle)) continue;
    if (run.length >= held) return true;
    ++meetings;
  }
  const std::size_t usual = steps.most_frequent_beside(value);
  return meetings >= met && usual > 0 && samples >= times_as_often * usual;
}

}  // namespace

std::size_t samples_in(const std::vector<Run>& runs) {
  std::size_t sum = 0;
  for (const Run& run : runs) sum += run.length;
  return sum;
}

std::vector<Run> clipped_runs(const std::vector<double>& signal, const ValueSteps& steps) {
  std::vector<Run> clipped;
  if (steps.distinct() < 2) return clipped;
  const auto [lowest, highest, middle] = RunSpread(signal);
  for (const double value : {lowest, highest}) {
    const std::vector<Run> runs = runs_where(signal, [&](const Run& run) { return run.value == value; });
    if (is_limit(signal, runs, steps, value, middle)) clipped.insert(clipped.end(), runs.begin(), runs.end());
  }
  std::ranges::sort(clipped, {}, &Run::first);
  return clipped;
}

/// Of a force that rests between pulses, none a copy of the others: its farthest value, held in two or met in
/// three.
std::vector<Run> flat_tops(const std::vector<double>& signal) {
  constexpr double rest = 0.05, most_active = 0.3;
  const RunSpread spread(signal);
  const double top =
      spread.highest - spread.middle > spread.middle - spread.lowest ? spread.highest : spread.lowest;
  const auto active = std::ranges::count_if(signal, [&](double value) {
    return std::abs(value - spread.middle) > rest * std::abs(top - spread.middle);
  });
  std::vector<Run> runs = runs_where(signal, [&](const Run& run) { return run.value == top; });
  const auto held = std::ranges::count_if(runs, [](const Run& run) { return run.length > 1; });
  const auto rise = [&](const Run& run) { return run.first > 0 ? signal[run.first - 1] : 0.0; };
  const bool copies =
      std::ranges::all_of(runs, [&](const Run& run) { return rise(run) == rise(runs.front()); });
  if ((held < 2 && runs.size() < 3) || copies ||
      static_cast<double>(active) > most_active * static_cast<double>(signal.size()))
    runs.clear();
  return runs;
}

/// Short runs of exactly zero between readings that lie far on one side of it and near each other: a sensor
/// that did not answer. Far: ten times what a reading usually differs from the mean of its neighbours. A few
/// are chance.
std::vector<Run> zeros_within_motion(const std::vector<double>& signal, const ValueSteps& steps) {
  constexpr double far = 10, near = 0.5, step_factor = 8;
  constexpr std::size_t longest = 7, fewest = 3;
  std::vector<Run> found;
  if (2 * steps.count(0.0) > signal.size()) return found;
  std::vector<double> bends;
  for (std::size_t k = 1; k + 1 < signal.size(); ++k)
    if (const double bend = std::abs(signal[k] - 0.5 * (signal[k - 1] + signal[k + 1])); std::isfinite(bend))
      bends.push_back(bend);
  if (bends.empty()) return found;
  const double least = std::max(far * median(std::move(bends)), step_factor * steps.near(0.0));
  for (const Run& run :
       runs_where(signal, [](const Run& one) { return one.value == 0.0 && one.length <= longest; })) {
    const std::size_t behind = run.first + run.length;
    if (run.first == 0 || behind >= signal.size()) continue;
    const double before = signal[run.first - 1], after = signal[behind], mean = 0.5 * (before + after);
    if (std::abs(mean) > least && std::abs(before - after) < near * std::abs(mean)) found.push_back(run);
  }
  if (found.size() < fewest) found.clear();
  return found;
}

std::vector<Run> dropped_runs(const std::vector<double>& signal, const ValueSteps& steps) {
  constexpr double shortest = 8, beyond_chance = 3, motion = 8;
  constexpr std::size_t looked_back = 16;
  // Long runs would explain themselves: the share of repetitions is that of the shorter half of them.
  double repeated = 0, samples = 0;
  const std::vector<Run> runs = runs_where(signal, [&](const Run& run) {
    const auto length = static_cast<double>(run.length);
    if (length < shortest) repeated += length - 1, samples += length;
    return std::isnan(run.value) || length >= shortest;
  });
  std::vector<Run> dropped = zeros_within_motion(signal, steps);
  if (!runs.empty() && runs[0].length == signal.size()) return std::isnan(runs[0].value) ? runs : dropped;
  const double share = std::clamp(repeated / std::max(samples, 1.0), 1e-6, 0.95);
  const double chance = std::log(static_cast<double>(signal.size())) / std::log(1 / share);
  if (runs.empty()) return dropped;
  const auto [lowest, highest, middle] = RunSpread(signal);
  const auto moved_before = [&](const Run& run, double least) {
    double low = run.value, high = run.value;
    for (std::size_t k = run.first - std::min(run.first, looked_back); k < run.first; ++k)
      if (std::isfinite(signal[k])) low = std::min(low, signal[k]), high = std::max(high, signal[k]);
    return high - low >= least;
  };
  for (const Run& run : runs) {
    if (std::isnan(run.value)) {
      dropped.push_back(run);
      continue;
    }
    if (static_cast<double>(run.length) < std::max(shortest, beyond_chance * chance)) continue;
    if (2 * steps.count(run.value) > signal.size()) continue;
    const bool outermost = run.value == lowest || run.value == highest;
    if (outermost && way_to(signal, run.first, -1, middle) > shortest) continue;  // held, or clipped
    const double step = steps.near(run.value);
    const Ends ends = jumps(signal, run, jump * step);
    if ((ends.before || ends.after) && moved_before(run, motion * step)) dropped.push_back(run);
  }
  std::ranges::sort(dropped, {}, &Run::first);
  return dropped;
}

std::vector<Run> spikes(const std::vector<double>& signal) {
  constexpr std::size_t reach = 32, widest = 2, fewest = 16;
  constexpr double times = 20, returned = 0.25, candidate = 5;
  std::vector<Run> found;
  std::vector<double> read = finite(signal), moves;
  if (read.size() < fewest) return found;
  const double middle = median(read);
  moves.reserve(read.size());
  for (std::size_t k = 1; k < read.size(); ++k) moves.push_back(std::abs(read[k] - read[k - 1]));
  const double usual_move = median(std::move(moves));
  for (double& value : read) value = std::abs(value - middle);
  const auto place = read.begin() + static_cast<std::ptrdiff_t>(read.size() * 19 / 20);
  std::nth_element(read.begin(), place, read.end());
  const double usual = *place;
  std::vector<double> beside;
  for (std::size_t k = 1; k + 1 < signal.size(); ++k)
    for (std::size_t width = 1; width <= widest && k + width < signal.size(); ++width) {
      const double least =
          std::min(std::abs(signal[k] - signal[k - 1]), std::abs(signal[k + width - 1] - signal[k + width]));
      if (!(least > candidate * usual_move)) continue;
      beside.clear();
      for (std::size_t j = k - std::min(k, reach); j < std::min(k + width + reach, signal.size()); ++j)
        if ((j < k || j >= k + width) && std::isfinite(signal[j])) beside.push_back(signal[j]);
      if (beside.size() < fewest) continue;
      const double centre = median(beside);
      for (double& value : beside) value = std::abs(value - centre);
      const auto most = beside.begin() + static_cast<std::ptrdiff_t>(beside.size() * 9 / 10);
      std::nth_element(beside.begin(), most, beside.end());
      double size = std::abs(signal[k] - centre);
      for (std::size_t j = k; j < k + width; ++j) size = std::min(size, std::abs(signal[j] - centre));
      const auto back = [&](std::size_t j) { return !(std::abs(signal[j] - centre) > returned * size); };
      if (!(size > times * *most && size > usual) || !back(k - 1) || !back(k + width)) continue;
      found.push_back({k, width, signal[k]});
      k += width;
      break;
    }
  return found;
}

std::vector<Run> repeated_samples(const std::vector<double>& signal, const ValueSteps& steps) {
  constexpr double against_rounding = 3, smallest_share = 0.003, fewest = 10;
  std::vector<Run> found;
  std::size_t repeats = 0, near_misses = 0, all_repeats = 0;
  for_each_run(signal, [&](const Run& run) { all_repeats += run.length - 1; });
  for (std::size_t k = 1; k + 1 < signal.size();) {
    std::size_t end = k;  // of the samples that equal the one before
    while (end < signal.size() && signal[end] == signal[k - 1]) ++end;
    const std::size_t behind = std::max(end, k + 1);
    if (k >= 2 && behind < signal.size()) {
      const double into = signal[k - 1] - signal[k - 2], out = signal[behind] - signal[behind - 1];
      // A near miss needs a step of two thirds of its move and below a quarter of the moves beside it.
      const double least_move = std::min(std::abs(into), std::abs(out));
      const bool may_count = end > k || jump * std::abs(signal[k] - signal[k - 1]) < 1.6 * least_move;
      if (into * out > 0 && may_count) {
        const double step = steps.near(signal[k]), least = jump * step;
        if (std::abs(into) > least && std::abs(out) > least) {
          if (end > k)
            found.push_back({k, end - k, signal[k]}), repeats += end - k;
          else
            near_misses += std::abs(signal[k] - signal[k - 1]) <= 1.5 * step;
        }
      }
    }
    k = behind;
  }
  const auto count = static_cast<double>(signal.size());
  const bool explained =
      static_cast<double>(repeats) <
      std::max({against_rounding * static_cast<double>(near_misses), smallest_share * count, fewest});
  if (explained || 2 * all_repeats > signal.size()) found.clear();
  return found;
}

namespace {

using Eigen::Index, Eigen::VectorXd;

double lower_quartile(std::vector<double> values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Of one window: broadband power, its share in the band's mean, and how far the signal moves.
struct Window {
  double power = 0, flatness = 0, size = 0;
};

double blackman_harris(double turn) {
  return 0.35875 - 0.48829 * std::cos(turn) + 0.14128 * std::cos(2 * turn) - 0.01168 * std::cos(3 * turn);
}

std::vector<Window> windows_of(const VectorXd& signal, Index length) {
  VectorXd differences = signal;
  for (int order = 0; order < 4; ++order)
    differences =
        (differences.tail(differences.size() - 1) - differences.head(differences.size() - 1)).eval();
  Eigen::FFT<double> transform;
  std::vector<Window> windows;
  for (Index begin = 0; begin + length <= differences.size(); begin += length) {
    double taper_squares = 0;
    std::vector<double> tapered(static_cast<std::size_t>(length));
    for (Index k = 0; k < length; ++k) {
      const double turn = 2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / static_cast<double>(length),
                   taper = blackman_harris(turn);
      tapered[k] = taper * differences[begin + k];
      taper_squares += taper * taper;
    }
    std::vector<std::complex<double>> spectrum;
    transform.fwd(spectrum, tapered);
    std::vector<double> powers;
    double sum = 0;
    for (Index k = length / 8; k < 3 * length / 8; ++k) {
      const double turn = std::numbers::pi * static_cast<double>(k) / static_cast<double>(length),
                   gain = std::pow(2 * std::sin(turn), 8);  // of fourth differences
      powers.push_back(std::norm(spectrum[static_cast<std::size_t>(k)]) / gain / taper_squares);
      sum += powers.back();
    }
    Window window;
    window.power = lower_quartile(powers);
    window.flatness = window.power / std::max(sum / static_cast<double>(powers.size()), 1e-300);
    const auto part = signal.segment(begin, length).array();
    window.size = std::sqrt((part - part.mean()).square().mean());
    windows.push_back(window);
  }
  return windows;
}

}  // namespace

std::optional<Rattle> find_rattle(const VectorXd& signal, double step) {
  constexpr Index fewest = 1024, longest = 512, shortest = 64, windows_wanted = 16;
  constexpr double louder = 9, flat = 0.1, least = 1e-8, most = 0.01;  // of the motion's mean square
  constexpr std::size_t in_succession = 3;
  if (signal.size() < fewest) return {};
  const auto share = static_cast<std::size_t>(signal.size() / windows_wanted);
  const Index length = std::clamp<Index>(static_cast<Index>(std::bit_floor(share)), shortest, longest);
  const std::vector<Window> windows = windows_of(signal, length);
  std::vector<double> powers, quiet_sizes;
  for (const Window& window : windows) powers.push_back(window.power);
  const double rounding = std::log(4.0 / 3) * step * step / 12,  // the quartile of white noise as strong
      floor = std::max(lower_quartile(powers), rounding);
  if (!(floor > 0)) return {};
  const auto loud = [&](const Window& window) {
    const double motion = window.size * window.size;
    return window.power > std::max(louder * floor, least * motion) && window.power < most * motion &&
           window.flatness > flat;
  };
  for (const Window& window : windows)
    if (!loud(window)) quiet_sizes.push_back(window.size);
  if (quiet_sizes.empty()) return {};
  const double quiet = median(quiet_sizes);
  std::optional<Rattle> found;
  for (std::size_t first = 0, end = 0; first < windows.size(); first = end + 1) {
    std::vector<double> loud_powers;
    for (end = first; end < windows.size() && loud(windows[end]) && windows[end].size > quiet; ++end)
      loud_powers.push_back(windows[end].power);
    if (end - first < in_succession) continue;
    const auto samples = static_cast<std::size_t>(length);
    if (!found) found = Rattle{first * samples, 0, 1};
    found->last = end * samples - 1;
    found->ratio = std::max(found->ratio, std::sqrt(median(loud_powers) / floor));
  }
  return found;
}

namespace {

void leave_out(const std::vector<Run>& runs, std::vector<double>& samples) {
  for (const Run& run : runs)
    std::fill_n(samples.begin() + static_cast<std::ptrdiff_t>(run.first), run.length,
                std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

Defects find_defects(const std::vector<double>& samples, SignalKind kind) {
  Defects found;
  if (kind == SignalKind::force) {
    found.clipped = clipped_runs(samples, ValueSteps(samples));
    if (found.clipped.empty() && !finite(samples).empty()) found.clipped = flat_tops(samples);
    return found;
  }
  std::vector<double> left = samples;
  found.spikes = spikes(left);
  leave_out(found.spikes, left);
  found.dead = is_dead(left);
  if (found.dead) return found;
  ValueSteps steps(left);  // sorts all samples: anew only where some are left out
  const auto leave_out_of_steps = [&](const std::vector<Run>& runs) {
    if (runs.empty()) return;
    leave_out(runs, left);
    steps = ValueSteps(left);
  };
  found.clipped = clipped_runs(left, steps);
  leave_out_of_steps(found.clipped);
  found.dropped = dropped_runs(left, steps);
  std::erase_if(found.dropped, [&](const Run& run) {  // what was left out above is told there
    return std::isnan(run.value) && !std::isnan(samples[run.first]);
  });
  leave_out_of_steps(found.dropped);
  found.repeated = repeated_samples(left, steps);
  leave_out_of_steps(found.repeated);
  const VectorXd signal = bridged_straight(Eigen::Map<const VectorXd>(left.data(), std::ssize(left)));
  found.rattle = find_rattle(signal, steps.near(signal.maxCoeff()));
  return found;
}

}  // namespace beamid::experiments
