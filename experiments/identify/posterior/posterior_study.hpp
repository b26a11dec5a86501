// The posterior of a structure's parameters from measured modes or a record, in physical terms.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/identify/posterior/likelihood.hpp"
#include "experiments/identify/posterior/posterior.hpp"
#include "experiments/identify/sensing/sensing.hpp"
#include "experiments/identify/sensing/sensing_model.hpp"
#include "experiments/identify/update/modal_residual.hpp"
#include "experiments/identify/update/update_study.hpp"
#include "experiments/models/unknown.hpp"

namespace beamid::experiments {

// A likelihood whose parameters have names, units and priors.

// The prior distribution of one parameter, as a function of a standard normal number.

/// p = F^-1(Phi(u)): a standard normal u gives a parameter distributed by F. The sampler moves in u, where
/// every prior is N(0, 1) and no bound is reached.
class PriorLaw {
 public:
  enum class Kind { normal, lognormal, uniform, log_uniform };

  /// What [[parameters]] states: `form = "logarithmic"` with a deviation is lognormal; another deviation
  /// normal, cut off at stated bounds and, of a quantity that is positive by nature, at zero; bounds alone
  /// are uniform. Of nothing stated log-uniform within assumed_factor of the initial estimate (uniform, where
  /// that is no positive number, within assumed_factor times its scale) is *assumed*.
  /// @param positive the quantity has no negative values; @param stated a deviation is
  PriorLaw(const Unknown& unknown, bool positive, bool stated);

  static constexpr double assumed_factor = 10.0;

  Kind kind() const { return kind_; }
  bool assumed() const { return assumed_; }
  std::string text() const;  ///< "uniform from 20000 to 150000"

  double value(double u) const;  ///< p
  double slope(double u) const;  ///< dp/du
  /// u of p; absent outside the prior's support, or so far in its tail that it has no probability.
  std::optional<double> place(double p) const;

 private:
  Kind kind_ = Kind::normal;
  bool assumed_ = false, cut_ = false;
  double centre_ = 0.0, spread_ = 1.0;  // of p or ln p: normal, lognormal
  double lower_, upper_;                // of p, or of ln p where log_uniform

  double standard(double u) const;  // z of a normal that is cut off
};

class ParameterLikelihood : public Likelihood {
 public:
  Eigen::Index size() const override { return static_cast<Eigen::Index>(priors_.size()); }
  const std::vector<PriorLaw>& priors() const { return priors_; }
  Eigen::VectorXd physical(const Eigen::VectorXd& u) const;  ///< p (q)
  Eigen::VectorXd slope(const Eigen::VectorXd& u) const;     ///< dp/du (q)
  /// Absent outside the prior.
  std::optional<Eigen::VectorXd> place(const Eigen::VectorXd& values) const;
  /// The same; what lies outside, two standard deviations from the prior's median.
  Eigen::VectorXd nearest(const Eigen::VectorXd& values) const;

 protected:
  std::vector<PriorLaw> priors_;  // filled by who inherits
};

// The likelihood of a record: that of a Kalman filter's innovations.

/// ln p(record | p), the motion integrated out exactly (filters/innovation_likelihood.hpp): of the parameters
/// of a structure and of what else is not known, the sizes of unknown forces and of the sensors' noise, whose
/// priors are lognormal about the guess with a deviation of SensingModel::known_within.
class RecordLikelihood final : public ParameterLikelihood {
 public:
  /// @param model outlives it
  RecordLikelihood(const SensingModel& model, const Experiment& experiment);

  LikelihoodValue at(const Eigen::VectorXd& u, bool slopes) const override;

  const std::vector<Unknown>& unknowns() const { return unknowns_; }  ///< (q)

 private:
  const SensingModel& model_;
  filters::InnovationProblem problem_;
  std::vector<Unknown> unknowns_;
  double constant_ = 0.0;
};

// The likelihood of measured modes.

/// ln L = -1/2 sum r^2 - sum ln(sqrt(2 pi) s) over the rows of ModalResidual that are measurements. A shape
/// of p components counts as p - 1 numbers, the density of its direction: its scale says nothing.
class ModalLikelihood final : public ParameterLikelihood {
 public:
  /// @param residual outlives it
  explicit ModalLikelihood(const ModalResidual& residual);

  LikelihoodValue at(const Eigen::VectorXd& u, bool slopes) const override;

 private:
  const ModalResidual& residual_;
  double constant_ = 0.0;
};

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
