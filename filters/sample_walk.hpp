// A state on its way along a record.
#pragma once

#include "filters/discrete_model.hpp"
#include "filters/filter_run.hpp"
#include "filters/sample_clock.hpp"

namespace beamid::filters {

// A model's interval, given back.

/// While it lives, a model's interval may be changed; then it is what it was.
class IntervalKept {
 public:
  explicit IntervalKept(DiscreteModel& model) : model_(model), interval_(model.interval()) {}
  ~IntervalKept() {
    if (model_.interval() != interval_) model_.set_interval(interval_);
  }
  IntervalKept(const IntervalKept&) = delete;
  IntervalKept& operator=(const IntervalKept&) = delete;

 private:
  DiscreteModel& model_;
  double interval_;
};

/// Moves a state from stamp to stamp of a record's first samples, and calls `visit(k, state, input)` at each.
/// @param directions moved along as tangents of the state (n x r); none where it has no column
/// @param visit input is empty where the record has none
/// @throws as DiscreteModel::move() and SampleClock
template <typename Visit>
void walk_samples(DiscreteModel& model, const Measurements& record, Eigen::Index samples,
                  Eigen::VectorXd state, Eigen::MatrixXd& directions, Visit&& visit) {
  const IntervalKept kept(model);
  SampleClock clock(model.interval(), record.time_resolution);
  Eigen::VectorXd next, input;
  for (Eigen::Index k = 0; k < samples; ++k) {
    if (k == 0) {
      clock.start(record.time[0]);
    } else {
      model.set_interval(clock.advance(record.time[k]));
      if (directions.cols() > 0)
        model.move(state, input, next, directions);
      else
        model.transition(state, input, next);
      state.swap(next);
    }
    if (record.inputs.size() > 0) input = record.inputs.col(k);
    visit(k, state, input);
  }
}

}  // namespace beamid::filters
