// The passes of one run over the record.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "experiments/identify/engine/compared_run.hpp"
#include "experiments/identify/engine/first_guess.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/reproduction.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/gaussian.hpp"

namespace beamid::experiments {

// What is known before any record, and what passes over one make of it.

/// Of the unknowns alone, as the state carries them (q).
filters::Gaussian of_unknowns(const JointModel& model, const filters::Gaussian& estimate);

/// How far the unknown that moved most is from where it was linearised, `from` (n), in standard deviations.
double move_of(const JointModel& model, const Eigen::VectorXd& from, const filters::Gaussian& to);

/// A pass begins at another mean than what is known beforehand, and more certain of it (P_w, at m_w =
/// `start.mean`). What is known (P_0, at m_0) takes the place of that, once, in the unknowns U of the
/// estimate (P, m) behind it:
///
///     D = P_0^-1 - P_w^-1,   P' = P - P U D (I + U^T P U D)^-1 U^T P,
///     m' = m + P' U (P_0^-1 m_0 - P_w^-1 m_w - D U^T m)
///
/// A covariance kept as a factor has P_w = P_0, and its mean alone moves.
/// @param known_mean m_0 (q)
void take_known_prior(const JointModel& model, const filters::Gaussian& start, const FirstGuess& known,
                      const Eigen::VectorXd& known_mean, filters::Gaussian& last);

/// Wall time of a pass [s].
inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// One run in the making; run_once() says in what order.
class Passes {
 public:
  /// What it is given outlives it.
  Passes(const RunContext& context, const ModelSetting& setting, const StartedModel& started,
         const RunSettings& settings);

  ComparedRun& run() { return run_; }

  /// The motion nearest to the record at the first guess. @throws as reproduce()
  void begin();
  /// All passes. @returns whether the filter took in the whole record.
  bool filter();
  /// Noise levels by the filter's likelihood, and all passes again with them.
  bool filter_with_likeliest_noise();
  /// Of noisy inputs, the unknowns once more by the likelihood of the innovations.
  void fit_inputs_noise();
  /// Of a driven record that the filter's end does not make, or makes with passes that have not settled, are
  /// overconfident or lie half a deviation from what all samples at once say: the unknowns by these, where
  /// they leave less. Likewise of a free decay of one linear mode whose few cycles leave the filter
  /// overconfident or a quarter of a deviation away.
  void mend_by_output_error();
  /// Of a driven record that the filter has lost, a start from all samples at once; absent: none makes the
  /// record.
  std::optional<StartedModel> start_by_output_error();
  /// Of a driven record that the filter has lost for good, the estimates of all lines of its spectrum.
  /// @returns whether there are any
  bool take_all_lines();
  /// Estimates, the motion that they make of the record, their bounds; what else was asked for.
  void finish();
  /// The motion at the first guess that is nearest to the channels of the common clock.
  void follow_common_clock();
  /// Whether that motion is the record's: else the run diverged.
  void judge_motion();

 private:
  bool nearest_with_own_scheme() const;
  bool has_settled() const;
  bool is_linear_and_driven() const;
  bool is_free_mode() const;
  bool is_overconfident() const;
  double distance_from_all_samples() const;
  std::unique_ptr<filters::DiscreteModel> discretised(const Eigen::MatrixXd& noise) const;
  const Eigen::VectorXd& noise_shown() const;
  FirstGuess working_guess() const;
  void begin_at(const Eigen::VectorXd& state);
  void look_for_input_noise();
  filters::Gaussian known_beforehand() const;
  NoisyInputFit fit_with_input_noise(const IdentificationSettings& settings) const;
  bool is_weighed_at_once() const;
  void weigh_noise();
  void look_at_sections();
  void take_clocks(filters::DiscreteModel& discrete);
  std::optional<filters::Gaussian> output_error(Eigen::VectorXd state, Eigen::Index first_samples = 0);
  std::vector<Eigen::VectorXd> further_starts() const;
  void take_unknowns(const filters::Gaussian& unknowns);
  bool filter_once();
  void filter_from_there();
  void score(const Eigen::VectorXd& bound);

  const RunContext& context_;
  int begun_ = 0;  // passes
  const ModelSetting& setting_;
  const StartedModel& started_;
  const RunSettings& settings_;
  filters::Measurements record_;
  const double dt_;
  KnownNoise known_;
  ComparedRun run_;
  StartDirections directions_;
  Reproduction motion_;
  filters::Gaussian next_;       // initial estimate of the pass to come
  Eigen::VectorXd first_start_;  // of the first pass, where a batch estimate is asked for
  double last_move_ = 0.0;
  Eigen::VectorXd input_bounds_;  // of noisy inputs; empty: those of exact ones (q)
};

}  // namespace beamid::experiments
