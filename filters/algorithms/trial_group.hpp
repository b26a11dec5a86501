// As many trials as there are lanes, run side by side.
#pragma once

#include "filters/algorithms/extended_kalman.hpp"
#include "filters/algorithms/innovation_group.hpp"
#include "filters/algorithms/oscillator.hpp"

namespace beamid::filters::algorithms {

/// Where a group's numbers lie; plain pointers, so that files compiled for different processors share no
/// code.
struct TrialGroup {
  static constexpr int most = 4;  ///< lanes
  /// Models (oscillator.hpp): of 4 states, moved exactly or by Euler's step, and of 5.
  enum class Motion { exact, forward_euler, ringing };

  Motion motion;
  double mass;       ///< M [kg]; nothing to a ringing mode
  double frequency;  ///< w_0 [rad/s] of a ringing mode; nothing to the others
  double interval;
  int outputs;           ///< p; 1 of a ringing mode
  Quantity observed[3];  ///< nothing to a ringing mode
  std::int64_t samples;
  bool predict_first;
  struct Lane {
    const double *record, *mean, *covariance;    ///< y (p x samples), m (n), P (n x n)
    const double *process_noise, *output_noise;  ///< Q (n x n), R (p x p)
    double *last_mean, *last_covariance;
    double sum_of_squares;  ///< of whitened innovations
    double mantissa;        ///< of the product of the diagonals of the roots of S
    std::int64_t exponent;
    std::int64_t measured;  ///< number of readings
    std::int64_t failed;    ///< sample at which the lane failed, or -1
  } lanes[most];
};

/// The extended Kalman filter on a group of W trials with P outputs.
/// @tparam Model Oscillator, EulerOscillator or RingingOscillator of these lanes
template <int W, class Instructions, int P, class Model>
class TrialGroupRun {
 public:
  using Scalar = Lanes<W, Instructions>;
  using Mask = typename Scalar::Mask;
  static constexpr int N = Model::states;

  explicit TrialGroupRun(TrialGroup& group) : group_(group), model_(model_of(group)) {
    filter_.mean = gather<N, 1>([&](int lane) { return group.lanes[lane].mean; });
    filter_.covariance = gather<N, N>([&](int lane) { return group.lanes[lane].covariance; });
    for (auto& lane : group.lanes) lane.failed = -1;
  }

  /// All of it in one function: what is left outside costs half as much again. Sanitizers would take ten
  /// minutes to compile it.
#ifndef __SANITIZE_ADDRESS__
  [[gnu::flatten]]
#endif
  void
  run() {
    for (std::int64_t k = 0; k < group_.samples; ++k) {
      mean_ = filter_.mean;
      covariance_ = filter_.covariance;
      if (k > 0 || group_.predict_first) filter_.predict(model_);
      Vector<Scalar, P> y = gather<P, 1>([&](int lane) { return group_.lanes[lane].record + k * P; });
      // NOLINTBEGIN(misc-redundant-expression): a NaN does not equal itself
      Mask complete = y[0] == y[0];
      for (int i = 1; i < P; ++i) complete = complete & (y[i] == y[i]);
      // NOLINTEND(misc-redundant-expression)
      if (all(complete)) [[likely]] {
        correct(model_, y);
        measured_ += select(alive_, Scalar(P), Scalar(0.0));
      } else {
        SomeOutputs<Model, Scalar, N, P> some(model_, y);
        correct(some, y);
        measured_ += select(alive_, some.measured().sum(), Scalar(0.0));
      }
      if (any(!alive_)) [[unlikely]]
        keep_dead(k);
    }
    for (int lane = 0; lane < W; ++lane) write(lane);
  }

 private:
  static Model model_of(const TrialGroup& group) {
    const auto q = gather<N, N>([&](int lane) { return group.lanes[lane].process_noise; });
    const auto r = gather<P, P>([&](int lane) { return group.lanes[lane].output_noise; });
    if constexpr (std::is_same_v<Model, RingingOscillator<Scalar>>) {
      return {group.frequency, group.interval, q, r};
    } else {
      std::array<Quantity, P> observed;
      for (int i = 0; i < P; ++i) observed[i] = group.observed[i];
      return {group.mass, group.interval, observed, q, r};
    }
  }

  template <int Rows, int Columns, class PlaceOfLane>
  static Eigen::Matrix<Scalar, Rows, Columns> gather(const PlaceOfLane& place) {
    Eigen::Matrix<Scalar, Rows, Columns> result;
    for (int i = 0; i < Rows * Columns; ++i) {
      typename Scalar::Values values{};
      for (int lane = 0; lane < W; ++lane) values[lane] = place(lane)[i];
      result(i % Rows, i / Rows) = values;
    }
    return result;
  }

  template <class Seen>
  void correct(Seen& model, const Vector<Scalar, P>& y) {
    filter_.look(model, y);
    filter_.update(model);
    const auto& seen = filter_.seen;
    alive_ = alive_ & (seen.smallest_pivot > Scalar(0.0));
    for (int i = 0; i < N; ++i) {
      const Scalar variance = filter_.covariance(i, i), zero = 0.0 * (filter_.mean[i] + variance);
      alive_ = alive_ & (zero == Scalar(0.0)) & (variance >= Scalar(0.0));
    }
    sum_of_squares_ += select(alive_, seen.normalised_square, Scalar(0.0));
    for (int i = 0; i < P; ++i) product_.multiply(select(alive_, seen.root(i, i), Scalar(1.0)));
  }

  // A lane that failed stays at its last good estimate, and marks when.
  void keep_dead(std::int64_t k) {
    for (int i = 0; i < N; ++i) {
      filter_.mean[i] = select(alive_, filter_.mean[i], mean_[i]);
      for (int j = 0; j < N; ++j)
        filter_.covariance(i, j) = select(alive_, filter_.covariance(i, j), covariance_(i, j));
    }
    for (int lane = 0; lane < W; ++lane)
      if (!alive_[lane] && group_.lanes[lane].failed < 0) group_.lanes[lane].failed = k;
  }

  void write(int lane) const {
    auto& out = group_.lanes[lane];
    for (int i = 0; i < N; ++i) {
      out.last_mean[i] = filter_.mean[i][lane];
      for (int j = 0; j < N; ++j) out.last_covariance[N * j + i] = filter_.covariance(i, j)[lane];
    }
    out.sum_of_squares = sum_of_squares_[lane];
    out.mantissa = product_.mantissa(lane);
    out.exponent = product_.exponent(lane);
    out.measured = static_cast<std::int64_t>(measured_[lane]);
  }

  TrialGroup& group_;
  Model model_;
  ExtendedKalman<Scalar, N, P> filter_;
  Vector<Scalar, N> mean_;  // before the step
  Matrix<Scalar, N> covariance_;
  Mask alive_ = Scalar(0.0) == Scalar(0.0);
  Scalar sum_of_squares_ = 0.0, measured_ = 0.0;
  LogProduct<Scalar> product_;
};

template <int W, class Instructions, template <class, int> class Motion>
void run_group_moving(TrialGroup& group) {
  using Scalar = Lanes<W, Instructions>;
  if (group.outputs == 1) TrialGroupRun<W, Instructions, 1, Motion<Scalar, 1>>(group).run();
  if (group.outputs == 2) TrialGroupRun<W, Instructions, 2, Motion<Scalar, 2>>(group).run();
  if (group.outputs == 3) TrialGroupRun<W, Instructions, 3, Motion<Scalar, 3>>(group).run();
}

template <int W, class Instructions>
void run_group(TrialGroup& group) {
  using Motion = TrialGroup::Motion;
  using Ringing = RingingOscillator<Lanes<W, Instructions>>;
  if (group.motion == Motion::ringing) return TrialGroupRun<W, Instructions, 1, Ringing>(group).run();
  if (group.motion == Motion::forward_euler) return run_group_moving<W, Instructions, EulerOscillator>(group);
  run_group_moving<W, Instructions, Oscillator>(group);
}

}  // namespace beamid::filters::algorithms
