#include "experiments/identify/verdict/reproduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "experiments/signal/missing_samples.hpp"
#include "filters/batch_estimator.hpp"
#include "filters/diagnostics.hpp"
#include "filters/fisher_information.hpp"
#include "filters/output_error.hpp"
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

Reproduction reproduce(filters::DiscreteModel& model, const VectorXd& state,
                       const StartDirections& directions, const filters::Measurements& record) {
  const Index samples = record.time.size(), p = record.outputs.rows(), k = directions.motion.cols();
  const Eigen::LLT<MatrixXd> noise(model.output_noise());
  // Everything but the parameters starts at zero and is found.
  VectorXd start = state;
  for (Index i = 0; i < start.size(); ++i)
    if (directions.unknowns.row(i).isZero(0.0)) start[i] = 0.0;

  MatrixXd read(p * samples, k), sensor, moved = directions.motion;
  MatrixXd forced(p, samples), rows(p, k + 1);
  VectorXd output(p);
  filters::InformationFactor equations(k + 1);
  filters::walk_samples(model, record, samples, start, moved,
                        [&](Index step, const auto& x, const auto& input) {
                          model.output(x, input, output);
                          model.output_jacobian(x, input, sensor);
                          forced.col(step) = output;
                          read.middleRows(step * p, p).noalias() = sensor * moved;
                          if (!read.middleRows(step * p, p).allFinite() || !output.allFinite())
                            throw std::runtime_error("the reproduced motion grows beyond all bounds at " +
                                                     std::to_string(record.time[step]) + " s");
                          rows << read.middleRows(step * p, p), record.outputs.col(step) - output;
                          for (Index i = 0; i < p; ++i)
                            if (std::isnan(record.outputs(i, step)))
                              rows.row(i).setZero();  // channels' noises are independent
                          noise.matrixL().solveInPlace(rows);
                          equations.add(rows);
                        });
  const VectorXd found = solution(equations);

  Reproduction result;
  result.initial_state = start + directions.motion * found;
  result.outputs = forced + (read * found).reshaped(p, samples);
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
