// Filters against the bound as tables, a figure and numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"
#include "filters/discrete_model.hpp"
#include "filters/filter.hpp"
#include "filters/measurements.hpp"
#include "filters/monte_carlo.hpp"

namespace beamid::experiments {

// A filter that finds constants from a poor guess: pass after pass over more and more of the record.

struct LengtheningSettings {
  Eigen::Index first_samples = 50;  ///< of the shortest part, then twice as many, and so on to the whole
  int passes = 2;                   ///< over each part
  int last_passes = 3;              ///< over the whole record
  /// A pass starts from deviations of the constants so many times what the one before ended with, at most
  /// from the first ones.
  double widening = 10.0;
};

/// A long oscillation has a wrong answer for every cycle missed, and an estimate that linearises about a poor
/// guess settles in one. Over the first cycle there is none. Every further pass
///
///     mean_c := what the pass before found,   deviation_c := min(first, w * what the pass before told)
///
/// of the constants c, motion as unknown as at first, is a Gauss-Newton step with a small prior about the
/// present estimate: where the passes converge, the prior pulls nowhere, and all that remains of it is that
/// told deviations are too small by 1/(2 w^2). Nothing but the filter is used.
/// @param constants entries of the state that do not move. @returns the last estimate; nothing where a pass
/// failed. @throws std::invalid_argument when a number is out of range or sizes disagree.
std::optional<filters::Gaussian> lengthening_passes(filters::Filter& filter, const filters::Gaussian& initial,
                                                    const filters::Measurements& record,
                                                    const std::vector<Eigen::Index>& constants,
                                                    const LengtheningSettings& settings = {});

// Simulated free decays whose stiffness and damping are known, and how well any estimator can find them.

/// How the first guesses of K and C are chosen: each from half to twice the truth.
enum class Guess {
  drawn,  ///< uniformly in the logarithm, independently
  ends    ///< half or twice, the four pairs in turn
};

struct DecaySettings {
  double damping_ratio = 0.01;
  double mass = 1.0;          ///< M [kg], known
  double frequency_hz = 4.0;  ///< undamped
  double amplitude = 0.01;    ///< of the displacement at the first sample [m]
  double phase = 0.7;         ///< of the first sample [rad]: neither at rest nor at an end
  double noise = 0.02;        ///< deviation of the displacement's white noise, as a share of the amplitude
  double samples_per_cycle = 25;
  double cycles = 30;         ///< length of the record, unless it has died out before
  double time_constants = 4;  ///< after so many of 1/(xi w) it has
  Guess guess = Guess::drawn;
};

/// x(t) = Re(a e^(lambda t)) read N times with white noise; model sdof, [x, v, K, C], displacement observed.
class FreeDecays {
 public:
  /// @throws std::invalid_argument where damping ratio is not in (0, 1), a number is not positive, or fewer
  /// than 16 samples are left.
  explicit FreeDecays(const DecaySettings& settings);

  const DecaySettings& settings() const { return settings_; }
  const Oscillator& truth() const { return truth_; }
  Eigen::Index samples() const { return samples_; }  ///< N
  double interval() const { return interval_; }      ///< [s]
  /// Cramer-Rao bound of the deviations of K and C: initial state unknown too, no prior (2).
  const Eigen::Vector2d& bound() const { return bound_; }

  /// The model, sampled exactly, with the noise as it is.
  std::unique_ptr<filters::DiscreteModel> model() const;
  /// A noisy record, and a first estimate: at rest, deviations of x and v twice what the largest reading may
  /// mean, K and C at the guess with deviations of 3/4 and 1 of it. The same seed gives the same trial.
  filters::Trial trial(std::uint64_t seed) const;

 private:
  Eigen::Vector2d guess_factors(std::uint64_t seed) const;

  DecaySettings settings_;
  Oscillator truth_;
  std::shared_ptr<const filters::ContinuousModel> motion_;
  double interval_ = 0.0;
  Eigen::Index samples_ = 0;
  Eigen::VectorXd decay_;  // x without noise (N)
  Eigen::Vector2d bound_;
};

// Filters against the Cramer-Rao bound, over seeded runs.

/// How a filter gets from the guess to its answer.
enum class Passes {
  lengthening,  ///< lengthening_passes(), from the first cycle on
  single        ///< once through the record, from the guess
};
const char* to_string(Passes passes);

struct EfficiencySettings {
  std::vector<Choice> filters;
  std::vector<double> damping_ratios{0.0015, 0.01, 0.1};
  std::vector<Passes> passes{Passes::lengthening, Passes::single};
  int runs = 2000;
  int sampled_runs = 100;  ///< of filters that draw samples: a thousand times slower
  std::uint64_t seed = 1;  ///< of the first run; the next run has the next
  DecaySettings decay;     ///< but for the damping ratio
};

/// All registered filters that take models that are not linear.
std::vector<Choice> applicable_filters();

/// One filter on one kind of record.
struct EfficiencyCase {
  Choice filter;
  Passes passes = Passes::lengthening;
  double damping_ratio = 0.0;
  Oscillator truth;
  Eigen::Vector2d bound;    ///< of K and C
  Eigen::Vector2d largest;  ///< errors beyond these count as lost: 5 % of K, half of C, or ten bounds
  filters::MonteCarloResult result;  ///< of K and C; empty vectors where all runs were lost
};

struct Efficiency {
  EfficiencySettings settings;
  std::vector<EfficiencyCase> cases;  ///< by damping ratio, then passes, then filter
};

/// Trials run on all processors; the numbers do not depend on how many there are.
/// @throws std::invalid_argument when nothing is asked for, runs < 2, or as FreeDecays and the filters do.
Efficiency find_efficiency(const EfficiencySettings& settings, const Progress& progress);

/// rms error / bound with its 95 % interval, and bias.
Table efficiency_table(const Efficiency& all);
/// NEES with its 99.9 % band, coverage of 95 % intervals, runs lost with Wilson's interval.
Table consistency_table(const Efficiency& all);
/// rms error / bound over the damping ratio.
Figure efficiency_figure(const Efficiency& all);

Results report(const Efficiency& all);

}  // namespace beamid::experiments
