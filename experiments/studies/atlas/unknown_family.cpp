#include "experiments/studies/atlas/many_degrees.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "experiments/signal/toolbox.hpp"
#include "filters/discrete_model.hpp"
#include "filters/filter_run.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::SecondOrder;

/// B of [x; x']' = A [x; x'] + B f (2n x m).
MatrixXd input_matrix_of(const UnknownFamily& family) {
  MatrixXd matrix = MatrixXd::Zero(2 * family.truth.size(), family.places.cols());
  if (matrix.cols() > 0)
    matrix.bottomRows(family.truth.size()) = Eigen::LDLT<MatrixXd>(family.truth.mass).solve(family.places);
  return matrix;
}

/// What is observed of [x; x'] (p x 2n).
MatrixXd observed_rows(const UnknownFamily& family) {
  const Index n = family.truth.size(), p = family.outputs.rows();
  MatrixXd rows = MatrixXd::Zero(family.velocities ? 2 * p : p, 2 * n);
  rows.topLeftCorner(p, n) = family.outputs;
  if (family.velocities) rows.bottomRightCorner(p, n) = family.outputs;
  return rows;
}

/// -M^-1 K and -M^-1 C in the last n rows (2n x 2n).
MatrixXd rows_of_rates(const UnknownFamily& family, const MatrixXd& stiffness, const MatrixXd& damping) {
  const Index n = family.truth.size();
  const Eigen::LDLT<MatrixXd> mass(family.truth.mass);
  MatrixXd made = MatrixXd::Zero(2 * n, 2 * n);
  made.bottomLeftCorner(n, n) = -mass.solve(stiffness);
  made.bottomRightCorner(n, n) = -mass.solve(damping);
  return made;
}

/// dA / du_j.
MatrixXd slope_of(const UnknownFamily& family, const UnknownFamily::Part& part) {
  const MatrixXd zero = MatrixXd::Zero(family.truth.size(), family.truth.size());
  return rows_of_rates(family, part.damping ? zero : part.matrix, part.damping ? part.matrix : zero);
}

/// The family as a filter takes it: state [x, x', u].
class FamilyMotion final : public filters::LinearMotion {
 public:
  explicit FamilyMotion(const UnknownFamily& family)
      : parts_(family.parts),
        n_(family.truth.size()),
        input_(input_matrix_of(family)),
        observed_(observed_rows(family)) {
    const SecondOrder fixed = family.at(VectorXd::Zero(static_cast<Index>(parts_.size())));
    fixed_ = fixed.motion_matrix();
    for (const UnknownFamily::Part& part : parts_) slopes_.push_back(slope_of(family, part));
  }

  Index input_size() const override { return input_.cols(); }
  Index motion_size() const override { return 2 * n_; }
  Index parameter_size() const override { return static_cast<Index>(slopes_.size()); }
  void motion_matrix(const VectorXd& state, MatrixXd& matrix) const override {
    matrix = fixed_;
    for (std::size_t j = 0; j < slopes_.size(); ++j)
      matrix.bottomRows(n_) += state[2 * n_ + static_cast<Index>(j)] * slopes_[j].bottomRows(n_);
  }
  void motion_matrix_derivative(const VectorXd&, Index j, MatrixXd& matrix) const override {
    matrix = slopes_[static_cast<std::size_t>(j)];
  }
  void input_matrix(const VectorXd&, MatrixXd& matrix) const override { matrix = input_; }
  std::vector<filters::Label> state_labels() const override {
    std::vector<filters::Label> labels;
    for (Index i = 0; i < 2 * n_; ++i) labels.push_back({"x_" + std::to_string(i + 1), i < n_ ? "m" : "m/s"});
    for (const UnknownFamily::Part& part : parts_) labels.push_back({part.name, part.unit});
    return labels;
  }
  std::vector<filters::Label> output_labels() const override {
    return std::vector<filters::Label>(static_cast<std::size_t>(observed_.rows()), {"x", "m"});
  }
  void output(const VectorXd& state, const VectorXd&, VectorXd& output) const override {
    output.noalias() = observed_ * state.head(2 * n_);
  }
  void output_jacobian(const VectorXd& state, const VectorXd&, MatrixXd& jacobian) const override {
    jacobian.setZero(observed_.rows(), state.size());
    jacobian.leftCols(2 * n_) = observed_;
  }

 private:
  std::vector<UnknownFamily::Part> parts_;
  Index n_;
  MatrixXd input_, observed_, fixed_;
  std::vector<MatrixXd> slopes_;
};

/// What one unit of `scale` of each unknown does to A.
std::vector<MatrixXd> directions_of(const UnknownFamily& family) {
  std::vector<MatrixXd> directions;
  for (const UnknownFamily::Part& part : family.parts)
    directions.push_back(part.scale * slope_of(family, part));
  return directions;
}

/// Of z_k+1 = G z_k: what z_0 and changes of G do to the displacements observed (p N x 2n + d).
MatrixXd sensitivities(const UnknownFamily& family, const VectorXd& start, const MatrixXd& step,
                       const std::vector<MatrixXd>& changes) {
  const Index n = family.truth.size(), p = family.outputs.rows(), l = 2 * n,
              d = static_cast<Index>(changes.size());
  MatrixXd found(p * family.samples, l + d);
  VectorXd z = start;
  MatrixXd slope = MatrixXd::Zero(l, l + d), moved;
  slope.leftCols(l).setIdentity();
  for (Index i = 0; i < family.samples; ++i) {
    found.middleRows(i * p, p).noalias() = family.outputs * slope.topRows(n);
    moved.noalias() = step * slope;
    for (Index j = 0; j < d; ++j) moved.col(l + j).noalias() += changes[static_cast<std::size_t>(j)] * z;
    slope.swap(moved);
    z = step * z;
  }
  return found;
}

VectorXd released(const UnknownFamily& family) {
  VectorXd start = VectorXd::Zero(2 * family.truth.size());
  start.head(family.truth.size()) = family.start;
  return start;
}

/// What z_0 and changes of A along directions do to the exact record (p N x 2n + d).
MatrixXd record_sensitivities(const UnknownFamily& family, std::vector<MatrixXd> directions) {
  const auto exact = filters::scheme_registry().make("exponential", {});
  const MatrixXd a = family.truth.motion_matrix() * family.interval;
  for (MatrixXd& direction : directions)
    direction = filters::amplification_slope(*exact, a, direction * family.interval);
  return sensitivities(family, released(family), a.exp(), directions);
}

/// x of columns x = right, each column brought to length 1.
MatrixXd solved(const MatrixXd& columns, const MatrixXd& right) {
  const VectorXd size = columns.colwise().norm().cwiseMax(1e-300).cwiseInverse().transpose();
  const MatrixXd scaled = columns * size.asDiagonal();
  return size.asDiagonal() * scaled.householderQr().solve(right);
}

/// Of a complete family, entry by entry.
VectorXd of_entries(const UnknownFamily& family, const SecondOrder& target) {
  VectorXd found = family.values();
  for (const bool damping : {false, true}) {
    const MatrixXd& rest = damping ? target.damping : target.stiffness;
    std::vector<Index> places;
    for (std::size_t j = 0; j < family.parts.size(); ++j)
      if (family.parts[j].damping == damping) places.push_back(static_cast<Index>(j));
    MatrixXd columns(rest.size(), static_cast<Index>(places.size()));
    for (std::size_t j = 0; j < places.size(); ++j)
      columns.col(static_cast<Index>(j)) =
          family.parts[static_cast<std::size_t>(places[j])].matrix.reshaped();
    const VectorXd values = solved(columns, rest.reshaped());
    for (std::size_t j = 0; j < places.size(); ++j) found[places[j]] = values[static_cast<Index>(j)];
  }
  return found;
}

}  // namespace

SecondOrder UnknownFamily::at(const VectorXd& unknowns) const {
  const Index n = truth.size();
  SecondOrder made{truth.mass, fixed_damping.size() > 0 ? fixed_damping : MatrixXd::Zero(n, n),
                   fixed_stiffness.size() > 0 ? fixed_stiffness : MatrixXd::Zero(n, n)};
  for (std::size_t j = 0; j < parts.size(); ++j)
    (parts[j].damping ? made.damping : made.stiffness) += unknowns[static_cast<Index>(j)] * parts[j].matrix;
  return made;
}

VectorXd UnknownFamily::values() const {
  VectorXd found(static_cast<Index>(parts.size()));
  for (Index j = 0; j < found.size(); ++j) found[j] = parts[static_cast<std::size_t>(j)].value;
  return found;
}

MatrixXd nearest(const UnknownFamily& family, const std::vector<SecondOrder>& targets) {
  const Index l = 2 * family.truth.size(), q = static_cast<Index>(family.parts.size()),
              count = static_cast<Index>(targets.size());
  MatrixXd found(q, count);
  if (family.complete) {
    for (Index k = 0; k < count; ++k) found.col(k) = of_entries(family, targets[static_cast<std::size_t>(k)]);
    return found;
  }
  std::vector<MatrixXd> directions = directions_of(family);
  for (const SecondOrder& target : targets)
    directions.push_back(rows_of_rates(family, target.stiffness - family.truth.stiffness,
                                       target.damping - family.truth.damping));
  const MatrixXd columns = record_sensitivities(family, std::move(directions)),
                 moved = solved(columns.leftCols(l + q), columns.rightCols(count));
  for (Index j = 0; j < q; ++j) {
    const UnknownFamily::Part& part = family.parts[static_cast<std::size_t>(j)];
    found.row(j) = (moved.row(l + j).array() * part.scale + part.value).matrix();
  }
  return found;
}

filters::Measurements exact_record(const UnknownFamily& family) {
  const Index l = 2 * family.truth.size(), m = family.places.cols();
  MatrixXd held = MatrixXd::Zero(l + m, l + m);  // [x; x'; f], f constant from sample to sample
  held.topLeftCorner(l, l) = family.truth.motion_matrix();
  held.topRightCorner(l, m) = input_matrix_of(family);
  const MatrixXd step = (held * family.interval).exp(), rows = observed_rows(family);
  VectorXd z = released(family);
  filters::Measurements record;
  record.time = VectorXd::LinSpaced(family.samples, 0.0, family.interval * double(family.samples - 1));
  record.outputs.resize(rows.rows(), family.samples);
  record.inputs = family.forces;
  for (Index i = 0; i < family.samples; ++i) {
    record.outputs.col(i) = rows * z;
    z = (step.topLeftCorner(l, l) * z).eval();
    if (m > 0) z += step.topRightCorner(l, m) * family.forces.col(i);
  }
  return record;
}

std::optional<VectorXd> measured_unknowns(const UnknownFamily& family, const std::string& scheme,
                                          const FamilyRun& how) {
  const Index n = family.truth.size(), q = static_cast<Index>(family.parts.size());
  filters::Measurements record = exact_record(family);
  const auto motion = std::make_shared<FamilyMotion>(family);
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> modes(family.truth.stiffness, family.truth.mass,
                                                                 Eigen::EigenvaluesOnly);
  const double size = record.outputs.topRows(family.outputs.rows()).cwiseAbs().maxCoeff(),
               noise = (how.noise > 0.0 ? how.noise : 1e-7) * size,
               fastest = std::sqrt(modes.eigenvalues().maxCoeff());
  VectorXd state = released(family), scale(q), noises = VectorXd::Zero(2 * n + q);
  state.conservativeResize(2 * n + q);
  state.tail(q) = family.values();
  for (Index j = 0; j < q; ++j) scale[j] = family.parts[static_cast<std::size_t>(j)].scale;
  noises.head(n).setConstant(family.motion_noise * size);
  noises.segment(n, n).setConstant(family.motion_noise * size * fastest);
  VectorXd of_sensors = VectorXd::Constant(record.outputs.rows(), noise);
  if (family.velocities) of_sensors.tail(family.outputs.rows()) *= fastest;
  if (how.noise > 0.0)
    for (Index i = 0; i < record.outputs.rows(); ++i)
      record.outputs.row(i) +=
          of_sensors[i] *
          standard_normal(record.outputs.cols(), how.seed, static_cast<std::uint64_t>(i)).transpose();
  // As uncertain as the bias may be, then less and less: what a linearisation drops vanishes too. In noise a
  // narrow prior would count the record twice.
  const std::vector<double> shares =
      how.noise > 0.0 ? std::vector<double>{1.0, 1.0} : std::vector<double>{1.0, 1e-1, 1e-2, 1e-3};
  for (const double share : shares) {
    VectorXd deviation(2 * n + q);
    deviation << VectorXd::Constant(n, size), VectorXd::Constant(n, fastest * size), share * scale;
    filters::Noise assumed{{}, of_sensors.cwiseAbs2().asDiagonal()};
    if (family.motion_noise > 0.0) assumed.process = noises.cwiseAbs2().asDiagonal();
    const auto filter = filters::filter_registry().make(
        how.filter, {}, filters::discretise(motion, family.interval, scheme, assumed));
    const filters::FilterRun run =
        filters::run(*filter, {state, MatrixXd(deviation.cwiseAbs2().asDiagonal())}, record);
    if (run.failure) return {};
    state.tail(q) = run.last.mean.tail(q);
  }
  return state.tail(q);
}

VectorXd bounds(const UnknownFamily& family, double noise) {
  const Index l = 2 * family.truth.size(), q = static_cast<Index>(family.parts.size());
  MatrixXd columns = record_sensitivities(family, directions_of(family));
  const VectorXd size = columns.colwise().norm().cwiseMax(1e-300).cwiseInverse().transpose();
  columns = (columns * size.asDiagonal()).eval();
  const MatrixXd root = columns.householderQr().matrixQR().topRows(l + q).triangularView<Eigen::Upper>();
  const MatrixXd inverse = root.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(l + q, l + q));
  const double deviation = noise * exact_record(family).outputs.cwiseAbs().maxCoeff();
  VectorXd found(q);
  for (Index j = 0; j < q; ++j)
    found[j] =
        deviation * size[l + j] * inverse.row(l + j).norm() * family.parts[static_cast<std::size_t>(j)].scale;
  return found;
}

}  // namespace beamid::experiments
