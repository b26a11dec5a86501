#include "experiments/identify/posterior/posterior_study.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "experiments/identify/posterior/posterior.hpp"
#include "experiments/identify/update/mode_pairing.hpp"
#include "experiments/models/estimates.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

constexpr double far_tail = 8.0;  // standard deviations beyond which a cut changes no digit

}  // namespace

PriorLaw::PriorLaw(const Unknown& unknown, bool positive, bool stated)
    : lower_(unknown.lower), upper_(unknown.upper) {
  const bool bounded = unknown.form == Form::bounded;
  if (stated && unknown.form == Form::logarithmic) {
    kind_ = Kind::lognormal;
    centre_ = std::log(unknown.guess);
    spread_ = unknown.deviation / unknown.guess;
  } else if (stated) {
    centre_ = unknown.guess;
    spread_ = unknown.deviation;
    if (!bounded && positive) lower_ = 0.0;
    cut_ = (lower_ - centre_) / spread_ > -far_tail || (upper_ - centre_) / spread_ < far_tail;
  } else if (bounded) {
    kind_ = Kind::uniform;
  } else {
    assumed_ = true;
    kind_ = positive && unknown.guess > 0.0 ? Kind::log_uniform : Kind::uniform;
    const double scale = std::max(std::abs(unknown.guess), unknown.deviation);
    lower_ = kind_ == Kind::log_uniform ? std::log(unknown.guess / assumed_factor)
             : positive                 ? 0.0
                                        : unknown.guess - assumed_factor * scale;
    upper_ = kind_ == Kind::log_uniform ? std::log(unknown.guess * assumed_factor)
                                        : unknown.guess + assumed_factor * scale;
  }
}

// Phi(z) = Phi(a) + Phi(u) (Phi(b) - Phi(a)), of the upper tails where u is above zero.
double PriorLaw::standard(double u) const {
  if (!cut_) return u;
  const double a = (lower_ - centre_) / spread_, b = (upper_ - centre_) / spread_;
  if (u > 0.0)
    return -normal_quantile(below_normal(-b) + below_normal(-u) * (below_normal(-a) - below_normal(-b)));
  return normal_quantile(below_normal(a) + below_normal(u) * (below_normal(b) - below_normal(a)));
}

double PriorLaw::value(double u) const {
  if (kind_ == Kind::normal) return std::clamp(centre_ + spread_ * standard(u), lower_, upper_);
  if (kind_ == Kind::lognormal) return std::exp(centre_ + spread_ * u);
  const double place =
      u > 0.0 ? upper_ - (upper_ - lower_) * below_normal(-u) : lower_ + (upper_ - lower_) * below_normal(u);
  return kind_ == Kind::log_uniform ? std::exp(place) : place;
}

double PriorLaw::slope(double u) const {
  if (kind_ == Kind::normal && !cut_) return spread_;
  if (kind_ == Kind::normal) {
    const double a = (lower_ - centre_) / spread_, b = (upper_ - centre_) / spread_;
    return spread_ * normal_density(u) * (below_normal(b) - below_normal(a)) / normal_density(standard(u));
  }
  if (kind_ == Kind::lognormal) return spread_ * value(u);
  const double slope = (upper_ - lower_) * normal_density(u);
  return kind_ == Kind::log_uniform ? slope * value(u) : slope;
}

std::optional<double> PriorLaw::place(double p) const {
  double u = std::numeric_limits<double>::quiet_NaN();
  if (kind_ == Kind::lognormal) {
    u = (std::log(p) - centre_) / spread_;
  } else if (kind_ == Kind::normal) {
    const double z = (p - centre_) / spread_;
    const double a = (lower_ - centre_) / spread_, b = (upper_ - centre_) / spread_;
    if (!(p > lower_ && p < upper_)) return {};
    const double whole = below_normal(b) - below_normal(a);
    u = !cut_     ? z
        : z > 0.0 ? -normal_quantile((below_normal(-z) - below_normal(-b)) / whole)
                  : normal_quantile((below_normal(z) - below_normal(a)) / whole);
  } else {
    const double share = ((kind_ == Kind::log_uniform ? std::log(p) : p) - lower_) / (upper_ - lower_);
    if (!(share > 0.0 && share < 1.0)) return {};
    u = share > 0.5 ? -normal_quantile(1.0 - share) : normal_quantile(share);
  }
  if (!(std::abs(u) < far_tail)) return {};
  return u;
}

std::string PriorLaw::text() const {
  std::string text;
  if (kind_ == Kind::uniform) text = fmt::format("uniform from {:.5g} to {:.5g}", lower_, upper_);
  if (kind_ == Kind::log_uniform)
    text = fmt::format("log-uniform from {:.5g} to {:.5g}", std::exp(lower_), std::exp(upper_));
  if (kind_ == Kind::lognormal)
    text = fmt::format("lognormal, median {:.5g}, {:.3g} %", std::exp(centre_), 100.0 * spread_);
  if (kind_ == Kind::normal) text = fmt::format("normal, {:.5g} +- {:.3g}", centre_, spread_);
  if (kind_ == Kind::normal && std::isfinite(upper_))
    text += fmt::format(", within {:.5g} and {:.5g}", lower_, upper_);
  return assumed_ ? text + " (assumed)" : text;
}

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

VectorXd ParameterLikelihood::physical(const VectorXd& u) const {
  VectorXd values(size());
  for (Index j = 0; j < size(); ++j) values[j] = priors_[static_cast<std::size_t>(j)].value(u[j]);
  return values;
}

VectorXd ParameterLikelihood::slope(const VectorXd& u) const {
  VectorXd slopes(size());
  for (Index j = 0; j < size(); ++j) slopes[j] = priors_[static_cast<std::size_t>(j)].slope(u[j]);
  return slopes;
}

std::optional<VectorXd> ParameterLikelihood::place(const VectorXd& values) const {
  VectorXd u(size());
  for (Index j = 0; j < size(); ++j) {
    const std::optional<double> one = priors_[static_cast<std::size_t>(j)].place(values[j]);
    if (!one) return {};
    u[j] = *one;
  }
  return u;
}

VectorXd ParameterLikelihood::nearest(const VectorXd& values) const {
  VectorXd u(size());
  for (Index j = 0; j < size(); ++j) {
    const PriorLaw& prior = priors_[static_cast<std::size_t>(j)];
    u[j] = std::clamp(prior.place(values[j]).value_or(values[j] > prior.value(0.0) ? 2.0 : -2.0), -4.0, 4.0);
  }
  return u;
}

namespace {

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

ModalLikelihood::ModalLikelihood(const ModalResidual& residual) : residual_(residual) {
  const AskedParameters& asked = residual.model().asked();
  for (std::size_t j = 0; j < asked.unknowns.size(); ++j)
    priors_.emplace_back(asked.unknowns[j], asked.unknowns[j].quantity != "axial_load", asked.has_prior[j]);
  const double half_log = 0.5 * std::log(2.0 * std::numbers::pi);
  const std::vector<MeasuredMode>& modes = residual.data().modes;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    constant_ -= half_log + std::log(residual.frequency_deviation(i));
    if (modes[i].shape.size() > 1)
      constant_ -= static_cast<double>(modes[i].shape.size() - 1) *
                   (half_log + std::log(residual.shape_deviation(i) / modes[i].shape.norm()));
  }
}

LikelihoodValue ModalLikelihood::at(const VectorXd& u, bool slopes) const {
  LikelihoodValue result;
  try {
    const SearchSpace& space = residual_.space();
    const VectorXd x = space.place(physical(u));
    const ModalResidual::Value value = residual_.at(x, slopes);
    const Index rows = residual_.measured();
    result.log = constant_ - 0.5 * value.residual.head(rows).squaredNorm();
    if (std::isnan(result.log)) return {};
    if (!slopes) return result;
    const MatrixXd jacobian =
        value.jacobian.topRows(rows) * slope(u).cwiseQuotient(space.slope(x)).asDiagonal();
    result.gradient = -jacobian.transpose() * value.residual.head(rows);
    result.information = jacobian.transpose() * jacobian;
    if (!result.gradient.allFinite() || !result.information.allFinite()) return {};
  } catch (const std::runtime_error&) {  // no such modes: a structure that has buckled
    return {};
  }
  return result;
}

namespace {

constexpr Index most_predictions = 1000;
constexpr double far_in_the_prior = 3.29;  // standard deviations that 0.1 % lie beyond

// The stated bound at which draws pile up: 5 % of them are closer to it than a tenth of their standard
// deviation (of an exponential density at its edge 0.05, of a normal one that ends where it is cut 0.09, of
// one whose top is two deviations away 0.36).
std::optional<double> cutting_bound(const Unknown& unknown, std::vector<double> draws, double deviation) {
  if (unknown.form != Form::bounded) return {};
  const auto twentieth = static_cast<std::ptrdiff_t>(draws.size() / 20);
  std::nth_element(draws.begin(), draws.begin() + twentieth, draws.end());
  if (draws[static_cast<std::size_t>(twentieth)] - unknown.lower < 0.1 * deviation) return unknown.lower;
  std::nth_element(draws.begin(), draws.begin() + twentieth, draws.end(), std::greater<>());
  if (unknown.upper - draws[static_cast<std::size_t>(twentieth)] < 0.1 * deviation) return unknown.upper;
  return {};
}

// Sets that searches found; those that the prior excludes, at its edge: a hump may be cut off there.
MatrixXd known_sets(const UpdateStudy& update, const ParameterLikelihood& likelihood) {
  MatrixXd known(likelihood.size(), 0);
  for (const ParameterSet& set : update.updating.sets) {
    known.conservativeResize(Eigen::NoChange, known.cols() + 1);
    known.rightCols(1) = likelihood.nearest(set.values);
  }
  return known;
}

PosteriorParameter summary_of(const PosteriorStudy& study, std::size_t j) {
  const Posterior& posterior = study.posterior;
  const PriorLaw& prior = study.likelihood->priors()[j];
  PosteriorParameter result;
  result.convergence = posterior.convergence[j];
  std::vector<double> all, places;
  std::vector<std::vector<double>> of_hump(posterior.humps.size());
  for (std::size_t c = 0; c < posterior.chains.size(); ++c) {
    const MatrixXd& draws = posterior.chains[c].draws;
    for (Index k = 0; k < draws.cols(); ++k) {
      const double u = draws(static_cast<Index>(j), k);
      places.push_back(u);
      all.push_back(prior.value(u));
      of_hump[posterior.hump_of[c][static_cast<std::size_t>(k)]].push_back(all.back());
      if (std::abs(u) > quantile_95) result.beyond += 1.0 / static_cast<double>(posterior.draws());
    }
  }
  result.all = draw_summary(all);
  result.cut_at = cutting_bound(study.unknowns()[j], std::move(all), result.all.deviation);
  result.in_tail = std::abs(draw_summary(places).median) > far_in_the_prior;
  result.share_of_prior = draw_summary(std::move(places)).deviation;
  for (std::size_t h = 0; h < of_hump.size(); ++h) {
    result.humps.push_back(of_hump[h].empty() ? DrawSummary{} : draw_summary(of_hump[h]));
    const Hump& hump = posterior.humps[h];
    result.laplace.push_back(prior.slope(hump.top[static_cast<Index>(j)]) *
                             std::sqrt(hump.covariance(static_cast<Index>(j), static_cast<Index>(j))));
  }
  return result;
}

std::vector<PredictedFrequency> predicted_frequencies(const PosteriorStudy& study) {
  const Posterior& posterior = study.posterior;
  const ModalData& data = study.update->data();
  const Index each = posterior.chains.front().draws.cols(), all = static_cast<Index>(posterior.draws());
  const Index stride = std::max<Index>(1, all / most_predictions), count = all / stride;
  const auto modes = static_cast<Index>(data.modes.size());
  MatrixXd frequency(modes, count), mac = MatrixXd::Constant(modes, count, std::nan(""));
  tbb::parallel_for(Index{0}, count, [&](Index i) {
    const Index k = i * stride;
    const VectorXd u = posterior.chains[static_cast<std::size_t>(k / each)].draws.col(k % each);
    const PredictedModes found = study.update->model->at(study.likelihood->physical(u), false);
    const std::vector<Index> pairs = pair_modes(data, found);
    const MatrixXd assurance = modal_assurances(data, found);
    const VectorXd noise =
        filters::RandomStream(study.settings.seed + 3, static_cast<std::uint64_t>(i)).normal(modes, 1);
    for (Index m = 0; m < modes; ++m) {
      const Index pair = pairs[static_cast<std::size_t>(m)];
      frequency(m, i) = found.frequency_hz[pair] +
                        study.update->residual->frequency_deviation(static_cast<std::size_t>(m)) * noise[m];
      mac(m, i) = assurance(m, pair);
    }
  });
  std::vector<PredictedFrequency> predicted;
  for (Index m = 0; m < modes; ++m) {
    const VectorXd row = frequency.row(m);
    predicted.push_back({draw_summary({row.begin(), row.end()}), mac.row(m).mean()});
  }
  return predicted;
}

void sample(PosteriorStudy& study, const MatrixXd& known, const PosteriorSettings& settings,
            const Progress& progress) {
  study.settings = settings;
  const auto begin = std::chrono::steady_clock::now();
  study.posterior = sample_posterior(*study.likelihood, known, settings, progress);
  study.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (std::size_t j = 0; j < study.unknowns().size(); ++j) study.parameters.push_back(summary_of(study, j));
}

}  // namespace

DrawSummary draw_summary(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const Eigen::Map<const VectorXd> all(values.data(), static_cast<Index>(values.size()));
  const auto at = [&](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  const double mean = all.mean(), degrees = std::max<double>(1.0, static_cast<double>(values.size()) - 1.0);
  return {mean, at(0.5), std::sqrt((all.array() - mean).square().sum() / degrees), at(0.025), at(0.975)};
}

MatrixXd PosteriorStudy::draws(std::size_t parameter) const {
  const auto& chains = posterior.chains;
  MatrixXd values(chains.front().draws.cols(), static_cast<Index>(chains.size()));
  for (Index c = 0; c < values.cols(); ++c)
    for (Index k = 0; k < values.rows(); ++k)
      values(k, c) = likelihood->priors()[parameter].value(
          chains[static_cast<std::size_t>(c)].draws(static_cast<Index>(parameter), k));
  return values;
}

std::pair<double, double> PosteriorStudy::laplace_ratio() const {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const PosteriorParameter& one : parameters) {
    const double ratio = one.laplace.front() / one.humps.front().deviation;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  return {least, most};
}

PosteriorStudy study_posterior(UpdateStudy update, const PosteriorSettings& settings,
                               const Progress& progress) {
  PosteriorStudy study;
  study.update = std::make_unique<const UpdateStudy>(std::move(update));
  study.asked = study.update->unknowns();
  study.likelihood = std::make_unique<const ModalLikelihood>(*study.update->residual);
  sample(study, known_sets(*study.update, *study.likelihood), settings, progress);
  study.predicted = predicted_frequencies(study);
  return study;
}

PosteriorStudy study_posterior(const Experiment& experiment, SensingRecord record,
                               const PosteriorSettings& settings, const std::filesystem::path& folder,
                               const Place& place, const Progress& progress) {
  if (experiment.parameters.empty())
    throw InputError(place, "no [[parameters]]; expected what of the structure is to be determined");
  auto source = std::make_unique<RecordSource>();
  source->record = std::move(record);
  source->reduction = sensing_reduction(experiment, source->record.record.interval());
  source->sensing = study_sensing(experiment, source->record, source->reduction, folder, progress);
  source->model = std::make_unique<const SensingModel>(experiment, source->record, source->reduction, folder);
  PosteriorStudy study;
  auto likelihood = std::make_unique<const RecordLikelihood>(*source->model, experiment);
  study.asked = likelihood->unknowns();
  study.likelihood = std::move(likelihood);
  VectorXd likeliest(study.likelihood->size());
  for (Index j = 0; j < likeliest.size(); ++j)
    likeliest[j] = source->sensing.constants[static_cast<std::size_t>(j)].value;
  sample(study, study.likelihood->nearest(likeliest), settings, progress);
  const VectorXd best = study.likelihood->physical(study.posterior.best_draw());
  Experiment there = experiment;  // with the shapes of the modes at the best draw
  for (std::size_t j = 0; j < there.parameters.size(); ++j)
    there.parameters[j].guess = best[static_cast<Index>(j)];
  source->sensing = study_sensing_at(there, source->record, source->reduction, folder, best);
  study.source = std::move(source);
  return study;
}

}  // namespace beamid::experiments
