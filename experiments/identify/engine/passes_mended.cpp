// What a filter of a driven record or of a free mode has found, held against all samples at once; and what
// becomes of it where it ended elsewhere, or nowhere.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>
#include <optional>

#include "experiments/identify/engine/passes.hpp"
#include "experiments/identify/engine/run_bound.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/signal/toolbox.hpp"
#include "filters/output_error.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double not_the_record = 2.0;  // % that is left and no noise

}  // namespace

// Every change of an unknown within a pass sets the fast modes of a mesh moving, and turns their phases by
// more than a linearisation holds: their absence from the record passes for knowledge.
bool Passes::is_overconfident() const {
  const auto discrete = discretised(run_.noise.cwiseAbs2().asDiagonal());
  const VectorXd bound = run_bounds(*discrete, *run_.model, motion_.initial_state, directions_, record_);
  const std::vector<Estimate> found = estimates(*run_.model, run_.run.last);
  for (std::size_t j = 0; j < found.size(); ++j)
    if (overconfidence(found[j].deviation, bound[static_cast<Index>(j)], found[j].prior_deviation) < 1.0)
      return true;
  return false;
}

// Elsewhere within the prior: two modes that are taken for each other are a minimum of their own. Of
// many unknowns or coordinates none: a few draws say little there, and each descent is long.
std::vector<VectorXd> Passes::further_starts() const {
  constexpr Index draws = 12, most_unknowns = 12, most_work = 10'000'000;
  const std::vector<Index>& places = started_.model.unknown_places;
  const auto q = static_cast<Index>(places.size());
  std::vector<VectorXd> starts;
  const Index work =
      record_.outputs.size() * directions_.all().cols() * run_.model->motion_size();  // of a pass
  if (q > most_unknowns || work > most_work) return starts;
  const MatrixXd root = started_.guess.unknowns.llt().matrixL();
  for (Index i = 0; i < draws; ++i) {
    VectorXd& start = starts.emplace_back(started_.guess.mean);
    start(places) += root * standard_normal(q, 1, static_cast<std::uint64_t>(i));
  }
  return starts;
}

// The first step of output error from the filter's end, in the deviations there: what linearising from sample
// to sample has left.
double Passes::distance_from_all_samples() const {
  const std::vector<Index>& places = run_.model->unknown_places;
  const auto q = static_cast<Index>(places.size()), starts = directions_.motion.cols();
  const auto discrete = discretised(run_.noise.cwiseAbs2().asDiagonal());
  const MatrixXd no_prior;
  const filters::OutputErrorPass pass =
      filters::OutputError(*discrete, motion_.initial_state, directions_.all(), record_, no_prior)
          .pass(VectorXd::Zero(starts + q), record_.size());
  if (!pass.finite) return 0.0;
  std::vector<Index> projected(static_cast<std::size_t>(starts));
  std::iota(projected.begin(), projected.end(), Index{0});
  const MatrixXd root = pass.information.without(projected).root();
  const MatrixXd unit = directions_.unknowns(places, Eigen::all);
  const Eigen::LLT<MatrixXd> prior(started_.guess.unknowns);
  const MatrixXd known = unit.transpose() * prior.solve(unit);
  const MatrixXd a = root.topLeftCorner(q, q);
  const Eigen::LLT<MatrixXd> information(a.transpose() * a + known);
  const VectorXd before = started_.guess.mean(started_.model.unknown_places) - motion_.initial_state(places);
  const VectorXd slope = a.transpose() * root.col(q).head(q) + unit.transpose() * prior.solve(before);
  const VectorXd step = unit * information.solve(slope);
  const MatrixXd covariance = unit * information.solve(unit.transpose());
  return step.cwiseQuotient(covariance.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff();
}

// Its innovations and histories are those of the estimates then, unless it loses its way once more.
void Passes::filter_from_there() {
  filters::FilterRun histories = std::move(run_.run);
  ComparedRun before = run_;
  bool whole = false;
  try {
    whole = filter_once();
  } catch (const std::runtime_error&) {  // no motion at its end
  }
  if (whole) return;
  run_ = std::move(before);
  run_.run = std::move(histories);
}

bool Passes::is_linear_and_driven() const {
  return context_.analysis.forced() && !is_nonlinear(*run_.model) && !nearest_with_own_scheme() &&
         !has_noise(run_.settings.input_noise);
}

// K and C of a decay that ends within a cycle or two are known by the time that a filter has been linearised
// anew by its first samples, far from them: of a damping ratio of 0.3 its intervals hold 70 % of the truths.
bool Passes::is_free_mode() const {
  constexpr double heavy = 0.05;  // damping ratio: the decay's time constant is three cycles
  const auto& modal = context_.analysis.modal;
  return modal && modal->damping_ratio > heavy && !context_.analysis.forced() && nearest_with_own_scheme() &&
         !has_noise(run_.settings.input_noise) && !context_.compared.clocks_are_aligned;
}

std::optional<StartedModel> Passes::start_by_output_error() {
  if (!(is_linear_and_driven() || is_free_mode()) || started_.by_output_error) return {};
  std::optional<filters::Gaussian> found;
  try {
    found = output_error(started_.guess.mean, longest_guess);
  } catch (const std::runtime_error&) {  // no motion there
  }
  if (!found || motion_.misfit_percent > not_the_record) return {};
  StartedModel nearer = started_;
  nearer.by_output_error = true;
  nearer.linearised_at = {};
  nearer.guess.mean(started_.model.unknown_places) = found->mean;
  nearer.guess.unknowns = guess_covariance(started_.guess.unknowns, found->covariance);
  return nearer;
}

void Passes::mend_by_output_error() {
  constexpr double much_better = 0.5;  // of what is left
  // A filter, linearised from sample to sample, is surer of a storey's law than the record allows.
  const bool laws = has_storey_laws(*run_.model);
  if (has_noise(run_.settings.input_noise) || run_.run.last.covariance.size() == 0) return;
  context_.progress(fmt::format("all {} samples at once", record_.size()));
  const bool driven = is_linear_and_driven(), free = is_free_mode(), asked = driven || free;
  const double apart = free ? 0.25 : 0.5;  // of a deviation
  const bool astray =
      (driven && !has_settled()) || (asked && (is_overconfident() || distance_from_all_samples() > apart));
  const bool any_less = laws || astray;
  const double& now_left = any_less ? motion_.response_error_percent : motion_.misfit_percent;  // of motion_
  const double left = now_left;
  if (!any_less && !(asked && left > not_the_record)) return;
  const auto start = std::chrono::steady_clock::now();
  const VectorXd filtered = motion_.initial_state, noise = run_.noise;
  std::optional<filters::Gaussian> best;
  double least = any_less ? left * (1.0 + 1e-9) : much_better * left, misfit = motion_.misfit_percent;
  const auto start_at = [&](const VectorXd& from, Index first_samples) {
    try {
      const std::optional<filters::Gaussian> found = output_error(from, first_samples);
      if (!found || !(now_left < least)) return;
      best = found;
      least = now_left;
      misfit = motion_.misfit_percent;
    } catch (const std::runtime_error&) {  // no motion where the search has ended
    }
  };
  start_at(filtered, 0);
  const bool searched = started_.guess.by_lines;  // from several starts
  if (!best || (misfit > not_the_record && !searched)) start_at(started_.guess.mean, longest_guess);
  if ((driven && !searched) || laws)
    for (const VectorXd& from : further_starts())
      if (misfit > not_the_record) start_at(from, 0);
  run_.noise = noise;
  begin_at(filtered);
  if (best) {
    take_unknowns(*best);
    filter_from_there();
    take_unknowns(*best);
    if (driven && astray && run_.diagnostics)
      run_.diagnostics->consistency.reset();  // of a filter gone astray
    run_.remarks.push_back(
        laws   ? std::string("The estimates are those of all samples at once (output error): a filter is "
                               "overconfident of the laws of storeys.")
        : free ? std::string("Few cycles stand above the noise. The filter, linearised from sample to "
                             "sample, ended overconfident or where all samples at once do not. The estimates "
                             "are those of all samples at once (output error).")
        : astray
            ? fmt::format("The filter did not converge, was overconfident, or ended at another estimate "
                          "(residual {:.4g} %). The estimates are those of all samples at once (output "
                          "error; residual {:.4g} %).",
                          left, now_left)
            : fmt::format("The filter settled with a residual of {:.3g} % of the record. The estimates are "
                          "those of all samples at once (output error), with a residual of {:.2g} %.",
                          left, now_left));
  }
  run_.seconds += seconds_since(start);
}

}  // namespace beamid::experiments
