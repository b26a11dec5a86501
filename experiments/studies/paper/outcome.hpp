// Everything the paper's study finds, before it is put into words, tables and figures.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/studies/paper/alternatives.hpp"
#include "experiments/studies/paper/beam_identification.hpp"
#include "experiments/studies/paper/covariances.hpp"
#include "experiments/studies/paper/monte_carlo.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"
#include "experiments/studies/paper/predictions.hpp"
#include "experiments/studies/paper/specificity.hpp"
#include "experiments/studies/paper/start_sample.hpp"
#include "experiments/studies/paper/step_size.hpp"
#include "experiments/studies/paper/two_channels.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments::paper {

/// A filter and how it moves: the paper's own first, then what cures it.
struct Variant {
  const char* filter;
  const char* scheme;
  const char* label;
};
inline constexpr std::array<Variant, 4> variants{{{"ekf", "forward_euler", "EKF, forward Euler"},
                                                  {"ekf", "exponential", "EKF, exact"},
                                                  {"ukf", "forward_euler", "UKF, forward Euler"},
                                                  {"ukf", "exponential", "UKF, exact"}}};

/// One discretisation on the simulated oscillator.
struct SchemeOutcome {
  std::string scheme;
  Oscillator predicted;              ///< closed form
  Identification ekf, ukf;           ///< with the paper's own settings (table 2)
  Identification displacement_only;  ///< EKF, with noise so small that only the discretisation is left
};

/// One beam, measured, processed and identified.
struct BeamOutcome {
  BeamCase beam;
  BeamSettings settings;
  ReferenceAnalysis analysis;
  filters::Measurements motion;              ///< processed displacement and velocity
  std::array<Identification, 4> identified;  ///< by the variants
  std::array<Oscillator, 4> predicted;       ///< what the variants' schemes see of the reference
  /// Exact EKF with the paper's wide prior: on the true motion, after its own processing, after a zero-phase
  /// high-pass.
  Identification wide_true, wide_processed, wide_zero_phase;
  Identification wide_euler;  ///< forward Euler after the paper's own processing: the chain of 2009
  Identification zero_phase;  ///< exact EKF, tuned processing made zero-phase, both ends left out
  TrialStatistics trials;
};

struct Outcome {
  std::uint64_t seed = 0;
  Oscillator truth;  ///< of the simulated oscillator
  std::vector<SchemeOutcome> schemes;
  /// Forward Euler with the variance of K and C as printed, 10^-5, after a release of 12 mm and of 1 m.
  Identification literal_variance, literal_variance_large;
  std::vector<BeamOutcome> beams;
  std::vector<DigitCase> digits;        ///< how specific the published digits are
  CovarianceOutcome covariances;        ///< the bias against R, Q and P0
  std::vector<ChannelCase> channels;    ///< what the innovations show
  std::vector<Prediction> predictions;  ///< of the measured beams, nothing assumed
  std::vector<AlternativeCase> alternatives;
  StartOutcome start;  ///< S(0.65), the settings of 2009 and where the record starts
  StepOutcome step;    ///< S(11.8), the same record at longer steps
};

/// Runs it all. @param trials seeded repetitions per beam. @param progress is told what is being done.
Outcome investigate(std::uint64_t seed, int trials, const Progress& progress);

}  // namespace beamid::experiments::paper
