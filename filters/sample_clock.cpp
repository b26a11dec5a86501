#include "filters/sample_clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace beamid::filters {
namespace {

template <class... Parts>
[[noreturn]] void refuse_sample_clock(const Parts&... parts) {
  std::ostringstream message;
  message.precision(15);
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

}  // namespace

SampleClock::SampleClock(double regular, double resolution) : regular_(regular), resolution_(resolution) {
  if (!(regular > 0.0 && std::isfinite(regular)))
    refuse_sample_clock("the regular interval is ", regular, " s; expected more than 0");
  if (!(resolution >= 0.0 && resolution < 0.5 * regular))
    refuse_sample_clock("the time resolution is ", resolution, " s; expected from 0 to half of the interval ",
                        regular, " s");
}

void SampleClock::start(double time) {
  if (!std::isfinite(time)) refuse_sample_clock("the time stamp is ", time, " s; expected a number");
  anchor_ = stamp_ = time;
  count_ = 0;
}

double SampleClock::advance(double time) {
  if (!std::isfinite(time)) refuse_sample_clock("the time stamp is ", time, " s; expected a number");
  if (!(time > stamp_))
    refuse_sample_clock("the time stamp is ", time, " s; expected more than the one before, ", stamp_);
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(time), 1e-9);
  if (std::abs(time - (instant() + regular_)) <= resolution_ + rounding + 1e-9 * regular_) {
    ++count_;
    stamp_ = time;
    return regular_;
  }
  const double interval = time - (instant() < time ? instant() : stamp_);
  start(time);
  return interval;
}

}  // namespace beamid::filters
