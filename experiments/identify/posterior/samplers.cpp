#include "experiments/identify/posterior/samplers.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <Eigen/Cholesky>

#include "filters/particle_cloud.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {
namespace {

using Eigen::VectorXd;

constexpr int most_doublings = 8;
constexpr double hopeless_energy = 1000.0;

struct PhasePoint {
  ChainPlace place;
  VectorXd momentum;
  double energy() const { return -place.log + 0.5 * momentum.squaredNorm(); }
};

/// A stretch of the path: its ends, the place drawn from it, and its weight.
struct PathStretch {
  PhasePoint first, last;
  ChainPlace drawn;
  double log_weight = -std::numeric_limits<double>::infinity();
  bool ended = false;  // turned back, or diverged
};

double log_of_sum(double a, double b) {
  const double largest = std::max(a, b);
  if (largest == -std::numeric_limits<double>::infinity()) return largest;
  return largest + std::log(std::exp(a - largest) + std::exp(b - largest));
}

bool turns_back(const PhasePoint& first, const PhasePoint& last) {
  const VectorXd span = last.place.y - first.place.y;
  return span.dot(first.momentum) < 0.0 || span.dot(last.momentum) < 0.0;
}

class PathBuilder {
 public:
  PathBuilder(const ChainDensity& density, double step, double energy, filters::RandomStream& random,
              Trajectory& result)
      : density_(density), step_(step), energy_(energy), random_(random), result_(result) {}

  /// 2^depth points beyond `from`; `forward` or backward in time.
  PathStretch grow(const PhasePoint& from, int depth, bool forward) {
    if (depth == 0) return leap(from, forward);
    PathStretch near = grow(from, depth - 1, forward);
    if (near.ended) return near;
    PathStretch far = grow(forward ? near.last : near.first, depth - 1, forward);
    PathStretch both;
    both.first = forward ? near.first : far.first;
    both.last = forward ? far.last : near.last;
    both.log_weight = log_of_sum(near.log_weight, far.log_weight);
    const bool take_far = std::log(random_.uniform()) < far.log_weight - both.log_weight;
    both.drawn = take_far ? std::move(far.drawn) : std::move(near.drawn);
    both.ended = far.ended || turns_back(both.first, both.last);
    return both;
  }

 private:
  const ChainDensity& density_;
  double step_, energy_;
  filters::RandomStream& random_;
  Trajectory& result_;

  PathStretch leap(const PhasePoint& from, bool forward) {
    const double dt = forward ? step_ : -step_;
    PhasePoint next;
    next.momentum = from.momentum + 0.5 * dt * from.place.slope;
    next.place = density_(from.place.y + dt * next.momentum);
    ++result_.leaps;
    PathStretch stretch;
    if (!std::isfinite(next.place.log)) {  // impossible there: a wall
      stretch.first = stretch.last = from;
      stretch.drawn = from.place;
      stretch.ended = result_.diverged = true;
      return stretch;
    }
    next.momentum += 0.5 * dt * next.place.slope;
    const double error = next.energy() - energy_;
    result_.acceptance += std::min(1.0, std::exp(-error));
    stretch.log_weight = -error;
    stretch.ended = !(error < hopeless_energy);
    result_.diverged = result_.diverged || stretch.ended;
    stretch.drawn = next.place;
    stretch.first = stretch.last = std::move(next);
    return stretch;
  }
};

}  // namespace

Trajectory no_u_turn(const ChainDensity& density, const ChainPlace& start, double step,
                     filters::RandomStream& random) {
  Trajectory result;
  PhasePoint here{start, random.normal(start.y.size(), 1)};
  PathBuilder builder(density, step, here.energy(), random, result);
  PathStretch path{here, here, start, 0.0, false};
  for (int depth = 0; depth < most_doublings; ++depth) {
    const bool forward = random.uniform() < 0.5;
    PathStretch more = builder.grow(forward ? path.last : path.first, depth, forward);
    if (more.ended) break;
    if (std::log(random.uniform()) < more.log_weight - path.log_weight) path.drawn = std::move(more.drawn);
    path.log_weight = log_of_sum(path.log_weight, more.log_weight);
    (forward ? path.last : path.first) = forward ? std::move(more.last) : std::move(more.first);
    if (turns_back(path.first, path.last)) break;
  }
  result.end = std::move(path.drawn);
  result.acceptance /= std::max(1, result.leaps);
  return result;
}

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kept_share = 0.5;
constexpr int most_stages = 200;

struct Particle {
  VectorXd u;
  LikelihoodValue value;
};

/// N(mean, spread^2 G^-1) around a particle, G = b J^T J + 1.
struct LocalProposal {
  Eigen::LLT<MatrixXd> root;
  VectorXd mean;
  double spread;

  LocalProposal(const Particle& from, double power, bool drift, double step) : spread(step) {
    const Index q = from.u.size();
    root.compute(power * from.value.information + MatrixXd::Identity(q, q));
    mean = from.u;
    if (drift)  // leaves a normal density alone: mean of an autoregression with the correlation sqrt(1 -
                // step^2)
      mean += (1.0 - std::sqrt(1.0 - step * step)) * root.solve(power * from.value.gradient - from.u);
  }
  VectorXd draw(const VectorXd& normal) const { return mean + spread * root.matrixU().solve(normal); }
  double log_density(const VectorXd& u) const {
    return -0.5 * (root.matrixU() * (u - mean)).squaredNorm() / (spread * spread) +
           MatrixXd(root.matrixLLT()).diagonal().array().log().sum();
  }
};

bool move_particle(const Likelihood& likelihood, Particle& particle, double power, double step,
                   filters::RandomStream& random) {
  const bool drift = random.uniform() < 0.5;
  const LocalProposal there(particle, power, drift, step);
  Particle proposed;
  proposed.u = there.draw(random.normal(particle.u.size(), 1));
  const double threshold = std::log(random.uniform());
  proposed.value = likelihood.at(proposed.u, true);
  if (!proposed.value.possible()) return false;
  const LocalProposal back(proposed, power, drift, step);
  const double gain = power * (proposed.value.log - particle.value.log) -
                      0.5 * (proposed.u.squaredNorm() - particle.u.squaredNorm()) +
                      back.log_density(particle.u) - there.log_density(proposed.u);
  if (!(threshold < gain)) return false;
  particle = std::move(proposed);
  return true;
}

/// Weights L^step, and how many of them count.
struct TemperingWeights {
  VectorXd weight;
  double log_mean = 0.0, effective = 0.0;

  TemperingWeights(const std::vector<Particle>& particles, double step)
      : weight(static_cast<Index>(particles.size())) {
    double largest = -std::numeric_limits<double>::infinity();
    for (const Particle& one : particles) largest = std::max(largest, one.value.log);
    for (Index i = 0; i < weight.size(); ++i) {
      const double log = particles[static_cast<std::size_t>(i)].value.log;
      weight[i] = log == -std::numeric_limits<double>::infinity() ? 0.0 : std::exp(step * (log - largest));
    }
    log_mean = step * largest + std::log(weight.mean());
    effective = std::pow(weight.sum(), 2) / weight.squaredNorm();
  }
};

double next_step(const std::vector<Particle>& particles, double power) {
  const double wanted = kept_share * static_cast<double>(particles.size());
  if (TemperingWeights(particles, 1.0 - power).effective >= wanted) return 1.0 - power;
  double low = 0.0, high = 1.0 - power;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (TemperingWeights(particles, middle).effective < wanted ? high : low) = middle;
  }
  return low > 0.0 ? low : high;  // impossible particles alone may be more than the half
}

std::vector<Particle> drawn_again(const std::vector<Particle>& particles, const VectorXd& weight,
                                  double offset) {
  std::vector<Particle> drawn;
  for (const Index i : filters::systematic_draws(weight / weight.sum(), offset))
    drawn.push_back(particles[static_cast<std::size_t>(i)]);
  return drawn;
}

}  // namespace

TemperedDraws tempered_draws(const Likelihood& likelihood, std::size_t count, std::uint64_t seed,
                             const Progress& progress) {
  const Index q = likelihood.size();
  std::vector<Particle> particles(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    particles[i].u = filters::RandomStream(seed, i).normal(q, 1);
    particles[i].value = likelihood.at(particles[i].u, true);
  });
  TemperedDraws result;
  result.evaluations = count;
  if (std::none_of(particles.begin(), particles.end(),
                   [](const Particle& one) { return one.value.possible(); }))
    throw std::invalid_argument(
        "no draw of the prior can have produced what was measured; expected another prior");
  double power = 0.0, step = 0.9;
  int moves = 4;
  while (power < 1.0 && result.stages < most_stages) {
    const double rise = next_step(particles, power);
    const TemperingWeights weights(particles, rise);
    result.log_evidence += weights.log_mean;
    power = std::min(1.0, power + rise);
    if (1.0 - power < 1e-12) power = 1.0;
    ++result.stages;
    progress(fmt::format("stage {}: {:.2g} of the likelihood", result.stages, power));
    const std::uint64_t stream = static_cast<std::uint64_t>(result.stages) << 32;
    particles = drawn_again(particles, weights.weight, filters::RandomStream(seed, stream + count).uniform());
    std::atomic<std::size_t> accepted = 0;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      filters::RandomStream random(seed, stream + i);
      std::size_t taken = 0;
      for (int move = 0; move < moves; ++move)
        taken += move_particle(likelihood, particles[i], power, step, random);
      accepted += taken;
    });
    result.evaluations += count * static_cast<std::size_t>(moves);
    result.acceptance =
        static_cast<double>(accepted) / static_cast<double>(count * static_cast<std::size_t>(moves));
    if (result.acceptance < 0.3) step = std::max(0.05, 0.7 * step);
    if (result.acceptance > 0.6) step = std::min(0.95, 1.2 * step);
    moves = std::clamp(static_cast<int>(std::ceil(2.0 / std::max(0.05, result.acceptance))), 3, 12);
  }
  if (power < 1.0)
    throw std::invalid_argument("the likelihood is so narrow that no stages of tempering reach it");
  result.draws.resize(q, static_cast<Index>(count));
  result.log_likelihood.resize(static_cast<Index>(count));
  for (std::size_t i = 0; i < count; ++i) {
    result.draws.col(static_cast<Index>(i)) = particles[i].u;
    result.log_likelihood[static_cast<Index>(i)] = particles[i].value.log;
  }
  return result;
}

}  // namespace beamid::experiments
