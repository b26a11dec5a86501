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

  double mass, interval;
  int outputs;  ///< p
  Quantity observed[3];
  const double *output_noise, *process_noise;  ///< R (p x p), Q (4 x 4)
  std::int64_t samples;
  bool predict_first;
  bool forward_euler;  ///< how the oscillator moves; else exactly
  struct Lane {
    const double *record, *mean, *covariance;  ///< y (p x samples), m (4), P (4 x 4)
    double *last_mean, *last_covariance;
    double sum_of_squares;  ///< of whitened innovations
    double mantissa;        ///< of the product of the diagonals of the roots of S
    std::int64_t exponent;
    std::int64_t measured;  ///< number of readings
    std::int64_t failed;    ///< sample at which the lane failed, or -1
  } lanes[most];
};

/// The extended Kalman filter on a group of W trials with P outputs.
/// @tparam Motion Oscillator or EulerOscillator
template <int W, class Instructions, int P, template <class, int> class Motion>
class TrialGroupRun {
 public:
  using Scalar = Lanes<W, Instructions>;
  using Model = Motion<Scalar, P>;
  using Mask = typename Scalar::Mask;

  explicit TrialGroupRun(TrialGroup& group)
      : group_(group),
        model_(group.mass, group.interval, observed(group),
               gather<4, 4>([&](int) { return group.process_noise; }),
               gather<P, P>([&](int) { return group.output_noise; })) {
    filter_.mean = gather<4, 1>([&](int lane) { return group.lanes[lane].mean; });
    filter_.covariance = gather<4, 4>([&](int lane) { return group.lanes[lane].covariance; });
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
        SomeOutputs<Model, Scalar, 4, P> some(model_, y);
        correct(some, y);
        measured_ += select(alive_, some.measured().sum(), Scalar(0.0));
      }
      if (any(!alive_)) [[unlikely]]
        keep_dead(k);
    }
    for (int lane = 0; lane < W; ++lane) write(lane);
  }

 private:
  static std::array<Quantity, P> observed(const TrialGroup& group) {
    std::array<Quantity, P> result;
    for (int i = 0; i < P; ++i) result[i] = group.observed[i];
    return result;
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
    for (int i = 0; i < 4; ++i) {
      const Scalar variance = filter_.covariance(i, i), zero = 0.0 * (filter_.mean[i] + variance);
      alive_ = alive_ & (zero == Scalar(0.0)) & (variance >= Scalar(0.0));
    }
    sum_of_squares_ += select(alive_, seen.normalised_square, Scalar(0.0));
    for (int i = 0; i < P; ++i) product_.multiply(select(alive_, seen.root(i, i), Scalar(1.0)));
  }

  // A lane that failed stays at its last good estimate, and marks when.
  void keep_dead(std::int64_t k) {
    for (int i = 0; i < 4; ++i) {
      filter_.mean[i] = select(alive_, filter_.mean[i], mean_[i]);
      for (int j = 0; j < 4; ++j)
        filter_.covariance(i, j) = select(alive_, filter_.covariance(i, j), covariance_(i, j));
    }
    for (int lane = 0; lane < W; ++lane)
      if (!alive_[lane] && group_.lanes[lane].failed < 0) group_.lanes[lane].failed = k;
  }

  void write(int lane) const {
    auto& out = group_.lanes[lane];
    for (int i = 0; i < 4; ++i) {
      out.last_mean[i] = filter_.mean[i][lane];
      for (int j = 0; j < 4; ++j) out.last_covariance[4 * j + i] = filter_.covariance(i, j)[lane];
    }
    out.sum_of_squares = sum_of_squares_[lane];
    out.mantissa = product_.mantissa(lane);
    out.exponent = product_.exponent(lane);
    out.measured = static_cast<std::int64_t>(measured_[lane]);
  }

  TrialGroup& group_;
  Model model_;
  ExtendedKalman<Scalar, 4, P> filter_;
  Vector<Scalar, 4> mean_;  // before the step
  Matrix<Scalar, 4> covariance_;
  Mask alive_ = Scalar(0.0) == Scalar(0.0);
  Scalar sum_of_squares_ = 0.0, measured_ = 0.0;
  LogProduct<Scalar> product_;
};

template <int W, class Instructions, template <class, int> class Motion>
void run_group_moving(TrialGroup& group) {
  if (group.outputs == 1) TrialGroupRun<W, Instructions, 1, Motion>(group).run();
  if (group.outputs == 2) TrialGroupRun<W, Instructions, 2, Motion>(group).run();
  if (group.outputs == 3) TrialGroupRun<W, Instructions, 3, Motion>(group).run();
}

template <int W, class Instructions>
void run_group(TrialGroup& group) {
  if (group.forward_euler) return run_group_moving<W, Instructions, EulerOscillator>(group);
  run_group_moving<W, Instructions, Oscillator>(group);
}

}  // namespace beamid::filters::algorithms
