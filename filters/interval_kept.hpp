// A model's interval, given back.
#pragma once

#include "filters/discrete_model.hpp"

namespace beamid::filters {

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

}  // namespace beamid::filters
