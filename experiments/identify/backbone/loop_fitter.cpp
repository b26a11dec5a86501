#include "experiments/identify/backbone/loop_fitter.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Coefficients of a curve that runs as a function does, by least squares on a grid.
VectorXd coefficients_like(const SecantCurve& curve, const std::function<double(double)>& value) {
  constexpr Index points = 80;
  MatrixXd rows(points, curve.terms());
  VectorXd values(points);
  for (Index i = 0; i < points; ++i) {
    const double x = curve.range() * std::pow(static_cast<double>(i) / (points - 1), 2);
    rows.row(i) = curve.shape(x).transpose();
    values[i] = value(x);
  }
  return rows.colPivHouseholderQr().solve(values);
}

VectorXd loop_state(const LoopMotion& motion, const LoopMotionSetting& setting, const LoopStart& start) {
  VectorXd state = VectorXd::Zero(motion.states());
  state.head<2>() = start.motion;
  state.segment(LoopMotion::spring, setting.spring.terms()) = coefficients_like(setting.spring, start.secant);
  state.segment(motion.damping(), setting.damping.terms()) =
      coefficients_like(setting.damping, start.damping);
  state[motion.masing()] = start.masing;
  state[motion.offset()] = start.offset;
  return state;
}

}  // namespace

LoopStart start_after(const RecordFit& fit) {
  return {[fit](double x) { return fit.spring.secant(x); },
          [fit](double x) { return fit.damping_curve.shape(x).dot(fit.damping); }, fit.masing, fit.motion,
          fit.offset};
}

LoopMotionSetting LoopFitter::setting(const std::string& name, Index terms, Index damping_terms,
                                      double range) const {
  return {SecantCurve(range, terms),
          SecantCurve(range, damping_terms),
          mass_,
          omega_,
          samples_.quantity,
          samples_.interval(),
          samples_.steps,
          noise_,
          name == "masing" || name == "between"};
}

MatrixXd LoopFitter::directions(const LoopMotion& motion, const LoopMotionSetting& setting, double stiffness,
                                bool masing_sought) const {
  const double range = setting.spring.range();
  const double size = range * (samples_.quantity == Quantity::acceleration ? omega_ * omega_
                               : samples_.quantity == Quantity::velocity   ? omega_
                                                                           : 1);
  const Index q = setting.spring.terms(), d = setting.damping.terms();
  MatrixXd result = MatrixXd::Zero(motion.states(), 3 + q + d + masing_sought);
  Index at = 0;
  const auto seek = [&](Index place, double scale) { result(place, at++) = scale; };
  seek(LoopMotion::displacement, range), seek(LoopMotion::velocity, range * omega_);
  for (Index j = 0; j < q; ++j) seek(LoopMotion::spring + j, stiffness);
  for (Index j = 0; j < d; ++j) seek(motion.damping() + j, 0.02 * std::sqrt(stiffness * mass_));
  if (masing_sought) seek(motion.masing(), 0.1);
  seek(motion.offset(), size);
  return result;
}

RecordFit LoopFitter::fit(const std::string& name, Index terms, Index damping_terms, double range,
                          const LoopStart& start, bool grow) const {
  const LoopMotionSetting law = setting(name, terms, damping_terms, range);
  LoopMotion motion(law);
  const MatrixXd sought = directions(motion, law, std::abs(start.secant(0.3 * range)), name == "between");
  const filters::BatchEstimate found =
      filters::estimate_batch(motion, loop_state(motion, law, start), sought, samples_.plain,
                              samples_.batch_settings(1, grow, grow && name == "masing" ? 12 : 25));
  RecordFit fit = record_fit(name, found, samples_, 1);
  fit.unknowns = sought.cols();
  if (fit.residuals.size() == 0 || found.covariance.size() == 0) {
    fit.converged = false;
    return fit;
  }
  const MatrixXd covariance = sought * found.covariance * sought.transpose();
  fit.spring = {law.spring, found.state.segment(LoopMotion::spring, terms),
                covariance.block(LoopMotion::spring, LoopMotion::spring, terms, terms)};
  fit.damping_curve = law.damping;
  fit.damping = found.state.segment(motion.damping(), damping_terms);
  fit.masing = found.state[motion.masing()];
  fit.masing_deviation = std::sqrt(std::max(0.0, covariance(motion.masing(), motion.masing())));
  fit.motion = found.state.head<2>();
  fit.offset = found.state[motion.offset()];
  fit.largest = largest_argument(motion, found.state, name == "masing");
  return fit;
}

double LoopFitter::largest_argument(LoopMotion& motion, const VectorXd& start, bool half_swings) const {
  VectorXd state = start, next;
  double most = 0;
  for (Index k = 1; k < samples_.size(); ++k) {
    if (!half_swings) most = std::max(most, std::abs(state[LoopMotion::displacement]));
    motion.transition(state, {}, next);
    state.swap(next);
    if (half_swings)
      most = std::max(most, 0.5 * std::abs(state[LoopMotion::displacement] - state[LoopMotion::reversal]));
  }
  return most;
}

void LoopFitter::refine(const std::string& name, const std::vector<std::pair<Index, Index>>& terms,
                        double range, const LoopStart& start, std::vector<RecordFit>& to) const {
  constexpr Index least_terms = 6;
  constexpr double room = 1.02;
  RecordFit last;
  for (const auto& [q, d] : terms) {
    const bool first = last.residuals.size() == 0 || !last.converged;
    double reach = first ? range : room * last.largest;
    RecordFit found = fit(name, q, d, reach, first ? start : start_after(last), first);
    for (int round = 0; round < 4 && found.converged;
         ++round) {  // until the curve ends where the motion does
      if (found.largest <= reach && found.largest > reach / (room * room)) break;
      reach = room * found.largest;
      found = fit(name, q, d, reach, start_after(found), false);
    }
    if (!found.converged) {
      if (to.empty() || to.back().name != name || !to.back().converged) to.push_back(found);
      if (first) return;
      continue;
    }
    last = found;
    if (q >= least_terms) to.push_back(std::move(found));
  }
}

}  // namespace beamid::experiments
