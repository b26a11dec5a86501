// The experiment that decides on any record: the same record at longer and longer steps.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/figure.hpp"
#include "experiments/results/table.hpp"
#include "experiments/studies/paper/beam_identification.hpp"

namespace beamid::experiments::paper {

/// Every n-th sample of one processed record, identified by both schemes.
struct StepCase {
  double interval = 0.0;                          ///< [s]
  double exact_ratio = 0.0, euler_ratio = 0.0;    ///< damping ratios found
  double predicted_ratio = 0.0;                   ///< forward Euler's, from what the exact scheme found
  double exact_square = 0.0, euler_square = 0.0;  ///< mean NIS
};

struct StepOutcome {
  std::string beam;
  std::vector<StepCase> steps;
  double extrapolated_ratio = 0.0;  ///< forward Euler's at dt = 0, by the polynomial through all steps
  std::vector<StepCase> curve;      ///< predicted_ratio over closely spaced intervals
};

/// @param motion displacement and velocity, low-passed so that what is left out aliases nothing
StepOutcome vary_step(const BeamCase& beam, const filters::Measurements& motion,
                      const BeamSettings& settings);

Table step_table(const StepOutcome& outcome);
Figure step_figure(const StepOutcome& outcome);

}  // namespace beamid::experiments::paper
