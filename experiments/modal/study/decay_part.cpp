#include "experiments/modal/study/decay_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr Index fewest_decay_samples = 64;

Record part_of(const Record& record, Index begin, Index count) {
  Record part = record;
  part.time = record.time.segment(begin, count).eval();
  part.samples = record.samples.middleCols(begin, count).eval();
  return part;
}

}  // namespace

Record motion_of(const Record& record) {
  Record motion = record;
  motion.channels.clear();
  Index rows = 0;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    if (is_input(record.channels[i].quantity)) continue;
    motion.samples.row(rows++) = record.samples.row(i);
    motion.channels.push_back(record.channels[i]);
  }
  motion.samples.conservativeResize(rows, Eigen::NoChange);
  if (rows == 0)
    throw std::invalid_argument(
        "modal analysis needs a channel of motion or strain; the record has forces only");
  return motion;
}

Record complete_part(const Record& record, std::vector<std::string>& remarks) {
  if (record.samples.allFinite()) return record;
  Index begin = 0, longest = 0, missing = 0;
  for (Index k = 0, run = 0; k < record.size(); ++k) {
    const bool complete = record.samples.col(k).allFinite();
    run = complete ? run + 1 : 0;
    missing += !complete;
    if (run > longest) longest = run, begin = k + 1 - run;
  }
  if (longest < fewest_decay_samples)
    throw std::invalid_argument(
        fmt::format("{} of {} readings are missing or clipped, and the longest part without one, from {:.6g} "
                    "s, has {} samples; modal analysis expects {} at least",
                    missing, record.size(), record.time[std::min(begin, record.size() - 1)], longest,
                    fewest_decay_samples));
  remarks.push_back(fmt::format(
      "{} of {} readings are missing or clipped: the longest part without one is taken, {:.4g} to {:.4g} s.",
      missing, record.size(), record.time[begin], record.time[begin + longest - 1]));
  return part_of(record, begin, longest);
}

Record from_release(const Record& record, std::vector<std::string>& remarks) {
  const VectorXd size = record.samples.rowwise().norm().cwiseMax(1e-300);
  Index channel = 0, begin = 0;
  (size.cwiseInverse().asDiagonal() * record.samples).cwiseAbs().maxCoeff(&channel, &begin);
  if (begin == 0 || record.size() - begin < fewest_decay_samples) return record;
  remarks.push_back(fmt::format(
      "Window chosen automatically: the decay from the largest reading on, {:.4g} s.", record.time[begin]));
  return part_of(record, begin, record.size() - begin);
}

void check_intervals(const Record& record) {
  const Index steps = record.size() - 1;
  const VectorXd step = record.time.tail(steps) - record.time.head(steps);
  const double interval = record.interval();
  Index at = 0;
  const double worst = (step.array() - interval).abs().maxCoeff(&at);
  if (worst <= 0.2 * interval + 2 * record.time_resolution) return;
  throw std::invalid_argument(
      fmt::format("an interval of {:.6g} s after {:.6g} s; modal analysis expects equal intervals, {:.6g} s "
                  "within 20 % (a --window without the gap, or the record resampled)",
                  step[at], record.time[at], interval));
}

}  // namespace beamid::experiments
