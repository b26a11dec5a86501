#include "experiments/identify/nonlinear_reproduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "filters/batch_estimator.hpp"
#include "filters/output_error.hpp"
#include "filters/sample_walk.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
