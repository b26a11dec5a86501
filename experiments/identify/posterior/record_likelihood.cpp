#include "experiments/identify/posterior/record_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

bool has_stated_prior(const ParameterChoice& choice) {
  return choice.deviation || choice.relative_deviation;
}

// Every theta with the shapes of its own modes: with those of the guess a set of parameters far from there is
// another structure, less likely than it is.
filters::InnovationProblem exact_problem(const SensingModel& model) {
  filters::InnovationProblem problem = model.problem(model.record());
  if (model.turns_shapes())
    problem.model = [&model](const VectorXd& theta) { return model.with_shapes_at(theta).at(theta); };
  return problem;
}

}  // namespace

RecordLikelihood::RecordLikelihood(const SensingModel& model, const Experiment& experiment)
    : model_(model), problem_(exact_problem(model)) {
  filters::require_even_stamps(model.record(),
                               model.interval());  // else no parameters would have a likelihood
  for (std::size_t j = 0; j < model.constants().size(); ++j) {
    const SensingConstant& one = model.constants()[j];
    Unknown unknown;
    bool stated = true;
    if (one.kind == SensingConstant::Kind::parameter) {
      unknown = model.unknown(one.index);
      stated = has_stated_prior(experiment.parameters.at(one.index));
    } else {
      unknown = {one.name, one.unit, model.value(j, 0.0), SensingModel::known_within * model.value(j, 0.0),
                 Form::logarithmic};
    }
    unknowns_.push_back(unknown);
    priors_.emplace_back(unknown, unknown.quantity != "axial_load", stated);
  }
  const MatrixXd read = model.record().outputs.topRows(model.measured());
  const auto count = static_cast<double>(read.array().isFinite().count());
  constant_ = -0.5 * count * std::log(2.0 * std::numbers::pi);
}

LikelihoodValue RecordLikelihood::at(const VectorXd& u, bool slopes) const {
  LikelihoodValue result;
  try {
    const VectorXd p = physical(u);
    VectorXd theta(p.size()), steepness(p.size());  // d theta / du
    for (Index j = 0; j < p.size(); ++j) {
      theta[j] = model_.place(static_cast<std::size_t>(j), p[j]);
      steepness[j] = priors_[static_cast<std::size_t>(j)].slope(u[j]) /
                     model_.slope(static_cast<std::size_t>(j), theta[j]);
    }
    if (!slopes) {
      result.log = constant_ + filters::innovation_log_likelihood(problem_, theta);
    } else {
      const filters::InnovationSlope found = filters::innovation_slope(problem_, theta);
      result.log = constant_ + found.log_likelihood;
      result.gradient = steepness.cwiseProduct(found.gradient);
      result.information = steepness.asDiagonal() * found.information * steepness.asDiagonal();
      if (!result.gradient.allFinite() || !result.information.allFinite()) return {};
    }
    if (std::isnan(result.log)) return {};
  } catch (const std::runtime_error&) {  // no such structure, or no finite likelihood
    return {};
  } catch (const std::invalid_argument&) {
    return {};
  }
  return result;
}

}  // namespace beamid::experiments
