// Rao-Blackwellised particle filter with iterated batch importance sampling [chopin2002]: constants that make
// a model nonlinear are particles, the motion given them is Gaussian and exact.
//
//     p(x, theta | y_0..k) = sum_i W_i delta(theta - theta_i) N(x; m_i, P_i),   W_i ~ prod_j p(y_j |
//     y_0..j-1, theta_i)
//
// Constants do not move by themselves, and weights concentrate on few particles. When fewer than a share of
// them are effective, they are drawn again and moved by Metropolis and Hastings over the whole record so far,
// which leaves the posterior as it is: in contrast to a kernel, nothing is widened. Where the last readings
// say more than that share allows, they are let in by powers of their likelihood.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>

#include "filters/filter.hpp"
#include "filters/gaussian.hpp"
#include "filters/innovation.hpp"
#include "filters/observed_model.hpp"
#include "filters/particle_cloud.hpp"
#include "filters/random.hpp"
#include "filters/whole_number.hpp"

namespace beamid::filters {
namespace {

// The Gaussian motion of a linear model whose constants are given, exact.

/// One step of the record so far, as it was met.
struct RecordStep {
  bool reading = false;
  Eigen::VectorXd output, input;
  std::vector<Eigen::Index> observed;
  Eigen::MatrixXd noise;  ///< R of a reading, Q of a step
  double interval = 0.0;
};

/// Constants theta with the motion that they imply.
struct ConstantParticle {
  Eigen::VectorXd theta, mean;  ///< (q), (l)
  Eigen::MatrixXd covariance;   ///< (l x l)
  // Motion and readings given theta, as long as interval and outputs stay: x+ = A x + c, y = H x + d.
  double interval = -1.0;
  Eigen::MatrixXd a, h;
  Eigen::VectorXd c, d;
  std::vector<Eigen::Index> seen;
  double settled = 0.0;  ///< ln likelihood of the readings before the last move
  double fresh = 0.0;    ///< and since
};

/// Kalman filter of p(x | theta, y_0..k): theta are the constants that the motion of the other entries
/// depends on, x those others.
class ConditionalMotion {
 public:
  explicit ConditionalMotion(ObservedModel& model) : model_(model) {}

  /// Sorts the entries of the state into theta and x.
  /// @throws std::invalid_argument where the motion given theta is not linear.
  void reset(const Gaussian& start);

  const Gaussian& start() const { return start_; }
  const std::vector<Eigen::Index>& held() const { return held_; }  ///< places of theta (q)
  const std::vector<Eigen::Index>& free() const { return free_; }  ///< of x (l)

  /// x at the start, given theta.
  void begin(ConstantParticle& one) const;
  void move(ConstantParticle& one, const RecordStep& step);
  /// @returns ln p(y | theta, what was read before)
  /// @param expected y at the prediction (p)
  /// @param s covariance of what is new in y (p x p)
  double correct(ConstantParticle& one, const RecordStep& step, Eigen::VectorXd& expected,
                 Eigen::MatrixXd& s);
  /// The record once more, from its start; readings before `settled_steps` count as settled.
  void replay(ConstantParticle& one, const std::vector<RecordStep>& record, std::size_t settled_steps);

  /// theta and x in their places (n).
  Eigen::VectorXd state(const ConstantParticle& one) const;

 private:
  ObservedModel& model_;
  Gaussian start_;
  std::vector<Eigen::Index> held_, free_;
  Eigen::VectorXd next_;
  Eigen::MatrixXd tangent_, work_;
};

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

bool differ(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() > 1e-9 * (a.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
}

// Constants are entries that stay as they are, without noise. Those that the motion of the others depends
// on are held by particles.
void ConditionalMotion::reset(const Gaussian& start) {
  start_ = start;
  const Index n = start.mean.size();
  const VectorXd none, deviation = start.deviations();
  VectorXd next;
  MatrixXd moved, shown, other;
  model_.linearised_transition(start.mean, none, next, moved);
  model_.output_jacobian(start.mean, none, shown);
  const MatrixXd& q = model_.process_noise();
  std::vector<Index> constants, moving;
  for (Index i = 0; i < n; ++i) {
    VectorXd row = moved.row(i);
    row[i] -= 1.0;
    const bool stays = row.cwiseAbs().maxCoeff() < 1e-12 && (q.size() == 0 || q(i, i) == 0.0);
    (stays ? constants : moving).push_back(i);
  }
  held_.clear();
  free_ = moving;
  for (const Index i : constants) {
    VectorXd there = start.mean;
    there[i] += deviation[i] > 0.0 ? deviation[i] : 1e-3 * std::max(1.0, std::abs(there[i]));
    model_.linearised_transition(there, none, next, other);
    bool changes = differ(moved(moving, moving), other(moving, moving));
    model_.output_jacobian(there, none, other);
    changes = changes || differ(shown(Eigen::all, moving), other(Eigen::all, moving));
    (changes ? held_ : free_).push_back(i);
  }
  std::sort(free_.begin(), free_.end());
  VectorXd there = start.mean;
  there(free_) += deviation(free_);
  model_.linearised_transition(there, none, next, other);
  bool linear = !differ(moved(free_, free_), other(free_, free_));
  model_.output_jacobian(there, none, other);
  linear = linear && !differ(shown(Eigen::all, free_), other(Eigen::all, free_));
  if (!linear)
    throw std::invalid_argument(
        "rao_blackwellised: the motion is not linear where its constants are held; expected a linear one "
        "(particle, ukf or ekf take the others)");
}

void ConditionalMotion::begin(ConstantParticle& one) const {
  one.mean = start_.mean(free_);
  one.covariance = start_.covariance(free_, free_);
  one.settled = one.fresh = 0.0;
  one.interval = -1.0;
  one.h.resize(0, 0);
  if (held_.empty()) return;
  const MatrixXd across = start_.covariance(free_, held_);
  if (across.isZero(0.0)) return;
  const Eigen::LDLT<MatrixXd> known(start_.covariance(held_, held_));
  one.mean += across * known.solve(one.theta - start_.mean(held_));
  one.covariance -= across * known.solve(across.transpose());
}

VectorXd ConditionalMotion::state(const ConstantParticle& one) const {
  VectorXd result(start_.mean.size());
  result(free_) = one.mean;
  result(held_) = one.theta;
  return result;
}

void ConditionalMotion::move(ConstantParticle& one, const RecordStep& step) {
  if (one.interval != step.interval) {
    const VectorXd none = VectorXd::Zero(step.input.size());
    model_.linearised_transition(state(one), none, next_, tangent_);
    one.interval = step.interval;
    one.a = tangent_(free_, free_);
    one.c = next_(free_) - one.a * one.mean;
  }
  if (step.input.size() > 0) {
    model_.transition(state(one), step.input, next_);
    one.mean = next_(free_);
  } else {
    one.mean = (one.a * one.mean + one.c).eval();
  }
  work_.noalias() = one.a * one.covariance;
  one.covariance.noalias() = work_ * one.a.transpose();
  if (step.noise.size() > 0) one.covariance += step.noise(free_, free_);
  symmetrise(one.covariance);
}

double ConditionalMotion::correct(ConstantParticle& one, const RecordStep& step, VectorXd& expected,
                                  MatrixXd& s) {
  if (one.h.size() == 0 || one.seen != step.observed) {
    const VectorXd none = VectorXd::Zero(step.input.size()), at = state(one);
    model_.output(at, none, expected);
    model_.output_jacobian(at, none, tangent_);
    one.seen = step.observed;
    one.h = tangent_(Eigen::all, free_);
    one.d = expected - one.h * one.mean;
  }
  const MatrixXd& h = one.h;
  if (step.input.size() > 0)
    model_.output(state(one), step.input, expected);
  else
    expected = h * one.mean + one.d;
  const MatrixXd across = one.covariance * h.transpose();
  s = h * across + step.noise;
  const Eigen::LLT<MatrixXd> factor(s);
  if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
  const VectorXd rest = step.output - expected;
  const MatrixXd gain = factor.solve(across.transpose()).transpose();
  one.mean += gain * rest;
  MatrixXd kept = -gain * h;
  kept.diagonal().array() += 1.0;
  one.covariance = (kept * one.covariance * kept.transpose() + gain * step.noise * gain.transpose()).eval();
  return -0.5 * (rest.dot(factor.solve(rest)) +
                 std::log(2.0 * std::numbers::pi) * static_cast<double>(rest.size())) -
         factor.matrixLLT().diagonal().array().log().sum();
}

void ConditionalMotion::replay(ConstantParticle& one, const std::vector<RecordStep>& record,
                               std::size_t settled_steps) {
  const double interval = model_.interval();
  const std::vector<Index> observed = model_.observed();
  begin(one);
  VectorXd expected;
  MatrixXd s;
  for (std::size_t k = 0; k < record.size(); ++k) {
    const RecordStep& step = record[k];
    if (step.interval != model_.interval()) model_.set_interval(step.interval);
    if (step.reading) {
      if (step.observed != model_.observed()) model_.observe(step.observed);
      (k < settled_steps ? one.settled : one.fresh) += correct(one, step, expected, s);
    } else {
      move(one, step);
    }
  }
  if (interval != model_.interval()) model_.set_interval(interval);
  if (observed != model_.observed()) model_.observe(observed);
}

class RaoBlackwellised final : public Filter {
 public:
  RaoBlackwellised(std::unique_ptr<DiscreteModel> model, const Options& options)
      : Filter(std::move(model)),
        wanted_(whole_number(options.number("particles"), 10, "rao_blackwellised", "particles")),
        moves_(whole_number(options.number("moves"), 1, "rao_blackwellised", "moves")),
        seed_(whole_number(options.number("seed"), 0, "rao_blackwellised", "seed")),
        share_(options.number("resample_below")),
        random_(static_cast<std::uint64_t>(seed_)),
        motion_(model_) {
    if (!(share_ > 0.0 && share_ < 1.0))
      throw std::invalid_argument("rao_blackwellised: resample_below is " + std::to_string(share_) +
                                  "; expected a number between 0 and 1");
  }

  void reset(const Gaussian& estimate) override {
    check_estimate(estimate, model_);
    Gaussian whole = estimate;
    if (whole.covariance.size() == 0) whole.covariance = estimate.factor * estimate.factor.transpose();
    random_ = RandomStream(static_cast<std::uint64_t>(seed_));
    motion_.reset(whole);
    record_.clear();
    settled_steps_ = 0;
    particles_.assign(static_cast<std::size_t>(motion_.held().empty() ? 1 : wanted_), {});
    if (!motion_.held().empty())
      root_ = square_root(whole.covariance(motion_.held(), motion_.held()), factor_);
    const auto q = static_cast<Index>(motion_.held().size());
    const auto count = static_cast<Index>(particles_.size());
    const MatrixXd draws = exact_draws(random_, q, count, MatrixXd(0, count)).values;
    for (Index i = 0; i < count; ++i) {
      ConstantParticle& one = particles_[static_cast<std::size_t>(i)];
      one.theta = whole.mean(motion_.held());
      if (q > 0) one.theta += root_ * draws.col(i);
      motion_.begin(one);
    }
    formed_ = false;
  }

  void predict(const VectorXd& input) override {
    record_.push_back({false, {}, input, {}, model_.process_noise(), model_.interval()});
    for (ConstantParticle& one : particles_) motion_.move(one, record_.back());
    formed_ = false;
  }

  const Gaussian& estimate() const override {
    if (!formed_) form();
    return estimate_;
  }

 protected:
  void take_in(const VectorXd& output, const VectorXd& input) override {
    record_.push_back({true, output, input, model_.observed(), model_.output_noise(), model_.interval()});
    const VectorXd weights = shares(1.0);
    const Index p = output.size();
    VectorXd expected = VectorXd::Zero(p);
    MatrixXd squares = MatrixXd::Zero(p, p);
    std::vector<double> logs;
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      VectorXd shown;
      MatrixXd s;
      const double log = motion_.correct(particles_[i], record_.back(), shown, s);
      particles_[i].fresh += log;
      logs.push_back(log);
      const double w = weights[static_cast<Index>(i)];
      expected += w * shown;
      squares += w * (s + shown * shown.transpose());
    }
    correction_.innovation = output - expected;
    correction_.innovation_covariance = squares - expected * expected.transpose();
    weigh(correction_, MatrixXd(0, p), factor_);
    const double largest = *std::max_element(logs.begin(), logs.end());
    double sum = 0.0;
    for (std::size_t i = 0; i < logs.size(); ++i)
      sum += weights[static_cast<Index>(i)] * std::exp(logs[i] - largest);
    correction_.log_likelihood = largest + std::log(sum);
    if (!motion_.held().empty()) keep_apart();
    formed_ = false;
  }

 private:
  // W_i ~ exp(power x fresh).
  VectorXd shares(double power) const {
    VectorXd logs(static_cast<Index>(particles_.size()));
    for (Index i = 0; i < logs.size(); ++i) logs[i] = power * particles_[static_cast<std::size_t>(i)].fresh;
    const VectorXd weights = (logs.array() - logs.maxCoeff()).exp();
    return weights / weights.sum();
  }

  double effective_share(const VectorXd& weights) const {
    return 1.0 / (weights.squaredNorm() * static_cast<double>(weights.size()));
  }

  // Fresh readings are let in by powers, so far that a share of the particles stays effective each time.
  void keep_apart() {
    double taken = 0.0;
    if (effective_share(shares(1.0)) >= share_) return;
    while (taken < 1.0) {
      double lower = taken, upper = 1.0;
      if (effective_share(shares(1.0 - taken)) < share_) {
        for (int i = 0; i < 40; ++i) {
          const double middle = 0.5 * (lower + upper);
          (effective_share(shares(middle - taken)) < share_ ? upper : lower) = middle;
        }
        upper = std::max(lower, std::nextafter(taken, 1.0));
      }
      resample_and_move(upper - taken, upper);
      taken = upper;
    }
    for (ConstantParticle& one : particles_) one.settled += one.fresh, one.fresh = 0.0;
    settled_steps_ = record_.size();
  }

  void resample_and_move(double power, double reached) {
    const VectorXd weights = shares(power);
    const auto count = static_cast<Index>(particles_.size()), q = static_cast<Index>(motion_.held().size());
    MatrixXd thetas(q, count);
    for (Index i = 0; i < count; ++i) thetas.col(i) = particles_[static_cast<std::size_t>(i)].theta;
    const VectorXd mean = thetas * weights;
    const MatrixXd off = thetas.colwise() - mean;
    MatrixXd spread = off * weights.asDiagonal() * off.transpose();
    spread.diagonal() += 1e-12 * spread.diagonal() + VectorXd::Constant(q, 1e-300);
    std::vector<ConstantParticle> drawn;
    for (const Index i : systematic_draws(weights, random_.uniform()))
      drawn.push_back(particles_[static_cast<std::size_t>(i)]);
    particles_ = std::move(drawn);
    const Eigen::LLT<MatrixXd> known(motion_.start().covariance(motion_.held(), motion_.held())),
        fitted(spread);
    const auto log_normal = [](const Eigen::LLT<MatrixXd>& factor, const VectorXd& from) {
      return -0.5 * factor.matrixL().solve(from).squaredNorm();
    };
    const auto target = [&](const ConstantParticle& one) {
      return log_normal(known, one.theta - motion_.start().mean(motion_.held())) + one.settled +
             reached * one.fresh;
    };
    // Proposals whose sample has the fitted moments exactly: where most are accepted, so has the posterior's.
    for (Index k = 0; k < moves_; ++k) {
      const MatrixXd draws = exact_draws(random_, q, count, MatrixXd(0, count)).values;
      for (Index i = 0; i < count; ++i) {
        ConstantParticle& one = particles_[static_cast<std::size_t>(i)];
        ConstantParticle other = one;
        other.theta = mean + fitted.matrixL() * draws.col(i);
        motion_.replay(other, record_, settled_steps_);
        const double gain = target(other) - target(one) - log_normal(fitted, other.theta - mean) +
                            log_normal(fitted, one.theta - mean);
        if (std::log(random_.uniform()) < gain) one = std::move(other);
      }
    }
  }

  void form() const {
    const Index n = motion_.start().mean.size();
    const VectorXd weights = shares(1.0);
    estimate_ = {VectorXd::Zero(n), MatrixXd::Zero(n, n), {}};
    for (std::size_t i = 0; i < particles_.size(); ++i)
      estimate_.mean += weights[static_cast<Index>(i)] * motion_.state(particles_[i]);
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      const VectorXd off = motion_.state(particles_[i]) - estimate_.mean;
      MatrixXd own = off * off.transpose();
      own(motion_.free(), motion_.free()) += particles_[i].covariance;
      estimate_.covariance += weights[static_cast<Index>(i)] * own;
    }
    symmetrise(estimate_.covariance);
    formed_ = true;
  }

  Index wanted_, moves_, seed_;
  double share_;
  RandomStream random_;
  ConditionalMotion motion_;
  std::vector<ConstantParticle> particles_;
  std::vector<RecordStep> record_;
  std::size_t settled_steps_ = 0;  // of the record, whose likelihood the particles have as settled
  MatrixXd root_;
  Eigen::LLT<MatrixXd> factor_;
  mutable Gaussian estimate_;
  mutable bool formed_ = false;
};

const bool rao_blackwellised_registered = filter_registry().add(
    {"rao_blackwellised",
     "constants as particles, moved over the record so far; the motion given them exactly",
     "[chopin2002], [doucet2000]",
     {{"particles", 100.0, "", "how many"},
      {"resample_below", 0.5, "", "share of effective particles below which they are drawn again and moved"},
      {"moves", 1.0, "", "proposals for each particle then"},
      {"seed", 1.0, "", "of the random draws: a whole number"}},
     {contract::exact_on_linear_gaussian, contract::linear_motion_only},
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<RaoBlackwellised>(std::move(model), options);
     }});

}  // namespace

}  // namespace beamid::filters
