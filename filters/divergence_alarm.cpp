#include "filters/divergence_alarm.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>

namespace beamid::filters {

bool DivergenceAlarm::raised_by(double normalised_square, Eigen::Index outputs) {
  if (outputs == 0) return false;
  if (count_ == window) forget_oldest();
  squares_[next_] = normalised_square;
  outputs_[next_] = outputs;
  next_ = (next_ + 1) % window;
  ++count_;
  degrees_ += outputs;
  while (degrees_ - outputs_[oldest()] >= window) forget_oldest();
  unsettled_ += outputs;
  if (degrees_ < window) return false;

  if (in_bounds()) {
    in_bounds_ += outputs;
    if (in_bounds_ + window < settled) return false;
    set_ = true;
    raised_ = false;
    unsettled_ = 0;
    return false;
  }
  in_bounds_ = 0;
  if (raised_ || !(set_ || unsettled_ > patience)) return false;
  raised_ = true;
  set_ = false;
  unsettled_ = 0;
  return true;
}

void DivergenceAlarm::forget_oldest() {
  degrees_ -= outputs_[oldest()];
  squares_[oldest()] = 0.0;
  --count_;
}

bool DivergenceAlarm::in_bounds() {
  const auto place = static_cast<std::size_t>(degrees_ - window);
  if (place >= limits_.size()) limits_.resize(place + 1, 0.0);
  if (limits_[place] == 0.0)
    limits_[place] =
        quantile(complement(boost::math::chi_squared(static_cast<double>(degrees_)), probability));
  return squares_.sum() <= limits_[place];  // false of a NaN
}

}  // namespace beamid::filters
