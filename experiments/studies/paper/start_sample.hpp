// The 2009 settings on a tip motion with higher modes: where the record starts decides what is found.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/figure.hpp"
#include "experiments/results/table.hpp"
#include "experiments/studies/paper/beam_identification.hpp"

namespace beamid::experiments::paper {

/// R = 1e-5, P0 of K and C 1e5, true noise-free displacement and velocity of the tip, filtered from a sample
/// on.
struct StartCase {
  Eigen::Index sample = 0;                                      ///< after the release
  double guess_over_truth = 0.8;                                ///< K0 / K
  Eigen::Index modes = 0;                                       ///< in the motion; 0: all
  double exact_error_percent = 0.0, euler_error_percent = 0.0;  ///< of C
  bool exact_lost = false, euler_lost = false;  ///< no damping left, or K 5 % off the first mode's
};

struct StartOutcome {
  std::string beam;
  double euler_prediction_percent = 0.0;  ///< closed form
  std::vector<StartCase> starts;          ///< the samples of the table
  std::vector<StartCase> guesses;         ///< K0 varied, from the release on
  std::vector<StartCase> counts;          ///< modes in the motion varied, from the release on
  std::vector<StartCase> curve;           ///< samples closely spaced
};
StartOutcome vary_start(const BeamCase& beam);

Table start_table(const StartOutcome& outcome);
Table guess_table(const StartOutcome& outcome);
Table mode_count_table(const StartOutcome& outcome);
Figure start_figure(const StartOutcome& outcome);

}  // namespace beamid::experiments::paper
