#include "experiments/identify/posterior/posterior_study.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>

#include "experiments/identify/update/mode_pairing.hpp"
#include "experiments/models/estimates.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
    throw InputError(place, "no [[parameters]]; expected what of the structure is asked about");
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
