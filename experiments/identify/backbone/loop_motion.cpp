#include "experiments/identify/backbone/loop_motion.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// F(x) = x s(|x|), dF/dx, and dF/dtheta, times a factor, added to rows of a gradient.
struct CurveForce {
  double force = 0, slope = 0;
};

CurveForce curve_force(const SecantCurve& curve, double x, const VectorXd& z, Index place, double factor,
                       VectorXd* gradient) {
  const SecantCurve::Local local = curve.local(x);
  double secant = 0, slope = 0;
  for (Index m = 0; m < local.count; ++m) {
    const auto at = static_cast<std::size_t>(m);
    const Index row = place + local.first + m;
    secant += local.value[at] * z[row];
    slope += local.slope[at] * z[row];
    if (gradient) (*gradient)[row] += factor * x * local.value[at];
  }
  return {x * secant, secant + std::abs(x) * slope};
}

/// Part of a step after which the velocity is zero: root of the cubic through velocities and accelerations.
double reversal_part(double v0, double v1, double a0, double a1, double h) {
  const auto velocity = [&](double s) {
    return v0 * (1 + 2 * s) * (1 - s) * (1 - s) + h * a0 * s * (1 - s) * (1 - s) + v1 * s * s * (3 - 2 * s) +
           h * a1 * s * s * (s - 1);
  };
  double low = 0, high = 1;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (velocity(middle) * v0 > 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

LoopMotion::LoopMotion(const LoopMotionSetting& setting)
    : set_(setting), noise_(MatrixXd::Constant(1, 1, setting.noise * setting.noise)) {}

std::vector<filters::Label> LoopMotion::state_labels() const {
  std::vector<filters::Label> labels{
      {"displacement", "m"}, {"velocity", "m/s"}, {"reversal", "m"}, {"reversal_force", "N"}, {"begun", "1"}};
  for (Index j = 0; j < set_.spring.terms(); ++j)
    labels.push_back({"secant_" + std::to_string(j + 1), "N/m"});
  for (Index j = 0; j < set_.damping.terms(); ++j)
    labels.push_back({"damping_" + std::to_string(j + 1), "N s/m"});
  labels.push_back({"masing", "1"});
  labels.push_back({"offset", si_unit(set_.observed)});
  return labels;
}

std::vector<filters::Label> LoopMotion::output_labels() const {
  return {{to_string(set_.observed), si_unit(set_.observed)}};
}

double LoopMotion::loop_force(const VectorXd& z, VectorXd* gradient) const {
  const double mu = z[masing()];
  const CurveForce branch =
      curve_force(set_.spring, 0.5 * (z[displacement] - z[reversal]), z, spring, 2 * mu, gradient);
  if (gradient) {
    (*gradient)[displacement] += mu * branch.slope;
    (*gradient)[reversal] -= mu * branch.slope;
    (*gradient)[reversal_force] += 1;
    (*gradient)[masing()] += 2 * branch.force;
  }
  return z[reversal_force] + 2 * mu * branch.force;
}

double LoopMotion::acceleration(const VectorXd& z, VectorXd* gradient) const {
  const double x = z[displacement], v = z[velocity], mu = z[masing()];
  if (gradient) gradient->setZero(states());
  const CurveForce elastic = curve_force(set_.spring, x, z, spring, 1 - mu, gradient);
  const double loop = set_.hysteretic ? loop_force(z, gradient) : 0;
  const SecantCurve::Local local = set_.damping.local(x);
  double c = 0, c_slope = 0;
  for (Index m = 0; m < local.count; ++m) {
    const auto at = static_cast<std::size_t>(m);
    const Index row = damping() + local.first + m;
    c += local.value[at] * z[row];
    c_slope += local.slope[at] * z[row];
    if (gradient) (*gradient)[row] = v * local.value[at];
  }
  if (gradient) {
    (*gradient)[displacement] += (1 - mu) * elastic.slope + std::copysign(1.0, x) * v * c_slope;
    (*gradient)[velocity] = c;
    (*gradient)[masing()] -= elastic.force;
    *gradient /= -set_.mass;
  }
  return -((1 - mu) * elastic.force + loop + c * v) / set_.mass;
}

void LoopMotion::begin(VectorXd& z, MatrixXd* directions) const {
  if (!set_.hysteretic || z[begun] != 0) return;
  const double x = z[displacement], rest = z[velocity] / set_.omega;
  const double sign = z[velocity] < 0 || (z[velocity] == 0 && x > 0) ? 1 : -1;
  const double amplitude = std::hypot(x, rest);
  z[begun] = 1;
  z[reversal] = sign * amplitude;
  VectorXd gradient = VectorXd::Zero(states());
  const double mu = z[masing()];
  const CurveForce force =
      curve_force(set_.spring, z[reversal], z, spring, mu, directions ? &gradient : nullptr);
  z[reversal_force] += mu * force.force;
  if (!directions || !(amplitude > 0)) return;
  gradient[reversal_force] = 1;
  gradient[masing()] = force.force;
  directions->row(reversal) =
      sign / amplitude * (x * directions->row(displacement) + rest / set_.omega * directions->row(velocity));
  directions->row(reversal_force) =
      gradient.transpose() * *directions + mu * force.slope * directions->row(reversal);
}

void LoopMotion::runge_kutta(double h, VectorXd& z, MatrixXd* directions) {
  const double x = z[displacement], v = z[velocity];
  double dx = 0, dv = 0;
  Eigen::RowVectorXd row_x, row_v, d_x, d_v, rate_x, rate_v;
  if (directions) {
    row_x = directions->row(displacement), row_v = directions->row(velocity);
    d_x.setZero(row_x.size()), d_v.setZero(row_v.size());
  }
  double last_x = 0, last_v = 0;
  for (int stage = 0; stage < 4; ++stage) {
    const double part = stage == 0 ? 0 : stage == 3 ? 1 : 0.5, weight = stage == 0 || stage == 3 ? 1 : 2;
    if (stage > 0) {
      z[displacement] = x + part * h * last_x, z[velocity] = v + part * h * last_v;
      if (directions) {
        directions->row(displacement) = row_x + part * h * rate_x;
        directions->row(velocity) = row_v + part * h * rate_v;
      }
    }
    last_x = z[velocity];
    last_v = acceleration(z, directions ? &gradient_ : nullptr);
    dx += weight * last_x, dv += weight * last_v;
    if (directions) {
      rate_x = directions->row(velocity);
      rate_v.noalias() = gradient_.transpose() * *directions;
      d_x += weight * rate_x, d_v += weight * rate_v;
    }
  }
  z[displacement] = x + h / 6 * dx, z[velocity] = v + h / 6 * dv;
  if (directions) {
    directions->row(displacement) = row_x + h / 6 * d_x;
    directions->row(velocity) = row_v + h / 6 * d_v;
  }
}

void LoopMotion::step(double h, VectorXd& z, MatrixXd* directions) {
  before_ = z;
  if (directions) directions_before_ = *directions;
  runge_kutta(h, z, directions);
  if (!set_.hysteretic || !(before_[velocity] * z[velocity] < 0)) return;
  const double part = reversal_part(before_[velocity], z[velocity], acceleration(before_, nullptr),
                                    acceleration(z, nullptr), h);
  z = before_;
  if (directions) *directions = directions_before_;
  runge_kutta(part * h, z, directions);
  VectorXd gradient = VectorXd::Zero(states());
  const double force = loop_force(z, directions ? &gradient : nullptr);
  if (directions) {
    const Eigen::RowVectorXd row = gradient.transpose() * *directions;
    directions->row(reversal) = directions->row(displacement);
    directions->row(reversal_force) = row;
  }
  z[reversal] = z[displacement], z[reversal_force] = force;
  runge_kutta((1 - part) * h, z, directions);
}

void LoopMotion::advance(const VectorXd& state, VectorXd& next, MatrixXd* directions) {
  next = state;
  begin(next, directions);
  for (int i = 0; i < set_.steps; ++i) step(set_.interval / set_.steps, next, directions);
}

void LoopMotion::transition(const VectorXd& state, const VectorXd&, VectorXd& next) {
  advance(state, next, nullptr);
}

void LoopMotion::linearised_transition(const VectorXd& state, const VectorXd&, VectorXd& next,
                                       MatrixXd& jacobian) {
  jacobian.setIdentity(states(), states());
  advance(state, next, &jacobian);
}

void LoopMotion::move(const VectorXd& state, const VectorXd&, VectorXd& next, MatrixXd& directions) {
  advance(state, next, &directions);
}

void LoopMotion::output(const VectorXd& state, const VectorXd&, VectorXd& output) {
  output.resize(1);
  output[0] = state[offset()];
  if (set_.observed == Quantity::displacement) output[0] += state[displacement];
  if (set_.observed == Quantity::velocity) output[0] += state[velocity];
  if (set_.observed != Quantity::acceleration) return;
  VectorXd z = state;
  begin(z, nullptr);
  output[0] += acceleration(z, nullptr);
}

void LoopMotion::output_jacobian(const VectorXd& state, const VectorXd&, MatrixXd& jacobian) {
  jacobian.setZero(1, states());
  if (set_.observed == Quantity::displacement) jacobian(0, displacement) = 1;
  if (set_.observed == Quantity::velocity) jacobian(0, velocity) = 1;
  if (set_.observed == Quantity::acceleration) {
    VectorXd z = state, gradient;
    MatrixXd all = MatrixXd::Identity(states(), states());
    if (z[begun] == 0) begin(z, &all);
    acceleration(z, &gradient);
    jacobian.row(0) = gradient.transpose() * all;
  }
  jacobian(0, offset()) = 1;
}

}  // namespace beamid::experiments
