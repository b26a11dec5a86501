#include "experiments/modal/study/record_kind.hpp"

#include <stdexcept>

#include "experiments/modal/hammer_response.hpp"
#include "experiments/signal/median.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// Share of a signal's samples that are farther from its median than a twentieth of the farthest.
double active_share(const VectorXd& signal) {
  constexpr double quiet = 0.05;
  const VectorXd size = (signal.array() - median(signal)).abs();
  return static_cast<double>((size.array() > quiet * size.maxCoeff()).count()) /
         static_cast<double>(size.size());
}

}  // namespace

bool is_struck(const Record& record) {
  constexpr double most_active = 0.2;
  constexpr std::size_t fewest_hits = 2;
  Index force = -1;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    const Quantity quantity = record.channels[static_cast<std::size_t>(i)].quantity;
    if (!is_input(quantity)) continue;
    if (quantity != Quantity::force || force >= 0) return false;
    force = i;
  }
  if (force < 0 || !record.samples.row(force).allFinite()) return false;
  const VectorXd signal = record.samples.row(force).transpose();
  if (active_share(signal) > most_active) return false;
  try {
    return find_hits(signal, record.interval()).size() >= fewest_hits;
  } catch (const std::invalid_argument&) {  // no hit
    return false;
  }
}

bool is_driven(const Record& record) {
  constexpr double least_active = 0.03;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    if (!is_input(record.channels[static_cast<std::size_t>(i)].quantity)) continue;
    const VectorXd signal = record.samples.row(i).transpose();
    if (signal.allFinite() && active_share(signal) > least_active) return true;
  }
  return false;
}

}  // namespace beamid::experiments
