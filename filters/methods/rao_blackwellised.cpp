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
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "filters/exact_draws.hpp"
#include "filters/filter.hpp"
#include "filters/innovation.hpp"
#include "filters/random.hpp"
#include "filters/whole_number.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// One step of the record so far, as it was met.
struct MetStep {
  bool reading = false;
  VectorXd output, input;
  std::vector<Index> observed;
  MatrixXd noise;  // R of a reading, Q of a step
  double interval = 0.0;
};

struct ConstantParticle {
  VectorXd theta, mean;  // (q), (l)
  MatrixXd covariance;   // (l x l)
  // Motion and readings given theta, as long as interval and outputs stay: x+ = A x + c, y = H x + d.
  double interval = -1.0;
  MatrixXd a, h;
  VectorXd c, d;
  std::vector<Index> seen;
  double settled = 0.0;  // ln likelihood of the readings before the last move
  double fresh = 0.0;    // and since
};

bool differ(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() > 1e-9 * (a.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
}

class RaoBlackwellised final : public Filter {
 public:
  RaoBlackwellised(std::unique_ptr<DiscreteModel> model, const Options& options)
      : Filter(std::move(model)),
        wanted_(whole_number(options.number("particles"), 10, "rao_blackwellised", "particles")),
        moves_(whole_number(options.number("moves"), 1, "rao_blackwellised", "moves")),
        seed_(whole_number(options.number("seed"), 0, "rao_blackwellised", "seed")),
        share_(options.number("resample_below")),
        random_(static_cast<std::uint64_t>(seed_)) {
    if (!(share_ > 0.0 && share_ < 1.0))
      throw std::invalid_argument("rao_blackwellised: resample_below is " + std::to_string(share_) +
                                  "; expected a number between 0 and 1");
  }

  void reset(const Gaussian& belief) override {
    check_belief(belief, model_);
    Gaussian whole = belief;
    if (whole.covariance.size() == 0) whole.covariance = belief.factor * belief.factor.transpose();
    random_ = RandomStream(static_cast<std::uint64_t>(seed_));
    sort_entries(whole);
    record_.clear();
    settled_steps_ = 0;
    start_ = whole;
    particles_.assign(static_cast<std::size_t>(held_.empty() ? 1 : wanted_), {});
    if (!held_.empty()) root_ = square_root(whole.covariance(held_, held_), factor_);
    const auto q = static_cast<Index>(held_.size());
    const auto count = static_cast<Index>(particles_.size());
    const MatrixXd draws = exact_draws(random_, q, count, MatrixXd(0, count)).values;
    for (Index i = 0; i < count; ++i) {
      ConstantParticle& one = particles_[static_cast<std::size_t>(i)];
      one.theta = whole.mean(held_);
      if (q > 0) one.theta += root_ * draws.col(i);
      begin(one);
    }
    formed_ = false;
  }

  void predict(const VectorXd& input) override {
    record_.push_back({false, {}, input, {}, model_.process_noise(), model_.interval()});
    for (ConstantParticle& one : particles_) move(one, record_.back());
    formed_ = false;
  }

  const Gaussian& belief() const override {
    if (!formed_) form();
    return belief_;
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
      const double log = correct(particles_[i], record_.back(), shown, s);
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
    if (!held_.empty()) keep_apart();
    formed_ = false;
  }

 private:
  // Constants are entries that stay as they are, without noise. Those that the motion of the others depends
  // on are held by particles.
  void sort_entries(const Gaussian& belief) {
    const Index n = belief.mean.size();
    const VectorXd none, deviation = belief.deviations();
    VectorXd next;
    MatrixXd moved, shown, other;
    model_.linearised_transition(belief.mean, none, next, moved);
    model_.output_jacobian(belief.mean, none, shown);
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
      VectorXd there = belief.mean;
      there[i] += deviation[i] > 0.0 ? deviation[i] : 1e-3 * std::max(1.0, std::abs(there[i]));
      model_.linearised_transition(there, none, next, other);
      bool changes = differ(moved(moving, moving), other(moving, moving));
      model_.output_jacobian(there, none, other);
      changes = changes || differ(shown(Eigen::all, moving), other(Eigen::all, moving));
      (changes ? held_ : free_).push_back(i);
    }
    std::sort(free_.begin(), free_.end());
    VectorXd there = belief.mean;
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

  // The motion's belief at the start, given theta.
  void begin(ConstantParticle& one) const {
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

  VectorXd state_of(const ConstantParticle& one) const {
    VectorXd state(start_.mean.size());
    state(free_) = one.mean;
    state(held_) = one.theta;
    return state;
  }

  void move(ConstantParticle& one, const MetStep& step) {
    if (one.interval != step.interval) {
      const VectorXd none = VectorXd::Zero(step.input.size());
      model_.linearised_transition(state_of(one), none, next_, tangent_);
      one.interval = step.interval;
      one.a = tangent_(free_, free_);
      one.c = next_(free_) - one.a * one.mean;
    }
    if (step.input.size() > 0) {
      model_.transition(state_of(one), step.input, next_);
      one.mean = next_(free_);
    } else {
      one.mean = (one.a * one.mean + one.c).eval();
    }
    work_.noalias() = one.a * one.covariance;
    one.covariance.noalias() = work_ * one.a.transpose();
    if (step.noise.size() > 0) one.covariance += step.noise(free_, free_);
    symmetrise(one.covariance);
  }

  /// @returns ln p(y | theta, what was read before)
  double correct(ConstantParticle& one, const MetStep& step, VectorXd& shown, MatrixXd& s) {
    if (one.h.size() == 0 || one.seen != step.observed) {
      const VectorXd none = VectorXd::Zero(step.input.size()), state = state_of(one);
      model_.output(state, none, shown);
      model_.output_jacobian(state, none, tangent_);
      one.seen = step.observed;
      one.h = tangent_(Eigen::all, free_);
      one.d = shown - one.h * one.mean;
    }
    const MatrixXd& h = one.h;
    if (step.input.size() > 0)
      model_.output(state_of(one), step.input, shown);
    else
      shown = h * one.mean + one.d;
    const MatrixXd across = one.covariance * h.transpose();
    s = h * across + step.noise;
    const Eigen::LLT<MatrixXd> factor(s);
    if (factor.info() != Eigen::Success) return -std::numeric_limits<double>::infinity();
    const VectorXd rest = step.output - shown;
    const MatrixXd gain = factor.solve(across.transpose()).transpose();
    one.mean += gain * rest;
    MatrixXd kept = -gain * h;
    kept.diagonal().array() += 1.0;
    one.covariance = (kept * one.covariance * kept.transpose() + gain * step.noise * gain.transpose()).eval();
    return -0.5 * (rest.dot(factor.solve(rest)) + std::log(2.0 * std::numbers::pi) * rest.size()) -
           factor.matrixLLT().diagonal().array().log().sum();
  }

  // The record so far once more.
  void replay(ConstantParticle& one) {
    const double interval = model_.interval();
    const std::vector<Index> observed = model_.observed();
    begin(one);
    VectorXd shown;
    MatrixXd s;
    for (std::size_t k = 0; k < record_.size(); ++k) {
      const MetStep& step = record_[k];
      if (step.interval != model_.interval()) model_.set_interval(step.interval);
      if (step.reading) {
        if (step.observed != model_.observed()) model_.observe(step.observed);
        (k < settled_steps_ ? one.settled : one.fresh) += correct(one, step, shown, s);
      } else {
        move(one, step);
      }
    }
    if (interval != model_.interval()) model_.set_interval(interval);
    if (observed != model_.observed()) model_.observe(observed);
  }

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
    const auto count = static_cast<Index>(particles_.size()), q = static_cast<Index>(held_.size());
    MatrixXd thetas(q, count);
    for (Index i = 0; i < count; ++i) thetas.col(i) = particles_[static_cast<std::size_t>(i)].theta;
    const VectorXd mean = thetas * weights;
    const MatrixXd off = thetas.colwise() - mean;
    MatrixXd spread = off * weights.asDiagonal() * off.transpose();
    spread.diagonal() += 1e-12 * spread.diagonal() + VectorXd::Constant(q, 1e-300);
    std::vector<ConstantParticle> drawn;
    double sum = 0.0, next = random_.uniform();
    for (Index i = 0; i < count; ++i) {
      sum += weights[i] * static_cast<double>(count);
      for (; next < sum; next += 1.0) drawn.push_back(particles_[static_cast<std::size_t>(i)]);
    }
    while (drawn.size() < particles_.size()) drawn.push_back(drawn.back());
    particles_ = std::move(drawn);
    const Eigen::LLT<MatrixXd> known(start_.covariance(held_, held_)), fitted(spread);
    const auto log_normal = [](const Eigen::LLT<MatrixXd>& factor, const VectorXd& from) {
      return -0.5 * factor.matrixL().solve(from).squaredNorm();
    };
    const auto target = [&](const ConstantParticle& one) {
      return log_normal(known, one.theta - start_.mean(held_)) + one.settled + reached * one.fresh;
    };
    // Proposals whose sample has the fitted moments exactly: where most are accepted, so has the posterior's.
    for (Index k = 0; k < moves_; ++k) {
      const MatrixXd draws = exact_draws(random_, q, count, MatrixXd(0, count)).values;
      for (Index i = 0; i < count; ++i) {
        ConstantParticle& one = particles_[static_cast<std::size_t>(i)];
        ConstantParticle other = one;
        other.theta = mean + fitted.matrixL() * draws.col(i);
        replay(other);
        const double gain = target(other) - target(one) - log_normal(fitted, other.theta - mean) +
                            log_normal(fitted, one.theta - mean);
        if (std::log(random_.uniform()) < gain) one = std::move(other);
      }
    }
  }

  void form() const {
    const Index n = start_.mean.size();
    const VectorXd weights = shares(1.0);
    belief_ = {VectorXd::Zero(n), MatrixXd::Zero(n, n), {}};
    for (std::size_t i = 0; i < particles_.size(); ++i)
      belief_.mean += weights[static_cast<Index>(i)] * state_of(particles_[i]);
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      const VectorXd off = state_of(particles_[i]) - belief_.mean;
      MatrixXd own = off * off.transpose();
      own(free_, free_) += particles_[i].covariance;
      belief_.covariance += weights[static_cast<Index>(i)] * own;
    }
    symmetrise(belief_.covariance);
    formed_ = true;
  }

  Index wanted_, moves_, seed_;
  double share_;
  RandomStream random_;
  Gaussian start_;
  std::vector<Index> held_, free_;  // places of theta, of the rest
  std::vector<ConstantParticle> particles_;
  std::vector<MetStep> record_;
  std::size_t settled_steps_ = 0;  // of the record, whose likelihood the particles have as settled
  MatrixXd root_, tangent_, work_;
  VectorXd next_;
  Eigen::LLT<MatrixXd> factor_;
  mutable Gaussian belief_;
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
