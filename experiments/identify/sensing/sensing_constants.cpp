#include "experiments/identify/sensing/sensing_constants.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/models/estimates.hpp"
#include "filters/innovation_likelihood.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// From noise wide enough for the guess to what is stated, which pulls the structure to where the record can
// be its own; @param search its end
filters::InnovationFit narrowed(const SensingModel& model, VectorXd begin,
                                const filters::InnovationSearch& search) {
  constexpr double least = 2.0, most = 100.0, narrower = 4.0;
  const filters::Measurements& record = model.record();
  const double readings = static_cast<double>(record.size() * model.measured());
  const double square = 2.0 * filters::kalman_pass(model.at(begin), record, model.interval()).cost / readings;
  double factor = square > least * least ? std::min(std::sqrt(square), most) : 1.0;
  filters::InnovationSearch rough;
  rough.most_iterations = 10;
  for (; factor > least; factor /= narrower)
    begin = filters::fit_innovations(model.wider_problem(record, factor), begin, rough).constants;
  return filters::fit_innovations(model.problem(record), begin, search);
}

// An unknown force makes up for a wrong structure, so that the likelihood has maxima beside the largest:
// searched from the guess and from a deviation to either side of every parameter of the structure.
filters::InnovationFit likeliest(const SensingModel& model) {
  const filters::Gaussian prior = model.prior();
  std::optional<filters::InnovationFit> best;
  std::string failure = "the record has no likelihood under the model";
  const auto look = [&](const VectorXd& begin) {
    filters::InnovationSearch search;
    const filters::InnovationFit known = best.value_or(filters::InnovationFit{});
    if (best) search.known = &known;
    try {
      const filters::InnovationFit fit = narrowed(model, begin, search);
      if (!best || fit.cost < best->cost) best = fit;
    } catch (const std::runtime_error& error) {  // no such structure
      if (!best) failure = error.what();
    } catch (const std::invalid_argument&) {
    }
  };
  look(prior.mean);
  for (std::size_t j = 0; j < model.constants().size(); ++j)
    for (const double side : {-1.0, 1.0}) {
      if (model.constants()[j].kind != SensingConstant::Kind::parameter) continue;
      const auto place = static_cast<Index>(j);
      VectorXd begin = prior.mean;
      begin[place] += side * std::sqrt(prior.covariance(place, place));
      look(begin);
    }
  if (!best) throw std::runtime_error(failure);
  return *best;
}

// The model with the parameters guessed where they were found, and those constants in its theta: shapes of
// damped and reduced modes are those of the guess, and only there exact.
std::unique_ptr<SensingModel> guessed_at(const VectorXd& theta, const SensingModel& model,
                                         const SensingModel& first, const SensingSetting& setting,
                                         VectorXd& begin) {
  Experiment there = setting.experiment;
  for (std::size_t j = 0; j < model.constants().size(); ++j) {
    const SensingConstant& one = model.constants()[j];
    if (one.kind == SensingConstant::Kind::parameter)
      there.parameters.at(one.index).guess = model.value(j, theta[static_cast<Index>(j)]);
  }
  auto next = std::make_unique<SensingModel>(there, setting.record, setting.reduction, setting.folder);
  next->take_prior(first);
  begin.resize(theta.size());
  for (std::size_t j = 0; j < model.constants().size(); ++j) {
    const auto place = static_cast<Index>(j);
    begin[place] = next->place(j, model.value(j, theta[place]));
  }
  return next;
}

// By how many deviations a parameter moved, the most.
double largest_move(const SensingModel& model, const VectorXd& from, const FoundConstants& found) {
  double most = 0.0;
  for (std::size_t j = 0; j < model.constants().size(); ++j) {
    if (model.constants()[j].kind != SensingConstant::Kind::parameter) continue;
    const auto place = static_cast<Index>(j);
    most = std::max(most,
                    std::abs(found.theta[place] - from[place]) / std::sqrt(found.covariance(place, place)));
  }
  return most;
}

}  // namespace

FoundConstants find_constants(const SensingSetting& setting, std::unique_ptr<SensingModel>& model,
                              const std::optional<VectorXd>& given, SensingStudy& study) {
  constexpr int most_rounds = 5;
  constexpr double settled = 0.2;  // deviations
  const filters::Gaussian prior = model->prior();
  FoundConstants found{prior.mean, prior.covariance};
  if (prior.mean.size() == 0) return found;
  if (given) {
    for (Index j = 0; j < given->size(); ++j)
      found.theta[j] = model->place(static_cast<std::size_t>(j), (*given)[j]);
    return found;
  }
  const MatrixXd one = MatrixXd::Identity(prior.mean.size(), prior.mean.size());
  const auto take = [&](const filters::InnovationFit& fit) {
    found = {fit.constants, (fit.information + model->prior().covariance.llt().solve(one)).ldlt().solve(one)};
    study.converged = fit.converged;
  };
  std::unique_ptr<SensingModel> first;
  try {
    VectorXd from = prior.mean;
    take(likeliest(*model));
    for (int round = 1; largest_move(*model, from, found) > settled; ++round) {
      if (round == most_rounds) {
        study.converged = false;
        break;
      }
      auto next = guessed_at(found.theta, *model, first ? *first : *model, setting, from);
      const filters::InnovationFit fit = filters::fit_innovations(next->problem(next->record()), from);
      if (!first) first = std::move(model);
      model = std::move(next);
      take(fit);
    }
    if (!study.converged) study.failure = "the likelihood of the record has no maximum near the guess";
  } catch (const std::exception& error) {
    study.converged = false;
    study.failure = error.what();
  }
  for (std::size_t j = 0; j < model->constants().size(); ++j) {
    const auto place = static_cast<Index>(j);
    const double eta = found.theta[place], deviation = std::sqrt(found.covariance(place, place));
    const auto [lower, upper] = std::minmax(
        {model->value(j, eta - quantile_95 * deviation), model->value(j, eta + quantile_95 * deviation)});
    study.constants.push_back(
        {model->constants()[j].name, model->constants()[j].unit, model->value(j, eta), lower, upper});
  }
  return found;
}

}  // namespace beamid::experiments
