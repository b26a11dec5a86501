#include "experiments/models/joint_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "experiments/models/banded/continuum_motion.hpp"
#include "experiments/models/motion/second_order_motion.hpp"
#include "experiments/models/motion/storey_motion.hpp"
#include "experiments/signal/missing_samples.hpp"

namespace beamid::experiments {

ModelRegistry& model_registry() {
  static ModelRegistry registry("model");
  return registry;
}

ModelSetting at_one_point(const fem::StructuralSystem& system, const std::vector<Quantity>& observed) {
  ModelSetting setting;
  setting.system = system;
  const Eigen::MatrixXd row = Eigen::MatrixXd(system.outputs).row(0);
  setting.system.outputs = row.replicate(static_cast<Eigen::Index>(observed.size()), 1).sparseView();
  setting.system.output_names.assign(observed.size(),
                                     system.output_names.empty() ? "" : system.output_names[0]);
  for (const Quantity quantity : observed) setting.observations.push_back({quantity});
  return setting;
}

void require_no_supports(const std::string& model, const ModelSetting& setting) {
  if (!setting.supports.empty())
    throw std::invalid_argument("model '" + model +
                                "' has no place for support_acceleration; expected [model] name = \"beam\"");
}

reduction::ReducedModel reduced(const ModelSetting& setting) {
  if (setting.reduction) return reduce(setting.system, *setting.reduction, setting.training);
  const auto none = reduction::reduction_registry().make("none", {});
  return reduce(setting.system, *none);
}

bool is_whole_mesh(const JointModel& model) {
  return dynamic_cast<const ContinuumMotion*>(model.motion.get()) != nullptr;
}

bool is_nonlinear(const JointModel& model) {
  return !is_whole_mesh(model) && dynamic_cast<const filters::LinearMotion*>(model.motion.get()) == nullptr;
}

bool has_storey_laws(const JointModel& model) {
  return dynamic_cast<const StoreyMotion*>(model.motion.get()) != nullptr;
}

std::string finest_discretisation(const JointModel& model, double interval) {
  // The classical Runge-Kutta step is (omega dt)^4 / 120 of the frequency off: 1.3e-5 there.
  constexpr double largest_step = 0.2;  // [rad]
  if (has_storey_laws(model)) return "runge_kutta_4";
  if (is_nonlinear(model))
    return model.mode_frequencies[0] * interval < largest_step ? "runge_kutta_4" : "cvode";
  return is_whole_mesh(model) ? "pade" : "exponential";
}

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

JointModel with_modes_at(JointModel model, const VectorXd& state) {
  const auto* motion = dynamic_cast<const SecondOrderMotion*>(model.motion.get());
  if (!motion || !motion->has_modes_of_its_own()) return model;
  SecondOrderForm form;
  motion->evaluate(state, form, nullptr);
  // W = M^-1 K with M and K symmetric: real eigenvalues omega^2.
  const Eigen::EigenSolver<MatrixXd> solver(form.stiffness);
  const VectorXd squares = solver.eigenvalues().real();
  const MatrixXd vectors = solver.eigenvectors().real();
  std::vector<Index> order(static_cast<std::size_t>(squares.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return squares[a] < squares[b]; });
  for (Index i = 0; i < model.mode_shapes.cols(); ++i) {
    const Index k = order[static_cast<std::size_t>(i)];
    const double reach = (motion->rows() * vectors.col(k)).cwiseAbs().maxCoeff();
    if (!(squares[k] >= 0.0) || !(reach > 0.0))
      throw std::runtime_error("the model does not oscillate at these values of its unknowns");
    model.mode_frequencies[i] = std::sqrt(squares[k]);
    model.mode_shapes.col(i) = vectors.col(k) / reach;
  }
  return model;
}

MatrixXd motion_slopes(const JointModel& model, const VectorXd& state) {
  const Index r = model.motion_size(), q = static_cast<Index>(model.unknowns.size());
  MatrixXd slopes = MatrixXd::Zero(state.size(), q);
  const auto* motion = dynamic_cast<const SecondOrderMotion*>(model.motion.get());
  if (!motion || !motion->has_modes_of_its_own()) return slopes;
  const MatrixXd& shapes = model.mode_shapes;
  MatrixXd start(r, 2);
  start << state.head(r), state.segment(r, r);
  const MatrixXd amplitudes = shapes.colPivHouseholderQr().solve(start);  // a, b (k x 2)
  // The same modes elsewhere: their part along each shape held at one, which makes Phi(eta) smooth.
  const auto moved = [&](std::size_t j, double step) -> MatrixXd {
    VectorXd there = state;
    there[model.unknown_places[j]] += step;
    MatrixXd other = with_modes_at(model, there).mode_shapes;
    for (Index i = 0; i < shapes.cols(); ++i)
      other.col(i) *= shapes.col(i).squaredNorm() / other.col(i).dot(shapes.col(i));
    return other * amplitudes;
  };
  for (std::size_t j = 0; j < model.unknowns.size(); ++j) {
    const Unknown& unknown = model.unknowns[j];
    const double step = 1e-4 * unknown.deviation / std::abs(unknown.slope(state[model.unknown_places[j]]));
    const MatrixXd slope = (moved(j, step) - moved(j, -step)) / (2.0 * step);
    slopes.col(static_cast<Index>(j)).head(2 * r) = slope.reshaped();
  }
  return slopes;
}

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
