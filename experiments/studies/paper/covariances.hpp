// The bias of forward Euler on the paper's oscillator against the covariances of its filter.
//
// On one channel and without process noise the filter ends where its innovations vanish, on g^-1 (e^(lambda
// dt)). On two channels it weighs two histories that one wrong model cannot both follow. With process noise
// on the motion it forgets the past and fits every single step instead, v+ = Phi_21 x + Phi_22 v, so that
//
//     K_f = -Phi_21 M / dt,   C_f = (1 - Phi_22) M / dt,   C_f - C = K dt (1 - 4 xi^2) / 2 + ...
//
// where Phi = e^(A dt) is the exact step: half of K dt.
#pragma once

#include <string>
#include <vector>

#include "experiments/models/oscillator.hpp"
#include "experiments/results/figure.hpp"
#include "experiments/results/table.hpp"

namespace beamid::experiments::paper {

/// What forward Euler finds that is fitted to single steps of an exact motion.
Oscillator seen_step_by_step(const Oscillator& truth, double interval);

/// The filter of table 2 with one covariance changed, after a release of 12 mm.
struct CovarianceCase {
  std::string varied;  ///< which one, with its unit
  double value = 0.0;
  double stiffness_error_percent = 0.0, damping_error_percent = 0.0;
};

struct CovarianceOutcome {
  std::vector<CovarianceCase> cases;      ///< R, Q and P0, a value each
  std::vector<CovarianceCase> curve;      ///< Q alone, closely spaced
  Oscillator truth, whole, step_by_step;  ///< truth, and both closed forms
};
CovarianceOutcome vary_covariances();

Table covariance_table(const CovarianceOutcome& outcome);
Figure covariance_figure(const CovarianceOutcome& outcome);

}  // namespace beamid::experiments::paper
