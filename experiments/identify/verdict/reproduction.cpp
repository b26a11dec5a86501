#include "experiments/identify/verdict/reproduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "experiments/signal/missing_samples.hpp"
#include "filters/algorithms/products.hpp"
#include "filters/batch_estimator.hpp"
#include "filters/diagnostics.hpp"
#include "filters/fisher_information.hpp"
#include "filters/linear_gaussian.hpp"
#include "filters/output_error.hpp"
#include "filters/sample_clock.hpp"
#include "filters/sample_walk.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

// The least squares solution of rows [A b], kept as their triangular factor.
VectorXd solution(const filters::InformationFactor& equations) {
  // Columns of start directions differ by many orders of magnitude: a unit diagonal first.
  const MatrixXd root = equations.root();
  const Index k = root.cols() - 1;
  const VectorXd scale =
      root.topLeftCorner(k, k).colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  const MatrixXd factor = root.topLeftCorner(k, k) * scale.asDiagonal();
  return scale.cwiseProduct(factor.completeOrthogonalDecomposition().solve(root.col(k).head(k)));
}

}  // namespace

void take_misfit(const filters::Measurements& record, Reproduction& motion) {
  motion.residual_deviation = root_mean_squares(record.outputs - motion.outputs);
  const VectorXd share =
      motion.residual_deviation.cwiseQuotient(root_mean_squares(record.outputs).cwiseMax(1e-300));
  constexpr double surely_coloured = 1e-3;
  const double per_channel = 100.0 / std::sqrt(static_cast<double>(share.size()));
  motion.response_error_percent = per_channel * share.norm();
  double coloured = 0.0;
  for (Index i = 0; i < share.size(); ++i) {
    const VectorXd rest = record.outputs.row(i) - motion.outputs.row(i);
    const filters::Whiteness whiteness = filters::whiteness_of(rest);
    // White noise beside a motion takes a part of its own from every correlation.
    if (whiteness.p_value < surely_coloured)
      coloured += share[i] * share[i] * std::min(1.0, whiteness.autocorrelation.cwiseAbs().maxCoeff());
  }
  motion.misfit_percent = per_channel * std::sqrt(coloured);
}

namespace {

// Whether every stamp is one regular interval behind the one before.
bool has_even_stamps(const filters::Measurements& record, double interval) {
  filters::SampleClock clock(interval, record.time_resolution);
  clock.start(record.time[0]);
  for (Index k = 1; k < record.time.size(); ++k)
    if (clock.advance(record.time[k]) != interval) return false;
  return true;
}

// Outputs of a motion whose parameters stay, and how they follow from its start, sample by sample.
class LinearWalk {
 public:
  // @param state parameters in their places (n); everything else starts at zero
  LinearWalk(filters::DiscreteModel& model, const VectorXd& state, const StartDirections& directions,
             const filters::Measurements& record)
      : model_(model), record_(record), start_(state), directions_(directions.motion) {
    std::vector<Index> held, moving;
    for (Index i = 0; i < state.size(); ++i) {
      const bool is_unknown = !directions.unknowns.row(i).isZero(0.0);
      if (!is_unknown) start_[i] = 0.0;
      (is_unknown && directions_.row(i).isZero(0.0) ? held : moving).push_back(i);
    }
    constexpr std::size_t small = 16;  // up to here dense products are faster than the model's own steps
    if (moving.size() > small || !has_even_stamps(record, model.interval())) return;
    const MatrixXd none = MatrixXd::Zero(state.size(), state.size());
    constant_ = filters::linear_gaussian(model, held, start_(held), {start_, none, {}}, record.inputs.rows());
    moving_ = std::move(moving);
  }

  const VectorXd& start() const { return start_; }

  // Calls visit(k, columns), columns = [y_k, dy_k / d start along each direction]^T ((1 + d) x p).
  template <class Visit>
  void with_directions(const Visit& visit) const {
    if (constant_) return by_constant_matrices(start_, directions_, visit);
    MatrixXd moved = directions_, sensor, columns(1 + moved.cols(), record_.outputs.rows());
    VectorXd output;
    filters::walk_samples(model_, record_, record_.time.size(), start_, moved,
                          [&](Index k, const VectorXd& x, const VectorXd& input) {
                            model_.output(x, input, output);
                            model_.output_jacobian(x, input, sensor);
                            columns.row(0) = output.transpose();
                            columns.bottomRows(moved.cols()).noalias() = (sensor * moved).transpose();
                            visit(k, columns);
                          });
  }

  // Outputs from another start (p x N).
  MatrixXd outputs(const VectorXd& start) const {
    MatrixXd found(record_.outputs.rows(), record_.time.size()), none;
    VectorXd output;
    if (constant_)
      by_constant_matrices(start, MatrixXd(start.size(), 0), [&](Index k, const MatrixXd& columns) {
        found.col(k) = columns.row(0).transpose();
      });
    else
      filters::walk_samples(model_, record_, record_.time.size(), start, none,
                            [&](Index k, const VectorXd& x, const VectorXd& input) {
                              model_.output(x, input, output);
                              found.col(k) = output;
                            });
    return found;
  }

 private:
  // W <- W A^T + [G u, 0]^T, W = [x D]^T of the entries that move: long columns make fast products.
  template <class Visit>
  void by_constant_matrices(const VectorXd& start, const MatrixXd& directions, const Visit& visit) const {
    const filters::LinearGaussian& m = *constant_;
    const bool forced = record_.inputs.size() > 0;
    MatrixXd moved(1 + directions.cols(), m.a.rows()), next, columns;
    moved << start(moving_).transpose(), directions(moving_, Eigen::all).transpose();
    for (Index k = 0; k < record_.time.size(); ++k) {
      filters::algorithms::multiply_transposed(moved, m.h, columns);
      if (forced) columns.row(0) += (m.d * record_.inputs.col(k)).transpose();
      visit(k, columns);
      filters::algorithms::multiply_transposed(moved, m.a, next);
      if (forced) next.row(0) += (m.g * record_.inputs.col(k)).transpose();
      moved.swap(next);
    }
  }

  filters::DiscreteModel& model_;
  const filters::Measurements& record_;
  VectorXd start_;
  MatrixXd directions_;
  std::vector<Index> moving_;
  std::optional<filters::LinearGaussian> constant_;  // of a small model on even stamps
};

}  // namespace

Reproduction reproduce(filters::DiscreteModel& model, const VectorXd& state,
                       const StartDirections& directions, const filters::Measurements& record) {
  const LinearWalk walk(model, state, directions, record);
  const Index p = record.outputs.rows(), d = directions.motion.cols();
  const VectorXd weight = model.output_noise().diagonal().cwiseSqrt().cwiseInverse();
  MatrixXd whitened(p, d + 1);
  filters::InformationFactor equations(d + 1);
  walk.with_directions([&](Index k, const MatrixXd& columns) {
    if (!columns.allFinite())
      throw std::runtime_error("the reproduced motion grows beyond all bounds at " +
                               std::to_string(record.time[k]) + " s");
    for (Index i = 0; i < p; ++i) {
      const double read = record.outputs(i, k), weighs = std::isnan(read) ? 0.0 : weight[i];
      for (Index j = 0; j < d; ++j) whitened(i, j) = weighs * columns(1 + j, i);
      whitened(i, d) = weighs > 0.0 ? weighs * (read - columns(0, i)) : 0.0;
    }
    equations.add(whitened);
  });

  Reproduction result;
  result.initial_state = walk.start() + directions.motion * solution(equations);
  result.outputs = walk.outputs(result.initial_state);
  take_misfit(record, result);
  return result;
}

Index samples_in(const JointModel& model, const filters::Measurements& record, double periods) {
  const Index all = record.time.size();
  const double period = 2.0 * std::numbers::pi / model.mode_frequencies[0];
  return std::clamp<Index>(static_cast<Index>(std::ceil(periods * period / record.interval())),
                           std::min<Index>(16, all), all);
}

VectorXd nearest_phase(filters::DiscreteModel& discrete, const VectorXd& state,
                       const StartDirections& directions, const filters::Measurements& record,
                       Index samples) {
  constexpr int phases = 16;
  const MatrixXd no_prior;
  filters::OutputError misfit(discrete, state, directions.motion, record, no_prior);
  VectorXd best = VectorXd::Zero(directions.motion.cols()), tried = best;
  double least = std::numeric_limits<double>::infinity();
  const auto take = [&] {
    const filters::OutputErrorPass pass = misfit.pass(tried, samples);
    if (!pass.finite || pass.cost >= least) return;
    least = pass.cost;
    best = tried;
  };
  take();
  for (const double size : {1.0, 0.6, 0.3})
    for (int i = 0; i < phases; ++i) {
      const double phase = 2.0 * std::numbers::pi * i / phases;
      tried.head<2>() << size * std::cos(phase), size * std::sin(phase);
      take();
    }
  return state + directions.motion * best;
}

Reproduction reproduce_nonlinear(const JointModel& model, filters::DiscreteModel& discrete,
                                 const VectorXd& state, const StartDirections& directions,
                                 const filters::Measurements& record) {
  const Index r = model.motion_size(), samples = record.time.size();
  filters::BatchSettings settings;
  settings.tolerance = 1e-4;
  VectorXd start = state;
  if (state.head(2 * r).isZero(0.0)) {
    settings.first_samples = samples_in(model, record, 1.5);
    start = nearest_phase(discrete, state, directions, record, settings.first_samples);
  }
  const filters::BatchEstimate found =
      filters::estimate_batch(discrete, start, directions.motion, record, settings);
  if (found.status == filters::BatchStatus::failed)
    throw std::runtime_error("no motion of the model is near the record: " + found.reason);

  Reproduction result;
  result.initial_state = found.state;
  result.outputs.resize(record.outputs.rows(), samples);
  VectorXd output;
  MatrixXd none;
  filters::walk_samples(discrete, record, samples, found.state, none,
                        [&](Index k, const VectorXd& x, const VectorXd& input) {
                          discrete.output(x, input, output);
                          result.outputs.col(k) = output;
                        });
  take_misfit(record, result);
  return result;
}

}  // namespace beamid::experiments
