#include "experiments/identify/engine/noisy_input_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/signal/missing_samples.hpp"
#include "filters/identifiability.hpp"
#include "filters/innovation_likelihood.hpp"
#include "filters/latent_inputs.hpp"

namespace beamid::experiments {
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// In units of the deviations known beforehand, which bring all unknowns to one size.
VectorXd bounds_of_unknowns(const MatrixXd& information, const VectorXd& known, const JointModel& model,
                            const VectorXd& values) {
  const MatrixXd scaled = known.asDiagonal() * information * known.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scaled);
  filters::InformationFactor factor(known.size());
  factor.add(solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose());
  for (Index j = 0; j < known.size(); ++j)
    if (model.unknowns[static_cast<std::size_t>(j)].nuisance)
      factor.add(MatrixXd::Identity(known.size(), known.size()).row(j));
  VectorXd bounds = filters::determined_combinations(factor, VectorXd::Ones(known.size())).bounds;
  for (Index j = 0; j < known.size(); ++j)
    bounds[j] *= known[j] * std::abs(model.unknowns[static_cast<std::size_t>(j)].slope(values[j]));
  return bounds;
}

namespace {

double readings(const filters::Measurements& record) {
  return static_cast<double>(record.outputs.array().isFinite().count());
}

// The record under noise of its inputs, and of its outputs times a root.
class NoisyProblem {
 public:
  NoisyProblem(const JointModel& model, const IdentificationSettings& settings,
               const filters::Gaussian& start, const filters::Measurements& record)
      : noisy_(filters::discretise(model.motion, record.interval(), settings.discretisation,
                                   {{}, settings.output_noise}),
               settings.input_noise),
        root_(VectorXd::Ones(settings.output_noise.rows())),
        problem_(filters::held_problem(noisy_, record, model.unknown_places, noisy_.with_errors(start))) {
    problem_.free_inputs = true;
    problem_.model = [this, of_one = problem_.model](const VectorXd& theta) {
      filters::LinearGaussian scaled = of_one(theta);
      scaled.r = root_.asDiagonal() * scaled.r * root_.asDiagonal();
      return scaled;
    };
  }
  NoisyProblem(const NoisyProblem&) = delete;  // the problem refers to its model
  NoisyProblem& operator=(const NoisyProblem&) = delete;

  void scale_outputs(const VectorXd& root) { root_ = root; }
  filters::InnovationFit fit(const VectorXd& begin) const {
    return filters::fit_innovations(problem_, begin);
  }
  filters::LinearGaussian at(const VectorXd& theta) const { return problem_.model(theta); }
  /// Of the innovations, 1 where the noises are what they are said to be.
  double mean_square(const VectorXd& theta) const {
    const auto pass = filters::innovation_passes({at(theta)}, problem_.record, problem_.interval, false);
    return pass.front().squares / readings(problem_.record);
  }

 private:
  filters::NoisyInputs noisy_;
  VectorXd root_;  // of R's scale (p)
  filters::InnovationProblem problem_;
};

}  // namespace

NoisyInputFit fit_noisy_inputs(const JointModel& model, const IdentificationSettings& settings,
                               const filters::Gaussian& start, const VectorXd& found,
                               const filters::Measurements& record, const std::vector<bool>& noise_is_known) {
  constexpr double enough = 0.02, least_scale = 1e-6;
  constexpr int most_fits = 4, halvings = 20;
  if (!dynamic_cast<const filters::LinearMotion*>(model.motion.get()))
    return {{}, {}, "the model is not linear in its motion"};
  const bool all_known =
      std::find(noise_is_known.begin(), noise_is_known.end(), false) == noise_is_known.end();
  try {
    NoisyProblem problem(model, settings, start, record);
    const auto take = [&](double scale) {
      VectorXd root = VectorXd::Ones(settings.output_noise.rows());
      for (Index i = 0; i < root.size(); ++i)
        if (!noise_is_known[static_cast<std::size_t>(i)]) root[i] = std::sqrt(scale);
      problem.scale_outputs(root);
    };
    double scale = 1.0;
    filters::InnovationFit fit = problem.fit(found(model.unknown_places));
    for (int i = 1; i < most_fits && !all_known; ++i) {
      const double square = problem.mean_square(fit.constants);
      if (std::abs(square - 1.0) < enough || (scale == 1.0 && square > 1.0)) break;
      double low = std::log(least_scale), high = 0.0;  // the square falls as the noise grows
      for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (low + high);
        take(std::exp(middle));
        (problem.mean_square(fit.constants) > 1.0 ? low : high) = middle;
      }
      take(scale = std::exp(high));
      fit = problem.fit(fit.constants);
    }
    const MatrixXd prior = start.covariance(model.unknown_places, model.unknown_places);
    const MatrixXd one = MatrixXd::Identity(prior.rows(), prior.cols());
    const MatrixXd whole = fit.information + prior.llt().solve(one);
    NoisyInputFit result{
        {fit.constants, whole.ldlt().solve(one), {}},
        bounds_of_unknowns(fit.information, prior.diagonal().cwiseSqrt(), model, fit.constants),
        {},
        scale};
    if (!fit.converged) result.failure = "its likelihood has no maximum near the filter's estimate";
    return result;
  } catch (const std::invalid_argument& error) {
    return {{}, {}, error.what()};
  } catch (const std::runtime_error& error) {
    return {{}, {}, error.what()};
  }
}

std::optional<LikeliestInputNoise> likeliest_input_noise(const JointModel& model,
                                                         const IdentificationSettings& settings,
                                                         const filters::Gaussian& start,
                                                         const VectorXd& found,
                                                         const filters::Measurements& record) {
  constexpr double least_share = 1e-4, most_share = 1.0, finer = 2.0;
  if (!dynamic_cast<const filters::LinearMotion*>(model.motion.get())) return {};
  const VectorXd size = root_mean_squares(record.inputs), theta = found(model.unknown_places);
  std::vector<double> shares{0.0};
  for (double share = least_share; share <= most_share; share *= finer) shares.push_back(share);
  try {
    std::vector<filters::LinearGaussian> models;
    for (const double share : shares) {
      IdentificationSettings noisy = settings;
      noisy.input_noise = share * size;
      models.push_back(NoisyProblem(model, noisy, start, record).at(theta));
    }
    const auto passes = filters::innovation_passes(models, record, record.interval(), false);
    if (passes[0].failed) return {};
    const double count = readings(record);
    // The likeliest of all noises together.
    const auto scale = [&](std::size_t i) { return passes[i].squares / count; };
    const auto cost = [&](std::size_t i) {
      return 0.5 * (count * std::log(scale(i)) + passes[i].log_determinants);
    };
    LikeliestInputNoise best{VectorXd::Zero(size.size()), 0.0, {}};
    for (std::size_t i = 1; i < shares.size(); ++i)
      if (const double gain = cost(0) - cost(i); !passes[i].failed && gain > best.gain)
        best = {std::sqrt(scale(i)) * shares[i] * size, gain, {}};
    return best;
  } catch (const std::invalid_argument&) {  // uneven stamps
    return {};
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace beamid::experiments
