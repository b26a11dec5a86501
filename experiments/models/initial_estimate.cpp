#include "experiments/models/initial_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr Index largest_dense_state = 400;
constexpr double offset_share = 0.1;  // of the largest reading, what a sensor's bias may be

// Reading per displacement of a motion at omega: 1, omega, omega^2; a strain reads the curvature.
double reading(Quantity quantity, double omega) {
  if (quantity == Quantity::velocity) return omega;
  return quantity == Quantity::acceleration || is_angular(quantity) ? omega * omega : 1.0;
}

Index state_size(const JointModel& model) {
  return static_cast<Index>(model.motion->state_labels().size());
}

}  // namespace

StartScale start_scale(const JointModel& model, const std::vector<Observation>& observations,
                       const MatrixXd& samples, double duration) {
  const Index r = model.motion_size();
  const double omega = model.mode_frequencies[0];
  StartScale scale{0.0, duration};
  // What the model's outputs read of a unit of mode 1, displaced or, for velocities, moving.
  VectorXd state = VectorXd::Zero(state_size(model)), displaced;
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    state[model.unknown_places[j]] = model.unknowns[j].to_state(model.unknowns[j].guess);
  const VectorXd no_input = VectorXd::Zero(model.motion->input_size());
  VectorXd moving;
  // A motion so small that any model is linear; a power of two costs no digit.
  constexpr double little = 0x1p-20;
  state.head(r) = little * model.mode_shapes.col(0);
  model.motion->output(state, no_input, displaced);
  state.head(r).setZero();
  state.segment(r, r) = little * omega * model.mode_shapes.col(0);
  model.motion->output(state, no_input, moving);
  displaced /= little;
  moving /= little;
  std::vector<double> sizes;
  for (Index i = 0; i < samples.rows(); ++i) {
    const double unit = observations[i].quantity == Quantity::velocity ? moving[i] : displaced[i];
    // A sensor near a node of the mode says nothing about its size.
    const double usual = reading(observations[i].quantity, omega);
    const bool deflects =
        observations[i].quantity != Quantity::strain && !is_angular(observations[i].quantity);
    if (deflects && std::abs(unit) < 0.05 * usual) continue;
    if (const double largest = largest_measured(samples.row(i)); unit != 0.0 && largest > 0.0)
      sizes.push_back(largest / std::abs(unit));
  }
  // A gauge that the mode hardly strains, at a free end, reads noise: no size of a motion.
  constexpr double far_above = 1e3;
  if (sizes.empty()) return scale;
  const double least = *std::min_element(sizes.begin(), sizes.end());
  for (const double size : sizes)
    if (size <= far_above * least) scale.displacement = std::max(scale.displacement, size);
  return scale;
}

MatrixXd StartDirections::all() const {
  MatrixXd both(motion.rows(), motion.cols() + unknowns.cols());
  both << motion, unknowns;
  return both;
}

StartDirections start_directions(const JointModel& model, const std::vector<Observation>& observations,
                                 const StartScale& scale) {
  const Index n = state_size(model), r = model.motion_size(), k = model.mode_shapes.cols();
  const auto offsets = static_cast<Index>(model.offsets.size()),
             slips = static_cast<Index>(model.slips.size()), q = static_cast<Index>(model.unknowns.size());
  StartDirections directions{MatrixXd::Zero(n, 2 * k + offsets + slips), MatrixXd::Zero(n, q)};
  const double first = model.mode_frequencies[0];
  for (Index i = 0; i < k; ++i) {
    const double omega = std::max(model.mode_frequencies[i], first);
    directions.motion.col(2 * i).head(r) = scale.displacement * first / omega * model.mode_shapes.col(i);
    directions.motion.col(2 * i + 1).segment(r, r) = scale.displacement * first * model.mode_shapes.col(i);
  }
  for (Index i = 0; i < offsets; ++i) {
    const JointModel::Offset& offset = model.offsets[i];
    const double bias =
        offset_share * scale.displacement * reading(observations[offset.channel].quantity, first);
    directions.motion(offset.place, 2 * k + i) = offset.drift ? bias / scale.duration : bias;
  }
  for (Index i = 0; i < slips; ++i)
    directions.motion(model.slips[i], 2 * k + offsets + i) = scale.displacement;
  for (Index j = 0; j < q; ++j) {
    const Unknown& unknown = model.unknowns[j];
    directions.unknowns(model.unknown_places[j], j) =
        unknown.deviation / std::abs(unknown.slope(unknown.to_state(unknown.guess)));
  }
  return directions;
}

filters::Gaussian initial_estimate(const JointModel& model, const StartDirections& directions) {
  filters::Gaussian estimate{VectorXd::Zero(state_size(model)), {}, directions.all()};
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    estimate.mean[model.unknown_places[j]] = model.unknowns[j].to_state(model.unknowns[j].guess);
  if (estimate.mean.size() <= largest_dense_state)
    estimate.covariance = estimate.factor * estimate.factor.transpose();
  return estimate;
}

}  // namespace beamid::experiments
