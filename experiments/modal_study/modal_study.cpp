#include "experiments/modal_study/modal_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "experiments/modal_analysis/shape_fit.hpp"
#include "experiments/modal_study/decay_polish.hpp"
#include "experiments/modal_study/signal_band.hpp"
#include "experiments/signal/decimation.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Channels that move: forces are no response.
Record motion_of(const Record& record) {
  Record motion = record;
  motion.channels.clear();
  Index rows = 0;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    if (record.channels[i].quantity == Quantity::force) continue;
    motion.samples.row(rows++) = record.samples.row(i);
    motion.channels.push_back(record.channels[i]);
  }
  motion.samples.conservativeResize(rows, Eigen::NoChange);
  if (rows == 0)
    throw std::invalid_argument(
        "modal analysis needs a channel of motion or strain; the record has forces only");
  return motion;
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

/// From the largest reading on, relative to each channel's own size.
Record from_release(const Record& record, std::vector<std::string>& remarks) {
  const VectorXd size = record.samples.rowwise().norm().cwiseMax(1e-300);
  Index channel = 0, begin = 0;
  (size.cwiseInverse().asDiagonal() * record.samples).cwiseAbs().maxCoeff(&channel, &begin);
  if (begin == 0 || record.size() - begin < 64) return record;
  Record decay = record;
  decay.time = record.time.tail(record.size() - begin).eval();
  decay.samples = record.samples.rightCols(record.size() - begin).eval();
  remarks.push_back(fmt::format(
      "No window was given: the decay is taken from the largest reading on, {:.4g} s.", decay.time[0]));
  return decay;
}

/// Rows over the root mean square of all channels of their quantity.
VectorXd scales_of(const Record& record) {
  std::map<Quantity, std::pair<double, double>> squares;
  for (Index i = 0; i < record.samples.rows(); ++i) {
    auto& [sum, count] = squares[record.channels[i].quantity];
    sum += (record.samples.row(i).array() - record.samples.row(i).mean()).square().sum();
    count += static_cast<double>(record.size());
  }
  VectorXd scales(record.samples.rows());
  for (Index i = 0; i < scales.size(); ++i) {
    const auto& [sum, count] = squares[record.channels[i].quantity];
    scales[i] = sum > 0 ? std::sqrt(sum / count) : 1;
  }
  return scales;
}

/// Shapes in the channels' units: least squares of all modes to what they are to reproduce.
void add_shapes(const VectorXd& scales, RecordModes& found) {
  if (found.modes.empty()) return;
  std::vector<std::complex<double>> rates;
  for (const ModeEstimate& mode : found.modes) rates.push_back(mode.pole.rate);
  rates.emplace_back(0);
  std::vector<bool> oscillating(rates.size(), true);
  oscillating.back() = false;
  const ShapeFit fit = fit_shapes(found.target, found.interval, rates, oscillating);
  found.reproduced = fit.reconstruction;
  for (std::size_t m = 0; m < found.modes.size(); ++m) {
    Pole& pole = found.modes[m].pole;
    const Eigen::VectorXcd part = fit.shapes.col(static_cast<Index>(m));
    if (found.free_decay) {
      pole.shape = part;
    } else {  // an autocorrelation's part is the square of a root mean square; phases are the shape's
      Eigen::VectorXcd shape = scales.asDiagonal() * pole.shape;
      for (Index i = 0; i < shape.size(); ++i)
        shape[i] = std::polar(std::sqrt(std::max(0.0, part[i].real())), std::arg(shape[i]));
      pole.shape = shape;
    }
    double squares = 0;
    for (Index i = 0; i < part.size(); ++i)
      squares += found.free_decay ? std::norm(part[i] / scales[i])
                                  : std::pow(std::max(0.0, part[i].real()) / (scales[i] * scales[i]), 2);
    found.modes[m].strength = std::sqrt(squares);
  }
}

void leave_out_weak(const ModalStudySettings& settings, RecordModes& found) {
  double strongest = 0;
  for (const ModeEstimate& mode : found.modes) strongest = std::max(strongest, mode.strength);
  double floor = settings.smallest_amplitude * strongest;
  std::string why =
      fmt::format("amplitude below {:.2g} % of the strongest", 100 * settings.smallest_amplitude);
  if (settings.modes > 0 && static_cast<std::size_t>(settings.modes) < found.modes.size()) {
    std::vector<double> strengths;
    for (const ModeEstimate& mode : found.modes) strengths.push_back(mode.strength);
    std::sort(strengths.rbegin(), strengths.rend());
    if (strengths[settings.modes - 1] > floor) {
      floor = strengths[settings.modes - 1];
      why = fmt::format("weaker than the {} asked for", settings.modes);
    }
  }
  for (const ModeEstimate& mode : found.modes)
    if (mode.strength < floor) found.stabilisation.rejected.push_back({mode.pole, mode.orders, why});
  std::erase_if(found.modes, [&](const ModeEstimate& mode) { return mode.strength < floor; });
}

/// Those that stay where they are over the orders.
void choose_modes(StabilisationSettings settings, Index count, RecordModes& found) {
  settings.band_hz = found.band_hz;
  if (found.free_decay) settings.resolution_hz = 1 / (found.interval * static_cast<double>(count));
  found.stabilisation = stabilise(found.search.orders, settings);
  for (const PoleCluster& cluster : found.stabilisation.modes)
    found.modes.push_back({cluster.pole, cluster.orders});
}

/// Those that the method gives, and what it refused, within the band.
void take_modes(RecordModes& found) {
  const auto inside = [&](const Pole& pole) {
    return pole.frequency_hz() >= found.band_hz.first && pole.frequency_hz() <= found.band_hz.second;
  };
  for (const OrderPoles& order : found.search.orders)
    for (const Pole& pole : order.poles)
      if (inside(pole)) found.modes.push_back({pole, {}});
  for (const RefusedPole& refused : found.search.refused)
    if (inside(refused.pole)) found.stabilisation.rejected.push_back({refused.pole, {}, refused.reason});
  found.remarks.insert(found.remarks.end(), found.search.remarks.begin(), found.search.remarks.end());
}

/// A method for decays wants one, a method for random vibration a steady record.
void check_kind(const MatrixXd& samples, RecordModes& found) {
  const MatrixXd motion = samples.colwise() - samples.rowwise().mean();
  const Index half = motion.cols() / 2;
  const double early = motion.leftCols(half).squaredNorm(), late = motion.rightCols(half).squaredNorm();
  if (found.free_decay && late > 0.7 * early)
    found.warnings.push_back(
        "The record does not decay: its second half is nearly as strong as its first. For random vibration "
        "take --method ssi_cov; for a decay that comes later in the record, --window.");
  if (!found.free_decay && std::max(early, late) > 10 * std::min(early, late))
    found.warnings.push_back(
        "The record is not steady: one half is much stronger than the other. For a free decay take --method "
        "era; for random vibration, a --window without the strong part.");
}

}  // namespace

RecordModes find_modes(const std::string& name, const Record& record, bool windowed,
                       const ModalStudySettings& settings) {
  const auto& registry = modal_method_registry();
  RecordModes found;
  found.name = name;
  found.remarks = record.remarks;
  found.free_decay = registry.find(settings.method.name).contracts.contains(contract::free_decay);
  found.mode_by_mode = registry.find(settings.method.name).contracts.contains(contract::mode_by_mode);
  found.record = motion_of(record);
  if (found.free_decay && !windowed) found.record = from_release(found.record, found.remarks);
  check_intervals(found.record);
  const double interval = found.record.interval();
  found.band_hz = settings.band_hz ? *settings.band_hz : signal_band(found.record.samples, interval);
  check_band(found.band_hz, interval, found.record.size());

  constexpr double passed = 0.3;  // of the new sampling rate, untouched by the decimation
  const int factor = std::max(1, static_cast<int>(std::min(passed / (interval * found.band_hz.second),
                                                           static_cast<double>(found.record.size()) / 100)));
  MatrixXd samples;
  std::optional<DecimatedSignal> coarse;
  for (Index i = 0; i < found.record.samples.rows(); ++i) {
    coarse = decimate(found.record.samples.row(i).transpose(), interval, factor);
    if (i == 0) samples.resize(found.record.samples.rows(), coarse->samples.size());
    samples.row(i) = coarse->samples.transpose();
  }
  found.interval = coarse->interval;
  found.start = found.record.time[0] + coarse->start;
  const VectorXd scales = scales_of(found.record);

  const auto method = registry.make(settings.method.name, settings.method.options);
  found.search =
      method->search(scales.cwiseInverse().asDiagonal() * samples, found.interval, settings.largest_order);
  if (found.mode_by_mode)
    take_modes(found);
  else
    choose_modes(settings.stabilisation, samples.cols(), found);

  found.target = found.free_decay ? samples : MatrixXd(scales.cwiseAbs2().asDiagonal() * found.search.decays);
  add_shapes(scales, found);
  leave_out_weak(settings, found);
  if (settings.polish.value_or(found.free_decay && !found.mode_by_mode)) {
    if (!found.free_decay)
      throw std::invalid_argument("--polish fits a free decay; method " + settings.method.name +
                                  " takes the record for random vibration");
    polish(found, settings.stabilisation);
  }
  add_shapes(scales, found);
  check_kind(samples, found);
  if (found.free_decay) {
    for (ModeEstimate& mode : found.modes)  // back to the undecimated record and its beginning
      mode.pole.shape *= std::exp(-mode.pole.rate * coarse->start) / coarse->response(mode.pole.rate);
  }
  return found;
}

}  // namespace beamid::experiments
