// The posterior of a structure's parameters from measured modes, in physical terms.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "experiments/identify/posterior/modal_likelihood.hpp"
#include "experiments/identify/posterior/posterior.hpp"
#include "experiments/identify/update/update_study.hpp"

namespace beamid::experiments {

/// Numbers that describe draws.
struct DrawSummary {
  double mean = 0.0, median = 0.0, deviation = 0.0, lower_95 = 0.0, upper_95 = 0.0;
};
/// Quantiles cut off 2.5 % of the draws on each side. @param values at least one
DrawSummary draw_summary(std::vector<double> values);

struct PosteriorParameter {
  DrawSummary all;
  std::vector<DrawSummary> humps;  ///< of the draws in each hump; zeros where there are none
  std::vector<double> laplace;     ///< standard deviation of the normal density that osculates each hump
  ChainConvergence convergence;
  double share_of_prior =
      0.0;              ///< standard deviation of u, whose prior has 1: what the prior's width was reduced to
  double beyond = 0.0;  ///< share of the draws in the outer 5 % of the prior
};

/// A frequency measured again, as the posterior predicts it: drawn with the error of the measurement.
struct PredictedFrequency {
  DrawSummary drawn;
  double mac = 0.0;  ///< mean; NaN without a shape
};

struct PosteriorStudy {
  UpdateStudy update;
  std::unique_ptr<const ModalLikelihood> likelihood;
  PosteriorSettings settings;
  Posterior posterior;
  std::vector<PosteriorParameter> parameters;  ///< (q)
  std::vector<PredictedFrequency> predicted;   ///< of each measured mode
  double seconds = 0.0;                        ///< for the sampling, by the clock

  const std::vector<Unknown>& unknowns() const { return update.unknowns(); }
  /// Of one parameter (draws x chains).
  Eigen::MatrixXd draws(std::size_t parameter) const;
  /// Of the heaviest hump, the smallest and the largest over the parameters: Laplace's width over the sampled
  /// one.
  std::pair<double, double> laplace_ratio() const;
};

/// @throws InputError, std::invalid_argument as the parts do.
PosteriorStudy study_posterior(UpdateStudy update, const PosteriorSettings& settings,
                               const Progress& progress = unwatched);

}  // namespace beamid::experiments
