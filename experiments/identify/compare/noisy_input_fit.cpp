#include "experiments/identify/compare/noisy_input_fit.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "filters/identifiability.hpp"
#include "filters/innovation_likelihood.hpp"
#include "filters/noisy_inputs.hpp"

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

NoisyInputFit fit_noisy_inputs(const JointModel& model, const IdentificationSettings& settings,
                               const filters::Gaussian& start, const VectorXd& found,
                               const filters::Measurements& record) {
  if (!dynamic_cast<const filters::LinearMotion*>(model.motion.get()))
    return {{}, {}, "the model is not linear in its motion"};
  filters::NoisyInputs noisy(filters::discretise(model.motion, record.interval(), settings.discretisation,
                                                 {{}, settings.output_noise}),
                             settings.input_noise);
  filters::InnovationProblem problem =
      filters::held_problem(noisy, record, model.unknown_places, noisy.with_errors(start));
  problem.free_inputs = true;
  try {
    const filters::InnovationFit fit = filters::fit_innovations(problem, found(model.unknown_places));
    const MatrixXd prior = start.covariance(model.unknown_places, model.unknown_places);
    const MatrixXd one = MatrixXd::Identity(prior.rows(), prior.cols());
    const MatrixXd whole = fit.information + prior.llt().solve(one);
    NoisyInputFit result{
        {fit.constants, whole.ldlt().solve(one), {}},
        bounds_of_unknowns(fit.information, prior.diagonal().cwiseSqrt(), model, fit.constants),
        {}};
    if (!fit.converged) result.failure = "its likelihood has no maximum near the filter's estimate";
    return result;
  } catch (const std::invalid_argument& error) {
    return {{}, {}, error.what()};
  } catch (const std::runtime_error& error) {
    return {{}, {}, error.what()};
  }
}

}  // namespace beamid::experiments
