#include "experiments/identify/clocks/own_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

#include "experiments/identify/model_setting.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/shifted.hpp"

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
        "own_clock names one of several inputs, whose lags the motion does not tell apart; expected channels "
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

}  // namespace beamid::experiments
