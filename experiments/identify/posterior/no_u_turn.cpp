#include "experiments/identify/posterior/no_u_turn.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace beamid::experiments
