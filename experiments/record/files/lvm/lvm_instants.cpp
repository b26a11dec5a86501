#include "experiments/record/files/lvm/lvm_instants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace beamid::experiments {

void LvmInstants::add(const LvmSegment& segment, std::size_t rows, std::optional<double> seconds) {
  if (rows == 0 || !seconds || segment.intervals.empty() || !(segment.intervals[0] > 0)) return;
  for (const auto* values : {&segment.starts, &segment.intervals})
    if (std::any_of(values->begin(), values->end(), [&](double value) { return value != values->front(); }))
      throw InputError(segment.place, "channels of different X0 or Delta_X; expected the same for all");
  const Clock clock{*seconds * (segment.starts.empty() ? 0.0 : segment.starts[0]),
                    *seconds * segment.intervals[0]};
  if (!first_) first_ = clock;
  one_interval_ = one_interval_ && std::abs(clock.interval / first_->interval - 1) < 1e-9;
  if (!times_.empty() && clock.start < times_.back() + 0.5 * clock.interval)
    throw InputError(segment.place,
                     fmt::format("a segment that begins at {:g} s, where the one before runs to {:g} s; "
                                 "expected segments in succession",
                                 clock.start, times_.back()));
  for (std::size_t k = 0; k < rows; ++k)
    times_.push_back(clock.start + static_cast<double>(k) * clock.interval);
}

std::optional<Clock> LvmInstants::clock() const {
  if (times_.empty() || !one_interval_) return std::nullopt;
  // Where a segment begins late all that follow do.
  const double last = first_->start + static_cast<double>(times_.size() - 1) * first_->interval;
  return std::abs(times_.back() - last) <= 0.5 * first_->interval ? first_ : std::nullopt;
}

}  // namespace beamid::experiments
