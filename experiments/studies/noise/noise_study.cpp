#include "experiments/studies/noise/noise_study.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/signal/toolbox.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {
namespace {

// Failed, or on another motion than the first mode's: one such trial would be all of a mean.
bool is_lost(const FirstMode& f) {
  constexpr double stiffness_lost = 5.0, damping_lost = 100.0;  // [%]
  return !(std::abs(f.stiffness_error) < stiffness_lost && std::abs(f.damping_error) < damping_lost &&
           std::isfinite(f.damping_deviation));
}

NoiseStatistics statistics_of(const std::vector<FirstMode>& found) {
  NoiseStatistics s;
  double count = 0.0, stiffness_deviation = 0.0, damping_deviation = 0.0;
  double squares = 0.0;
  int reached = 0;
  for (const FirstMode& f : found) {
    if (std::isfinite(f.normalised_square)) {
      squares += f.normalised_square;
      ++reached;
    }
    if (is_lost(f)) {
      ++s.failed;
      continue;
    }
    ++count;
    s.stiffness_mean_percent += f.stiffness_error;
    s.damping_mean_percent += f.damping_error;
    s.stiffness_rms_percent += f.stiffness_error * f.stiffness_error;
    s.damping_rms_percent += f.damping_error * f.damping_error;
    stiffness_deviation += f.stiffness_deviation;
    damping_deviation += f.damping_deviation;
  }
  s.stiffness_mean_percent /= count;  // nothing found: 0 / 0, not a number
  s.damping_mean_percent /= count;
  s.stiffness_rms_percent = std::sqrt(s.stiffness_rms_percent / count);
  s.damping_rms_percent = std::sqrt(s.damping_rms_percent / count);
  s.normalised_square = squares / reached;
  s.stiffness_ratio = s.stiffness_rms_percent / (stiffness_deviation / count);
  s.damping_ratio = s.damping_rms_percent / (damping_deviation / count);
  return s;
}

void check_noise_study(const NoiseSettings& s) {
  require_positive(s.noise, "noise");
  require_positive(s.deflection, "deflection");
  require_positive(s.blow, "blow");
  require_positive(s.interval, "interval");
  require_positive(s.duration, "duration");
  if (s.beams.empty()) throw std::invalid_argument("beams: none; expected one at least");
  if (s.trials < 2)
    throw std::invalid_argument("trials: " + std::to_string(s.trials) + "; expected 2 or more");
  for (const NoiseBeam& beam : s.beams)
    if (s.modes < 1 || s.modes > beam.damping_ratios.size())
      throw std::invalid_argument("modes: " + std::to_string(s.modes) + "; expected 1 to " +
                                  std::to_string(beam.damping_ratios.size()));
}

}  // namespace

const NoiseStatistics& NoiseCase::best(const NoiseSettings& settings) const {
  for (std::size_t i = 0; i < settings.factors.size(); ++i)
    if (settings.factors[i] == best_factor) return factors[i];
  return by(Treatment::white);
}

bool harmless(const NoiseStatistics& s) {
  return s.failed == 0 && s.damping_rms_percent < 1.0 && s.damping_ratio < 3.0;
}

namespace {

NoiseCase examine(const NoiseSettings& settings, std::size_t beam, Blow blow, Quantity observed, int modes,
                  Countdown& countdown) {
  const NoiseBeam& tested = settings.beams[beam];
  const ModalMotion motion = modal_motion(tested.beam, settings.elements, tested.damping_ratios.head(modes),
                                          blow, settings.deflection, settings.blow);
  const double highest = motion.rate[modes - 1].imag() / (2.0 * std::numbers::pi);
  if (highest > 0.45 / settings.interval)
    throw std::invalid_argument("interval: " + std::to_string(settings.interval) + " s; expected at most " +
                                std::to_string(0.45 / highest) + " s, for mode " + std::to_string(modes) +
                                " of " + tested.name + " is at " + std::to_string(highest) + " Hz");
  const double noise = settings.noise * motion.size(0, observed);
  const std::size_t choices = treatments.size() + settings.factors.size();
  std::vector<std::vector<FirstMode>> found(choices, std::vector<FirstMode>(settings.trials));
  tbb::parallel_for(0, settings.trials, [&](int trial) {
    // The same noise and instant for every case: they differ by what they are, and not by luck.
    const ModalRecord record = modal_record(motion, observed, settings.interval, settings.duration, noise,
                                            settings.seed, static_cast<std::uint64_t>(trial));
    for (std::size_t i = 0; i < choices; ++i)
      found[i][trial] = i < treatments.size()
                            ? identify_first_mode(record, motion, observed, noise, treatments[i])
                            : identify_first_mode(record, motion, observed, noise, Treatment::white,
                                                  settings.factors[i - treatments.size()]);
    countdown.count();
  });
  NoiseCase result{beam, blow, observed, modes, 0.0, {}, {}, 1.0};
  for (int i = 1; i < modes; ++i)
    result.share += std::pow(motion.size(i, observed) / motion.size(0, observed), 2);
  result.share = std::sqrt(result.share);
  for (std::size_t i = 0; i < choices; ++i)
    (i < treatments.size() ? result.treatments : result.factors).push_back(statistics_of(found[i]));
  double least = result.by(Treatment::white).damping_rms_percent;
  for (std::size_t i = 0; i < settings.factors.size(); ++i)
    if (result.factors[i].failed == 0 && !(result.factors[i].damping_rms_percent >= least)) {
      least = result.factors[i].damping_rms_percent;
      result.best_factor = settings.factors[i];
    }
  return result;
}

}  // namespace

NoiseCase examine(const NoiseSettings& settings, std::size_t beam, Blow blow, Quantity observed, int modes) {
  const Progress unseen = [](const std::string&) {};
  Countdown countdown(unseen, static_cast<std::size_t>(settings.trials), "trials");
  return examine(settings, beam, blow, observed, modes, countdown);
}

NoiseStudy study_higher_modes(const NoiseSettings& settings, const Progress& progress) {
  check_noise_study(settings);
  NoiseStudy study{settings, {}, {}};
  constexpr Quantity sensors[] = {Quantity::displacement, Quantity::velocity, Quantity::acceleration};
  const std::size_t cases = 2 * std::size(sensors) * settings.beams.size() +
                            std::size(sensors) * static_cast<std::size_t>(settings.modes);
  Countdown countdown(progress, cases * static_cast<std::size_t>(settings.trials), "trials");
  for (std::size_t beam = 0; beam < settings.beams.size(); ++beam) {
    countdown.begin(settings.beams[beam].name);
    for (const Blow blow : {Blow::release, Blow::hammer})
      for (const Quantity observed : sensors)
        study.cases.push_back(examine(settings, beam, blow, observed, settings.modes, countdown));
  }
  countdown.begin("number of modes");
  for (const Quantity observed : sensors)
    for (int modes = 1; modes <= settings.modes; ++modes)
      study.kept.push_back(examine(settings, 0, Blow::release, observed, modes, countdown));
  return study;
}

}  // namespace beamid::experiments
