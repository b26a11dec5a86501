#include "experiments/models/motion/storey_motion.hpp"

#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <Eigen/LU>

#include "filters/discrete_model.hpp"
#include "filters/observed_model.hpp"
#include "filters/step_input.hpp"

namespace beamid::experiments {
namespace {

// The classical Runge-Kutta step of a chain with laws, in as many parts as its fastest mode asks for.

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class StoreyStep final : public filters::TimedModel {
 public:
  StoreyStep(std::shared_ptr<const StoreyMotion> motion, double dt, filters::Noise noise)
      : TimedModel(dt, std::move(noise)), motion_(std::move(motion)) {
    prepare();
  }

  std::vector<filters::Label> state_labels() const override { return motion_->state_labels(); }
  std::vector<filters::Label> output_labels() const override { return motion_->output_labels(); }

  void transition(const VectorXd& state, const VectorXd& input, VectorXd& next) override {
    step(state, input, next, nullptr);
  }
  void linearised_transition(const VectorXd& state, const VectorXd& input, VectorXd& next,
                             MatrixXd& jacobian) override {
    jacobian.setIdentity(motion_->size(), motion_->size());
    step(state, input, next, &jacobian);
  }
  void move(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd& directions) override {
    step(state, input, next, &directions);
  }
  void output(const VectorXd& state, const VectorXd& input, VectorXd& output) override {
    motion_->output(state, now(input), output);
  }
  void output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) override {
    motion_->output_jacobian(state, now(input), jacobian);
  }

 private:
  std::shared_ptr<const StoreyMotion> motion_;
  int parts_ = 1;
  StoreyMotion::Equations equations_;
  VectorXd rate_, point_;
  MatrixXd jacobian_, slope_, point_directions_;

  void interval_changed() override { prepare(); }
  void prepare() {
    constexpr double largest_turn = 0.15;  // [rad]
    parts_ = std::max(1, static_cast<int>(std::ceil(motion_->floors().frequencies().maxCoeff() * interval() /
                                                    largest_turn)));
  }

  VectorXd now(const VectorXd& path) const { return path.head(std::min(path.size(), motion_->input_size())); }

  void step(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd* directions) {
    const filters::StepInput path(input, motion_->input_size());
    motion_->evaluate(state, directions != nullptr, equations_);
    next = state;
    for (int i = 0; i < parts_; ++i) part(path, i, next, directions);
  }

  // k_i = f(z + a_i h k_i-1), a = 0, 1/2, 1/2, 1;  z+ = z + h sum b_i k_i, b = 1/6, 1/3, 1/3, 1/6; the same
  // of directions, whose rates are J (D + a_i h D'_i-1). Only motion and slips have rates.
  void part(const filters::StepInput& path, int number, VectorXd& z, MatrixXd* directions) {
    constexpr double node[4] = {0.0, 0.5, 0.5, 1.0};
    constexpr double weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    const double h = interval() / parts_;
    const Index motion = motion_->floors().layout().motion, slips_at = motion_->slips_at(),
                slips = motion_->slips();
    const VectorXd begin = z;
    MatrixXd begin_directions;
    rate_.setZero(z.size());
    if (directions) {
      begin_directions = *directions;
      slope_.setZero(motion + slips, directions->cols());
    }
    for (int i = 0; i < 4; ++i) {
      point_ = begin + node[i] * h * rate_;
      const VectorXd input = path.size() > 0 ? path.at((number + node[i]) / parts_) : VectorXd();
      motion_->rate(equations_, point_, input, rate_);
      z += weight[i] * h * rate_;
      if (!directions) continue;
      motion_->rate_jacobian(equations_, point_, input, jacobian_);
      point_directions_ = begin_directions;
      point_directions_.topRows(motion) += node[i] * h * slope_.topRows(motion);
      point_directions_.middleRows(slips_at, slips) += node[i] * h * slope_.bottomRows(slips);
      slope_.topRows(motion).noalias() = jacobian_.topRows(motion) * point_directions_;
      slope_.bottomRows(slips).noalias() = jacobian_.middleRows(slips_at, slips) * point_directions_;
      directions->topRows(motion) += weight[i] * h * slope_.topRows(motion);
      directions->middleRows(slips_at, slips) += weight[i] * h * slope_.bottomRows(slips);
    }
  }
};

/// The scheme `runge_kutta_4` in equal parts of the interval in which the fastest mode at the guess turns by
/// 0.15 rad at most, so that a part is 4e-6 of its frequency off: few samples per period of a high mode do
/// not blur it. The equations are evaluated once for all parts, tangents are those of the parts, exact, and
/// only what moves is moved. Null for other schemes.
std::unique_ptr<filters::DiscreteModel> storey_step(std::shared_ptr<const StoreyMotion> motion, double dt,
                                                    const std::string& scheme, const filters::Noise& noise) {
  if (scheme != "runge_kutta_4") return nullptr;
  return std::make_unique<StoreyStep>(std::move(motion), dt, noise);
}

}  // namespace

FloorMotion::FloorMotion(std::shared_ptr<const ReducedMotion> modes, const MatrixXd& shapes, MatrixXd rows)
    : SecondOrderMotion(modes->description(), std::move(rows), "floor"),
      modes_(std::move(modes)),
      shapes_(shapes),
      inverse_(shapes.inverse()) {}

void FloorMotion::evaluate(const VectorXd& state, SecondOrderForm& form,
                           std::vector<SecondOrderForm>* slopes) const {
  const auto turn = [&](SecondOrderForm& one) {
    one.stiffness = shapes_ * one.stiffness * inverse_;
    one.damping = shapes_ * one.damping * inverse_;
    one.inputs = shapes_ * one.inputs;
  };
  modes_->evaluate(state, form, slopes);
  turn(form);
  if (!slopes) return;
  for (SecondOrderForm& slope : *slopes) turn(slope);
}

/// What the laws add to the linear storeys at one state.
struct StoreyMotion::Springs {
  VectorXd forces;            // k d - r (s)
  MatrixXd force_slopes;      // by the state (s x N)
  VectorXd slip_rates;        // h' (t)
  MatrixXd slip_rate_slopes;  // by the state (t x N)
};

StoreyMotion::StoreyMotion(std::shared_ptr<const FloorMotion> floors, std::vector<LawStorey> storeys,
                           std::vector<Unknown> unknowns)
    : floors_(std::move(floors)), storeys_(std::move(storeys)), unknowns_(std::move(unknowns)) {
  for (const LawStorey& storey : storeys_) slips_ += storey.law->slips() ? 1 : 0;
}

Index StoreyMotion::input_size() const {
  return floors_->input_size() - static_cast<Index>(storeys_.size());
}

std::vector<filters::Label> StoreyMotion::state_labels() const {
  std::vector<filters::Label> labels = floors_->state_labels();
  for (const LawStorey& storey : storeys_)
    if (storey.law->slips()) labels.push_back({fmt::format("slip_{}", storey.number), "m"});
  for (const Unknown& unknown : unknowns_) labels.push_back(state_label(unknown));
  return labels;
}

void StoreyMotion::evaluate(const VectorXd& state, bool slopes, Equations& equations) const {
  floors_->evaluate(state, equations.form, slopes ? &equations.slopes : nullptr);
  equations.at = physical_values(floors_->description(), floors_->layout(), state);
}

StoreyMotion::Springs StoreyMotion::springs_at(const Equations& equations, const VectorXd& state,
                                               bool slopes) const {
  const Index n = floor_count(), count = static_cast<Index>(storeys_.size());
  const StateLayout& layout = floors_->layout();
  const auto& drives = floors_->description().drives;
  Springs all{VectorXd(count), MatrixXd(), VectorXd(slips_), MatrixXd()};
  if (slopes) {
    all.force_slopes.setZero(count, size());
    all.slip_rate_slopes.setZero(slips_, size());
  }
  Index slip_place = slips_at(), t = 0;
  for (Index s = 0; s < count; ++s) {
    const LawStorey& storey = storeys_[static_cast<std::size_t>(s)];
    const bool slips = storey.law->slips();
    const double d = storey.drift.dot(state.head(n)), v = storey.drift.dot(state.segment(n, n)),
                 k = storey.stiffness + storey.stiffness_slopes.dot(equations.at.change);
    SpringVector p = storey.parameters;
    p[0] = k;
    for (std::size_t i = 0; i < storey.unknowns.size(); ++i)
      if (const Index unknown = storey.unknowns[i]; unknown >= 0)
        p[static_cast<Index>(i) + 1] =
            unknowns_[static_cast<std::size_t>(unknown)].to_physical(state[law_unknowns_at() + unknown]);
    SpringForce spring(p.size());
    storey.law->evaluate(d, v, slips ? state[slip_place] : 0.0, p, spring);
    all.forces[s] = k * d - spring.value;
    if (slips) all.slip_rates[t] = spring.slip_rate;
    if (slopes) {
      auto force = all.force_slopes.row(s);
      force.head(n) = (k - spring.by_drift) * storey.drift.transpose();
      if (slips) force[slip_place] = -spring.by_slip;
      const auto by_unknowns = [&](auto&& row, double by_stiffness, const SpringVector& by_parameter,
                                   double sign) {
        for (std::size_t j = 0; j < drives.size(); ++j)
          if (drives[j].kind == Drive::Kind::property)
            row[layout.unknowns + static_cast<Index>(j)] = by_stiffness *
                                                           storey.stiffness_slopes[drives[j].index] *
                                                           equations.at.slopes[static_cast<Index>(j)];
        for (std::size_t i = 0; i < storey.unknowns.size(); ++i)
          if (const Index unknown = storey.unknowns[i]; unknown >= 0) {
            const Index place = law_unknowns_at() + unknown;
            row[place] += sign * by_parameter[static_cast<Index>(i) + 1] *
                          unknowns_[static_cast<std::size_t>(unknown)].slope(state[place]);
          }
      };
      by_unknowns(force, d - spring.by_parameter[0], spring.by_parameter, -1.0);
      if (slips) {
        auto rate = all.slip_rate_slopes.row(t);
        rate.head(n) = spring.slip_by_drift * storey.drift.transpose();
        rate.segment(n, n) = spring.slip_by_rate * storey.drift.transpose();
        rate[slip_place] = spring.slip_by_slip;
        by_unknowns(rate, spring.slip_by_parameter[0], spring.slip_by_parameter, 1.0);
      }
    }
    if (slips) ++slip_place, ++t;
  }
  return all;
}

// Those measured, and those that the laws add.
VectorXd StoreyMotion::forces(const VectorXd& input, const Springs& springs) const {
  const Index m = input_size();
  VectorXd all(m + springs.forces.size());
  if (input.size() >= m)
    all.head(m) = input.head(m);
  else
    all.head(m).setZero();
  all.tail(springs.forces.size()) = springs.forces;
  return all;
}

void StoreyMotion::rate(const Equations& equations, const VectorXd& state, const VectorXd& input,
                        VectorXd& rate) const {
  const Index n = floor_count();
  const StateLayout& layout = floors_->layout();
  const Springs springs = springs_at(equations, state, false);
  const SecondOrderForm& form = equations.form;
  rate.setZero(size());
  rate.head(n) = state.segment(n, n);
  rate.segment(n, n).noalias() = form.inputs * forces(input, springs);
  rate.segment(n, n).noalias() -= form.stiffness * state.head(n);
  rate.segment(n, n).noalias() -= form.damping * state.segment(n, n);
  for (std::size_t i = 0; i < layout.drifts.size(); ++i)
    if (layout.drifts[i] >= 0) rate[layout.biases[i]] = state[layout.drifts[i]];
  rate.segment(slips_at(), slips_) = springs.slip_rates;
}

void StoreyMotion::rate_jacobian(const Equations& equations, const VectorXd& state, const VectorXd& input,
                                 MatrixXd& jacobian) const {
  const Index n = floor_count();
  const StateLayout& layout = floors_->layout();
  const Springs springs = springs_at(equations, state, true);
  const SecondOrderForm& form = equations.form;
  const VectorXd pushed = forces(input, springs);
  jacobian.setZero(size(), size());
  jacobian.block(0, n, n, n).setIdentity();
  auto rows = jacobian.middleRows(n, n);
  rows.noalias() = form.inputs.rightCols(springs.forces.size()) * springs.force_slopes;
  rows.leftCols(n) -= form.stiffness;
  rows.middleCols(n, n) -= form.damping;
  for (std::size_t j = 0; j < equations.slopes.size(); ++j) {
    const SecondOrderForm& slope = equations.slopes[j];
    auto column = rows.col(layout.unknowns + static_cast<Index>(j));
    column.noalias() += slope.inputs * pushed;
    column.noalias() -= slope.stiffness * state.head(n);
    column.noalias() -= slope.damping * state.segment(n, n);
  }
  for (std::size_t i = 0; i < layout.drifts.size(); ++i)
    if (layout.drifts[i] >= 0) jacobian(layout.biases[i], layout.drifts[i]) = 1.0;
  jacobian.middleRows(slips_at(), slips_) = springs.slip_rate_slopes;
}

void StoreyMotion::rate(const VectorXd& state, const VectorXd& input, VectorXd& rate) const {
  Equations equations;
  evaluate(state, false, equations);
  this->rate(equations, state, input, rate);
}

void StoreyMotion::rate_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) const {
  Equations equations;
  evaluate(state, true, equations);
  rate_jacobian(equations, state, input, jacobian);
}

void StoreyMotion::output(const VectorXd& state, const VectorXd& input, VectorXd& output) const {
  Equations equations;
  evaluate(state, false, equations);
  floors_->read(state, forces(input, springs_at(equations, state, false)), equations.form, output);
}

void StoreyMotion::output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) const {
  Equations equations;
  evaluate(state, true, equations);
  const Springs springs = springs_at(equations, state, true);
  MatrixXd linear;
  floors_->read_jacobian(state, forces(input, springs), equations.form, equations.slopes, linear);
  jacobian.setZero(linear.rows(), size());
  jacobian.leftCols(linear.cols()) = linear;
  const MatrixXd pushed = equations.form.inputs.rightCols(springs.forces.size()) * springs.force_slopes;
  const auto& observations = floors_->description().observations;
  for (Index i = 0; i < jacobian.rows(); ++i)
    if (reads(observations[static_cast<std::size_t>(i)].quantity) == Reads::accelerations)
      jacobian.row(i).noalias() += floors_->rows().row(i) * pushed;
}

std::unique_ptr<filters::DiscreteModel> StoreyMotion::structured(double dt, const std::string& scheme,
                                                                 const filters::Noise& noise) const {
  return storey_step(std::make_shared<StoreyMotion>(*this), dt, scheme, noise);
}

}  // namespace beamid::experiments
