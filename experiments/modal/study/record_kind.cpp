#include "experiments/modal/study/record_kind.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/modal/hammer_response.hpp"
#include "experiments/signal/median.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

bool is_struck(const Record& record) {
  constexpr double rests = 0.8, quiet = 0.05;
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
  const VectorXd size = (signal.array() - median(signal)).abs();
  const auto small = (size.array() < quiet * size.maxCoeff()).count();
  if (static_cast<double>(small) < rests * static_cast<double>(size.size())) return false;
  try {
    return find_hits(signal, record.interval()).size() >= fewest_hits;
  } catch (const std::invalid_argument&) {  // no hit
    return false;
  }
}

bool is_driven(const Record& record) {
  constexpr double quiet = 0.05, least = 0.03;  // of the largest; of the samples
  for (Index i = 0; i < record.samples.rows(); ++i) {
    if (!is_input(record.channels[static_cast<std::size_t>(i)].quantity)) continue;
    const VectorXd signal = record.samples.row(i).transpose();
    if (!signal.allFinite()) continue;
    const VectorXd size = (signal.array() - median(signal)).abs();
    const auto moving = (size.array() > quiet * size.maxCoeff()).count();
    if (static_cast<double>(moving) > least * static_cast<double>(size.size())) return true;
  }
  return false;
}

}  // namespace beamid::experiments
