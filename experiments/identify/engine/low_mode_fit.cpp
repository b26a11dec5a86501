#include "experiments/identify/engine/low_mode_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "experiments/identify/verdict/reproduction.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/levenberg_marquardt.hpp"
#include "filters/output_error.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index fewest_fit_samples = 64;  // samples that are worth a fit
constexpr double first_periods = 3.0;     // of the fastest mode fitted, that are taken up first
constexpr double close_enough = 0.02;     // length of the next step, in deviations of what is sought

/// J near some c: 1/2 |R d - q|^2 + 1/2 remainder^2 + 1/2 |c + d|^2.
struct LowModeLinearisation {
  double cost = std::numeric_limits<double>::infinity();  // infinite where there is no motion
  VectorXd state;                                         // the best start (n)
  MatrixXd root;                                          // R (q x q)
  VectorXd slope;                                         // q
};

class LowModeFit {
 public:
  LowModeFit(const JointModel& model, const std::vector<Observation>& observations, double highest_hz,
             const FirstGuess& guess, double noise)
      : model_(model),
        observations_(observations),
        highest_hz_(highest_hz),
        guess_(guess),
        noise_(noise),
        unknowns_(root_of(guess.unknowns)) {}

  Index unknowns() const { return unknowns_.cols(); }
  const MatrixXd& root() const { return unknowns_; }  // U of the guess's covariance U U^T (q x q)

  // The modes that the record holds, at a state's unknowns; there is always the first.
  JointModel low_modes(const VectorXd& state) const {
    JointModel model = with_modes_at(model_, state);
    Index count = 1;
    while (count < model.mode_frequencies.size() &&
           model.mode_frequencies[count] < 2.0 * std::numbers::pi * highest_hz_)
      ++count;
    model.mode_shapes = model.mode_shapes.leftCols(count).eval();
    model.mode_frequencies = model.mode_frequencies.head(count).eval();
    return model;
  }

  LowModeLinearisation at(const VectorXd& c, const filters::Measurements& decimated) const {
    LowModeLinearisation result;
    const Index samples = decimated.size(), q = unknowns();
    VectorXd state = guess_.mean;
    state(model_.unknown_places) += unknowns_ * c;
    try {
      const JointModel low = low_modes(state);
      const StartDirections start =
          start_directions(low, observations_,
                           start_scale(low, observations_, decimated.outputs, decimated.time[samples - 1]));
      const VectorXd size = decimated.outputs.rowwise().norm() / std::sqrt(static_cast<double>(samples));
      const MatrixXd noise = (noise_ * size).cwiseMax(1e-300).cwiseAbs2().asDiagonal();
      const double interval = decimated.time[samples - 1] / static_cast<double>(samples - 1);
      const auto discrete =
          filters::discretise(low.motion, interval, finest_discretisation(low), {{}, noise});
      const VectorXd best = reproduce(*discrete, state, start, decimated).initial_state;

      MatrixXd directions(best.size(), start.motion.cols() + q);
      directions.leftCols(start.motion.cols()) = start.motion;
      MatrixXd follow = motion_slopes(low, best);
      for (Index j = 0; j < q; ++j) follow(model_.unknown_places[static_cast<std::size_t>(j)], j) = 1.0;
      directions.rightCols(q) = follow * unknowns_;
      const MatrixXd no_prior;
      const filters::OutputErrorPass pass =
          filters::OutputError(*discrete, best, directions, decimated, no_prior)
              .pass(VectorXd::Zero(directions.cols()), samples);
      if (!pass.finite) return result;
      std::vector<Index> projected(static_cast<std::size_t>(start.motion.cols()));
      for (std::size_t i = 0; i < projected.size(); ++i) projected[i] = static_cast<Index>(i);
      const MatrixXd root = pass.information.without(projected).root();
      result.state = best;
      result.root = root.topLeftCorner(q, q);
      result.slope = root.col(q).head(q);
      result.cost = pass.cost + 0.5 * c.squaredNorm();
    } catch (const std::runtime_error&) {  // no such motion: the cost stays infinite
    }
    return result;
  }

 private:
  const JointModel& model_;
  const std::vector<Observation>& observations_;
  double highest_hz_;
  const FirstGuess& guess_;
  double noise_;
  MatrixXd unknowns_;  // U (q x q)
};

// Rows of the least squares problem in d: the record, what is known before, and the damping.
VectorXd step(const LowModeLinearisation& now, const VectorXd& c, double damping) {
  const Index q = c.size();
  MatrixXd rows(3 * q, q);
  rows << now.root, MatrixXd::Identity(q, q), std::sqrt(damping) * MatrixXd::Identity(q, q);
  VectorXd right(3 * q);
  right << now.slope, -c, VectorXd::Zero(q);
  return rows.colPivHouseholderQr().solve(right);
}

// From c, which it moves; what holds there.
LowModeLinearisation descend(const LowModeFit& fit, const filters::Measurements& decimated, VectorXd& c) {
  LowModeLinearisation now = fit.at(c, decimated);
  if (!std::isfinite(now.cost)) return now;
  filters::MarquardtDamping rule;
  rule.negligible = 0.1, rule.most_steps = 12;
  const auto next_step = [&](double damping) {
    const double size = now.root.squaredNorm();
    rule.least_raised = 1e-2 * size, rule.most = 1e6 * std::max(1.0, size);
    return step(now, c, damping);
  };
  const auto take = [&](const VectorXd& d) {
    LowModeLinearisation next = fit.at(c + d, decimated);
    if (!(next.cost < now.cost)) return filters::TriedStep{};
    const double length = std::hypot((now.root * d).norm(), d.norm());
    c += d;
    now = std::move(next);
    return filters::TriedStep{1.0, length < close_enough};
  };
  filters::levenberg_marquardt(rule, next_step, take);
  return now;
}

bool is_stiffness(const Unknown& unknown) {
  return unknown.quantity.ends_with("stiffness") || unknown.quantity == "factor";
}

}  // namespace

VectorXd scaled_stiffness(const JointModel& model, const FirstGuess& guess, double s) {
  const auto q = static_cast<Index>(model.unknown_places.size());
  VectorXd change = VectorXd::Zero(q);
  for (Index j = 0; j < q; ++j) {
    const Unknown& unknown = model.unknowns[static_cast<std::size_t>(j)];
    const double state = guess.mean[model.unknown_places[static_cast<std::size_t>(j)]];
    if (!is_stiffness(unknown)) continue;
    try {
      change[j] = unknown.to_state(s * unknown.to_physical(state)) - state;
    } catch (const std::invalid_argument&) {
      return {};
    }
  }
  return change;
}

namespace {

// Many stiffnesses that are wrong together are beyond the reach of a descent in all of them: a mode of
// another frequency has another phase after a few periods. All that are wrong by one factor are found first.
VectorXd best_common_stiffness(const LowModeFit& fit, const JointModel& model, const FirstGuess& guess,
                               const filters::Measurements& part) {
  constexpr double widest = 3.0;
  constexpr int steps = 12;  // to either side
  VectorXd best = VectorXd::Zero(fit.unknowns());
  if (std::count_if(model.unknowns.begin(), model.unknowns.end(), is_stiffness) < 2) return best;
  const auto root = fit.root().completeOrthogonalDecomposition();
  double least = fit.at(best, part).cost;
  for (int i = -steps; i <= steps; ++i) {
    const VectorXd change = scaled_stiffness(model, guess, std::pow(widest, static_cast<double>(i) / steps));
    if (i == 0 || change.size() == 0) continue;
    const VectorXd c = root.solve(change);
    if (const double cost = fit.at(c, part).cost; cost < least) least = cost, best = c;
  }
  return best;
}

}  // namespace

MatrixXd root_of(const MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> found(0.5 * (covariance + covariance.transpose()));
  return found.eigenvectors() * found.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

filters::Measurements beginning(const filters::Measurements& record, Index samples) {
  filters::Measurements part;
  part.time = record.time.head(samples).array() - record.time[0];
  part.outputs = record.outputs.leftCols(samples);
  if (record.inputs.size() > 0) part.inputs = record.inputs.leftCols(samples);
  return part;
}

LowModeGuess fit_low_modes(const JointModel& model, const std::vector<Observation>& observations,
                           const LowRecord& record, const FirstGuess& guess, double noise) {
  const LowModeFit fit(model, observations, record.highest_hz, guess, noise);
  const Index samples = record.measurements.size(), q = fit.unknowns();
  const double period = 2.0 * std::numbers::pi / fit.low_modes(guess.mean).mode_frequencies.maxCoeff();
  const double interval = record.measurements.time[samples - 1] / static_cast<double>(samples - 1);
  LowModeLinearisation found;
  Index part = std::max(fewest_fit_samples, static_cast<Index>(std::ceil(first_periods * period / interval)));
  VectorXd c =
      best_common_stiffness(fit, model, guess, beginning(record.measurements, std::min(4 * part, samples)));
  for (bool whole = false; !whole; part *= 2) {
    whole = part >= samples;
    found = descend(fit, beginning(record.measurements, std::min(part, samples)), c);
  }
  if (!std::isfinite(found.cost)) return {guess, found.cost};
  const MatrixXd& u = fit.root();
  const MatrixXd information = found.root.transpose() * found.root + MatrixXd::Identity(q, q);
  const double readings = static_cast<double>(record.measurements.outputs.size());
  return {{next_start(model, {guess.mean, {}}, {found.state, {}}).mean,
           u * information.ldlt().solve(u.transpose())},
          2.0 * found.cost / readings};
}

}  // namespace beamid::experiments
