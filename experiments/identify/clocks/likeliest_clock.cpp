#include "experiments/identify/clocks/likeliest_clock.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <unsupported/Eigen/FFT>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/interpolation.hpp"
#include "filters/fisher_information.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

bool goes_by(const Channel& channel, const std::string& name) {
  return name == channel.name || name == to_string(channel.quantity);
}

bool is_named(const Record& record, const Channel& channel) {
  return std::any_of(record.own_clock.begin(), record.own_clock.end(),
                     [&](const std::string& name) { return goes_by(channel, name); });
}

// Of the samples that are there, about their mean, in units of their rms; 0 elsewhere.
VectorXd of_unit_size(const VectorXd& row) {
  const auto read = row.array().isFinite();
  const double mean =
      read.select(row.array(), 0.0).sum() / static_cast<double>(std::max<Index>(read.count(), 1));
  VectorXd centred = read.select(row.array() - mean, 0.0);
  const double size = centred.norm();
  return size > 0.0 ? VectorXd(centred / size) : centred;
}

VectorXd padded(const VectorXd& signal) {
  VectorXd result = VectorXd::Zero(2 * signal.size());
  result.head(signal.size()) = signal;
  return result;
}

// Where a parabola through three values at -1, 0, 1 is largest.
double summit(double before, double at, double after) {
  const double bend = before - 2.0 * at + after;
  return bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
}

}  // namespace

std::vector<OwnClock> own_clocks(const Record& record) {
  const std::vector<Index> outputs = output_channels(record), inputs = input_channels(record);
  std::string known;
  for (const Channel& channel : record.channels) known += (known.empty() ? "" : ", ") + channel.name;
  for (const std::string& name : record.own_clock)
    if (std::none_of(record.channels.begin(), record.channels.end(),
                     [&](const Channel& channel) { return goes_by(channel, name); }))
      throw std::invalid_argument(
          fmt::format("own_clock names no channel '{}'; the record has: {}", name, known));
  if (!evenly_sampled(record))
    throw std::invalid_argument(
        "own_clock of a record at unequal intervals; expected even stamps, or the step resample first");
  std::vector<OwnClock> clocks;
  for (const Index channel : inputs)
    if (is_named(record, record.channels[static_cast<std::size_t>(channel)])) {
      clocks.push_back({channel, true, {}});
      for (std::size_t i = 0; i < outputs.size(); ++i) clocks.back().outputs.push_back(static_cast<Index>(i));
    }
  if (!clocks.empty() && inputs.size() > 1)
    throw std::invalid_argument(
        "own_clock names one of several inputs, whose lags the motion does not distinguish; expected "
        "channels "
        "of motion, or a record of one input");
  std::size_t common = outputs.size();
  for (std::size_t i = 0; i < outputs.size(); ++i)
    if (is_named(record, record.channels[static_cast<std::size_t>(outputs[i])])) {
      clocks.push_back({outputs[i], false, {static_cast<Index>(i)}});
      --common;
    }
  if (common == 0)
    throw std::invalid_argument(
        "own_clock names every channel of motion; expected one at least that keeps the common clock, or the "
        "input's name where that alone has another");
  return clocks;
}

Record with_common_clock(const Record& as_read, const std::vector<OwnClock>& clocks) {
  Record record = as_read;
  VectorXd known = VectorXd::Zero(record.size());  // NaN where an input is not
  for (const OwnClock& clock : clocks) {
    record.samples.row(clock.channel) =
        shifted(record.time, as_read.samples.row(clock.channel).transpose(), clock.lag).transpose();
    if (clock.input) known += record.samples.row(clock.channel).transpose();
  }
  const auto is_known = known.array().isFinite();
  if (is_known.all()) return record;
  Index first = 0, last = record.size() - 1;
  while (first < last && !is_known[first]) ++first;
  while (first < last && !is_known[last]) --last;
  return record.window(record.time[first], record.time[last]);
}

double lag_by_correlation(const MatrixXd& read, const MatrixXd& made, double interval, double whitened) {
  using Complex = std::complex<double>;
  const Index count = read.cols(), most = count / 4;
  Eigen::FFT<double> fft;
  Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(2 * count), one, other;
  for (Index i = 0; i < read.rows(); ++i) {
    fft.fwd(one, padded(of_unit_size(read.row(i).transpose())));
    fft.fwd(other, padded(of_unit_size(made.row(i).transpose())));
    const Eigen::ArrayXcd product = one.array() * other.array().conjugate();
    const Eigen::ArrayXd size = product.abs();
    sum.array() += (size > 1e-6 * size.maxCoeff()).select(product / size.pow(whitened), 0.0);
  }
  Eigen::VectorXcd correlation;
  fft.inv(correlation, sum);
  const auto at = [&](Index lag) { return Complex(correlation[(lag + 2 * count) % (2 * count)]).real(); };
  Index best = 0;
  for (Index lag = -most; lag <= most; ++lag)
    if (at(lag) > at(best)) best = lag;
  return interval * (static_cast<double>(best) + summit(at(best - 1), at(best), at(best + 1)));
}

namespace {

// y'(t) of every row, by its spline.
MatrixXd slopes(const VectorXd& time, const MatrixXd& outputs) {
  const double aside = 0.05 * (time[time.size() - 1] - time[0]) / static_cast<double>(time.size() - 1);
  MatrixXd result(outputs.rows(), outputs.cols());
  for (Index i = 0; i < outputs.rows(); ++i) {
    const CubicSpline motion(time, outputs.row(i).transpose());
    result.row(i) =
        ((motion(VectorXd(time.array() + aside)) - motion(VectorXd(time.array() - aside))) / (2.0 * aside))
            .transpose();
  }
  return result;
}

}  // namespace

MatrixXd clock_information(filters::DiscreteModel& discrete, const VectorXd& initial_state,
                           const StartDirections& directions, const filters::Measurements& record,
                           const MatrixXd& outputs, const std::vector<OwnClock>& clocks, bool grow) {
  const MatrixXd all = directions.all(), moving = slopes(record.time, outputs);
  const auto g = static_cast<Index>(clocks.size());
  const Index starts = directions.motion.cols(), q = directions.unknowns.cols(),
              columns = starts + q + (grow ? 2 : 1) * g + 1;
  const Eigen::LLT<MatrixXd> noise(discrete.output_noise());
  filters::InformationFactor factor(columns);
  MatrixXd moved = all, sensor, rows(outputs.rows(), columns);
  VectorXd state = initial_state, next, input;
  for (Index k = 0; k < outputs.cols(); ++k) {
    if (record.inputs.size() > 0) input = record.inputs.col(k);
    discrete.output_jacobian(state, input, sensor);
    rows.setZero();
    rows.leftCols(starts + q).noalias() = sensor * moved;
    for (Index j = 0; j < g; ++j) {
      const OwnClock& clock = clocks[static_cast<std::size_t>(j)];
      for (const Index i : clock.outputs) rows(i, starts + q + j) = (clock.input ? 1.0 : -1.0) * moving(i, k);
    }
    if (grow)
      rows.middleCols(starts + q + g, g) = (record.time[k] - record.time[0]) * rows.middleCols(starts + q, g);
    rows.rightCols<1>() = record.outputs.col(k) - outputs.col(k);
    for (Index i = 0; i < rows.rows(); ++i)
      if (!std::isfinite(record.outputs(i, k))) rows.row(i).setZero();
    factor.add(noise.matrixL().solve(rows));
    if (k + 1 == outputs.cols()) break;
    discrete.move(state, input, next, moved);
    state.swap(next);
  }
  factor.add(MatrixXd::Identity(columns, columns).middleRows(starts, q));
  std::vector<Index> start(static_cast<std::size_t>(starts));
  std::iota(start.begin(), start.end(), Index{0});
  return factor.without(start).information();
}

ClockStep clock_step(const MatrixXd& information, Index clocks) {
  const Index g = clocks, q = information.rows() - g - 1;
  // To a unit diagonal: seconds beside shares of deviations.
  const VectorXd scale = information.diagonal().head(q + g).cwiseSqrt();
  if (!(scale.tail(g).array() > 0.0).all())
    throw std::runtime_error("a channel with a clock of its own does not move: its lag cannot be determined");
  const MatrixXd scaled = scale.cwiseInverse().asDiagonal() * information.topLeftCorner(q + g, q + g) *
                          scale.cwiseInverse().asDiagonal();
  const MatrixXd covariance = Eigen::LDLT<MatrixXd>(scaled).solve(MatrixXd::Identity(q + g, q + g));
  const MatrixXd known = Eigen::LDLT<MatrixXd>(scaled.topLeftCorner(q, q)).solve(MatrixXd::Identity(q, q));
  const VectorXd right = information.col(q + g).head(q + g).cwiseQuotient(scale);
  const VectorXd with = covariance * right, without = known * right.head(q);
  ClockStep step;
  step.lag = with.tail(g).cwiseQuotient(scale.tail(g));
  step.deviation = covariance.diagonal().tail(g).cwiseMax(0.0).cwiseSqrt().cwiseQuotient(scale.tail(g));
  step.widening = (covariance.diagonal().head(q).array() / known.diagonal().array()).max(1.0).sqrt();
  step.shift = (with.head(q) - without).cwiseQuotient(known.diagonal().cwiseSqrt());
  const double all = information(q + g, q + g), left = all - right.dot(with),
               before = all - right.head(q).dot(without);
  if (before > 0.0) step.left_share = std::clamp(left / before, 0.0, 1.0);
  return step;
}

namespace {

// W^T W of the unknowns (q), of lags and of growths (terms x p) and of what is left, where the clocks of the
// members are one, and the others right: of the unknowns, of one lag and, of two terms, its growth.
MatrixXd with_one_clock(const MatrixXd& information, const VectorXd& members, Index terms) {
  const Index p = members.size(), last = information.rows() - 1, q = last - 2 * p;
  MatrixXd kept = MatrixXd::Zero(last + 1, q + terms + 1);
  kept.topLeftCorner(q, q).setIdentity();
  for (Index term = 0; term < terms; ++term) kept.col(q + term).segment(q + term * p, p) = members;
  kept(last, q + terms) = 1.0;
  return kept.transpose() * information * kept;
}

}  // namespace

double LikeliestClock::deviation(Index i) const {
  return std::sqrt(step.left_share) * step.deviation[i];
}

LikeliestClocks likeliest_clocks(filters::DiscreteModel& discrete, const VectorXd& initial_state,
                                 const StartDirections& directions, const filters::Measurements& record,
                                 const MatrixXd& outputs) {
  const Index p = outputs.rows();
  std::vector<OwnClock> clocks;
  for (Index i = 0; i < p; ++i) clocks.push_back({i, false, {i}});
  const MatrixXd information =
      clock_information(discrete, initial_state, directions, record, outputs, clocks, true);
  LikeliestClocks best;
  if (!information.allFinite()) return best;
  const auto try_clock = [&](std::optional<Index> output, const VectorXd& members, Index terms,
                             std::optional<LikeliestClock>& likeliest) {
    try {
      LikeliestClock found{output, clock_step(with_one_clock(information, members, terms), terms)};
      const bool is_determined = found.step.lag.allFinite() && (found.step.deviation.array() > 0.0).all();
      if (is_determined && (!likeliest || found.step.left_share < likeliest->step.left_share))
        likeliest = found;
    } catch (const std::runtime_error&) {  // outputs that do not move
    }
  };
  const auto try_both = [&](std::optional<Index> output, const VectorXd& members) {
    try_clock(output, members, 1, best.late);
    try_clock(output, members, 2, best.drifting);
  };
  if (record.inputs.size() > 0) try_both({}, VectorXd::Ones(p));
  for (Index i = 0; i < p && p > 1; ++i) try_both(i, VectorXd::Unit(p, i));
  return best;
}

}  // namespace beamid::experiments
