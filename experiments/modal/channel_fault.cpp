#include "experiments/modal/channel_fault.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double much_less = 0.7, overdamped = 0.3;

std::optional<BaseResponse> response_if_any(const VectorXd& base, const VectorXd& response, double interval) {
  try {
    return base_response(base, response, interval, {});
  } catch (const std::invalid_argument&) {
    return {};
  }
}

double largest_swing(const VectorXd& signal) {
  return (signal.array() - signal.mean()).abs().maxCoeff();
}

}  // namespace

ChannelFault channel_fault(const VectorXd& base, const VectorXd& response, double interval) {
  const std::optional<BaseResponse> found = response_if_any(base, response, interval);
  ChannelFault best;
  double least = found ? found->left_percent : std::numeric_limits<double>::infinity();
  const double left = least;
  const auto consider = [&](ChannelFault::Kind kind, int samples, const std::optional<BaseResponse>& changed,
                            double share) {
    if (!changed || !(changed->left_percent < share * left) || !(changed->left_percent < least) ||
        !(changed->participation > 0.0) || changed->damping_ratio > overdamped)
      return;
    least = changed->left_percent;
    best = {kind, samples, *changed, left};
  };
  // The band is that of the same peak: neither change moves |Y| / |U|.
  const bool negative = found && found->participation < 0.0;
  consider(ChannelFault::Kind::reversed, 0, response_if_any(base, -response, interval),
           negative ? 1.0 : much_less);
  for (int late = -most_late_samples; late <= most_late_samples; ++late) {
    const Index n = base.size() - std::abs(late);
    if (late == 0 || n < 2) continue;
    const VectorXd &first = late > 0 ? base : response, &second = late > 0 ? response : base;
    const VectorXd head = first.head(n), tail = second.tail(n);
    consider(ChannelFault::Kind::late, late,
             late > 0 ? response_if_any(head, tail, interval) : response_if_any(tail, head, interval),
             much_less);
  }
  const bool too_damped = found && found->damping_ratio > overdamped;
  if (too_damped || largest_swing(response) < largest_swing(base))
    consider(ChannelFault::Kind::exchanged, 0, response_if_any(response, base, interval),
             too_damped ? 1.0 : much_less);
  return best;
}

}  // namespace beamid::experiments
