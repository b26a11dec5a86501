#include "experiments/identify/damping_law/slow_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/identify/record_inputs.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double slow_samples_per_period = 8.0, steps_per_period = 48.0;
constexpr Index fewest_slow_samples = 64;  // samples that must be left

}  // namespace

MatrixXd SlowRecord::measured(const MatrixXd& fine_columns) const {
  MatrixXd kept(fine_columns.rows(), samples.cols());
  for (Index k = 0; k < kept.cols(); ++k) kept.col(k) = fine_columns.col(k * steps);
  return kept;
}

SlowRecord slow_record(const filters::Measurements& record, Index inputs, double frequency_hz) {
  const Index all = record.size();
  const double dt = record.interval();
  SlowRecord slow;
  slow.factor = decimation_factor(1.0 / (slow_samples_per_period * frequency_hz * dt),
                                  all / (fewest_slow_samples + 10));
  slow.interval = slow.factor * dt;
  slow.samples = decimate_channels(record.outputs, slow.factor);
  const double start = slow.factor == 1 ? 0.0 : 5 * slow.interval;
  const Index m = slow.samples.cols();
  slow.time = record.time[0] + start +
              slow.interval * VectorXd::LinSpaced(m, 0.0, static_cast<double>(m - 1)).array();
  slow.steps = std::max(1, static_cast<int>(std::ceil(steps_per_period * frequency_hz * slow.interval)));
  const Index n = (m - 1) * slow.steps + 1;
  slow.fine.time =
      slow.interval / slow.steps * VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)).array();
  slow.fine.outputs.setConstant(slow.samples.rows(), n, std::numeric_limits<double>::quiet_NaN());
  for (Index k = 0; k < m; ++k) slow.fine.outputs.col(k * slow.steps) = slow.samples.col(k);
  if (record.inputs.size() == 0) return slow;
  slow.fine.inputs =
      filters::in_parts(decimated_inputs(record, inputs, slow.factor, slow.time), slow.steps).columns;
  return slow;
}

VectorXd noise_near(const MatrixXd& left, double interval, double frequency_hz, double fitted) {
  const Index m = left.cols();
  const double resolution = 1.0 / (interval * static_cast<double>(m));
  const auto from = std::max<Index>(1, static_cast<Index>(0.5 * frequency_hz / resolution)),
             to = std::min<Index>(m / 2 - 1, static_cast<Index>(std::ceil(1.5 * frequency_hz / resolution)));
  const auto lines = static_cast<double>(to - from + 1);
  VectorXd noise(left.rows());
  const Eigen::MatrixXcd found = lines_between(left.transpose(), from, std::max<Index>(0, to - from + 1));
  for (Index i = 0; i < left.rows(); ++i) {
    const double power = found.row(i).squaredNorm() / static_cast<double>(m);
    // Two numbers a line; a fit makes as many of them vanish as it has unknowns.
    const double dense = power / std::max(0.25 * lines, lines - 0.5 * fitted);
    const double whole = left.row(i).squaredNorm() / std::max(1.0, static_cast<double>(m) - fitted);
    noise[i] = std::sqrt(std::max(dense, whole));
  }
  return noise;
}

}  // namespace beamid::experiments
