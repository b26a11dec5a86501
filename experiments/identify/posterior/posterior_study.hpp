// The posterior of a structure's parameters from measured modes or a record, in physical terms.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/posterior/modal_likelihood.hpp"
#include "experiments/identify/posterior/posterior.hpp"
#include "experiments/identify/posterior/record_likelihood.hpp"
#include "experiments/identify/sensing/sensing.hpp"
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
  bool in_tail = false;  ///< most draws lie in the outer 0.1 % of the prior: prior and measurement disagree
  /// The bound stated of it where the draws pile up, of the prior's two: the bound decides, not what was
  /// measured.
  std::optional<double> cut_at = {};
};

/// A frequency measured again, as the posterior predicts it: drawn with the error of the measurement.
struct PredictedFrequency {
  DrawSummary drawn;
  double mac = 0.0;  ///< mean; NaN without a shape
};

/// A record as posteriors take it: its likelihood's model, and what the sensors say against that.
struct RecordSource {
  SensingRecord record;
  Choice reduction;
  std::unique_ptr<const SensingModel> model;
  SensingStudy sensing;  ///< at the best draw
};

struct PosteriorStudy {
  std::unique_ptr<const UpdateStudy> update;   ///< of modes; else null
  std::unique_ptr<const RecordSource> source;  ///< of a record; else null
  std::unique_ptr<const ParameterLikelihood> likelihood;
  std::vector<Unknown> asked;  ///< (q)
  PosteriorSettings settings;
  Posterior posterior;
  std::vector<PosteriorParameter> parameters;  ///< (q)
  std::vector<PredictedFrequency> predicted;   ///< of each measured mode
  double seconds = 0.0;                        ///< for the sampling, by the clock

  const std::vector<Unknown>& unknowns() const { return asked; }
  /// Whether the structure explains what was measured as well as the assumed errors say.
  bool explains() const { return update ? update->updating.explains() : !source->sensing.contradicted(); }
  /// Whether no values of the parameters explain the modes by more than chance, or a record, at the best
  /// draw, contradicts the structure or its noise is so far from white that all intervals are too narrow.
  bool contradicted() const {
    return update ? update->updating.refuted : source->sensing.contradicted() || source->sensing.correlated();
  }
  /// Of one parameter (draws x chains).
  Eigen::MatrixXd draws(std::size_t parameter) const;
  /// Of the heaviest hump, the smallest and the largest over the parameters: Laplace's width over the sampled
  /// one.
  std::pair<double, double> laplace_ratio() const;
};

/// The record through SensingModel: forces that were measured are known, [[unknown_forces]] are not.
/// @param place of the experiment file @throws InputError where nothing is asked about; as the parts do
PosteriorStudy study_posterior(const Experiment& experiment, SensingRecord record,
                               const PosteriorSettings& settings, const std::filesystem::path& folder,
                               const Place& place, const Progress& progress = unwatched);

/// @throws InputError, std::invalid_argument as the parts do.
PosteriorStudy study_posterior(UpdateStudy update, const PosteriorSettings& settings,
                               const Progress& progress = unwatched);

}  // namespace beamid::experiments
