#include "experiments/identify/bounds/identifiability.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/LU>

#include "experiments/config/readers.hpp"
#include "experiments/identify/bounds/described_motion.hpp"
#include "experiments/models/estimates.hpp"
#include "fem/assembly.hpp"
#include "filters/discrete_model.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::InformationFactor;

/// The information of all channels, every `stride`-th sample read. A channel's own offsets stand in its first
/// columns.
class ChannelReader {
 public:
  ChannelReader(const JointModel& model, Index channels, Index columns, double duration, Index stride)
      : stride_(stride), duration_(duration), drifts_(static_cast<std::size_t>(channels)) {
    for (const JointModel::Offset& offset : model.offsets)
      drifts_[static_cast<std::size_t>(offset.channel)].push_back(offset.drift);
    for (const auto& own : drifts_) factors_.emplace_back(static_cast<Index>(own.size()) + columns);
  }

  Index stride() const { return stride_; }

  /// @param rows sensitivities to start and unknowns at this sample (p x (2k + q)).
  void add(Index sample, double time, const MatrixXd& rows) {
    if (sample % stride_ != 0) return;
    for (std::size_t i = 0; i < factors_.size(); ++i) {
      const auto own = static_cast<Index>(drifts_[i].size());
      MatrixXd row(1, own + rows.cols());
      for (Index j = 0; j < own; ++j)
        row(0, j) = drifts_[i][static_cast<std::size_t>(j)] ? time / duration_ : 1.0;
      row.rightCols(rows.cols()) = rows.row(static_cast<Index>(i));
      factors_[i].add(row);
    }
  }

  ChannelInformation so_far(Index start) const {
    ChannelInformation result{start, {}};
    for (std::size_t i = 0; i < factors_.size(); ++i) {
      std::vector<Index> own;
      for (std::size_t j = 0; j < drifts_[i].size(); ++j) own.push_back(static_cast<Index>(j));
      result.channels.push_back(factors_[i].without(own));
    }
    return result;
  }

 private:
  Index stride_;
  double duration_;
  std::vector<std::vector<bool>> drifts_;  // a channel's offsets: whether they grow with time
  std::vector<InformationFactor> factors_;
};

Index longest_memory(const ObservedMotion& motion, const std::vector<Reading>& readings) {
  Index samples = 0;
  for (const Reading& reading : readings) {
    if (reading.samples < 1 || reading.stride < 1)
      throw std::invalid_argument(fmt::format("a reading of {} samples, every {}th; expected at least 1",
                                              reading.samples, reading.stride));
    samples = std::max(samples, reading.samples);
  }
  if (motion.inputs.size() > 0 && motion.inputs.cols() < samples)
    throw std::invalid_argument(
        fmt::format("inputs at {} samples; expected {}", motion.inputs.cols(), samples));
  return samples;
}

}  // namespace

std::vector<ChannelInformation> channel_information(const ObservedMotion& motion,
                                                    const std::vector<Reading>& readings) {
  const JointModel& model = motion.model;
  const Index samples = longest_memory(motion, readings), start = 2 * model.mode_shapes.cols();
  const auto channels = static_cast<Index>(model.motion->output_labels().size());
  const auto discrete = filters::discretise(model.motion, motion.interval, motion.discretisation,
                                            {{}, MatrixXd::Identity(channels, channels)});

  MatrixXd moved(motion.initial_state.size(), start + motion.directions.unknowns.cols());
  moved << motion.directions.motion.leftCols(start), motion.directions.unknowns;
  const double duration = static_cast<double>(samples) * motion.interval;
  std::vector<ChannelReader> readers;
  for (const Reading& reading : readings)
    if (std::none_of(readers.begin(), readers.end(),
                     [&](const ChannelReader& reader) { return reader.stride() == reading.stride; }))
      readers.emplace_back(model, channels, moved.cols(), duration, reading.stride);

  std::vector<ChannelInformation> result(readings.size());
  VectorXd state = motion.initial_state, next, input = VectorXd::Zero(model.motion->input_size());
  MatrixXd sensor, rows;
  for (Index step = 0; step < samples; ++step) {
    if (motion.inputs.size() > 0) input = motion.inputs.col(step);
    const double time = static_cast<double>(step) * motion.interval;
    discrete->output_jacobian(state, input, sensor);
    rows.noalias() = sensor * moved;
    if (!rows.allFinite())
      throw std::runtime_error(fmt::format("the motion grows beyond all bounds at {:g} s", time));
    for (ChannelReader& reader : readers) reader.add(step, time, rows);
    for (std::size_t i = 0; i < readings.size(); ++i)
      if (readings[i].samples == step + 1)
        for (const ChannelReader& reader : readers)
          if (reader.stride() == readings[i].stride) result[i] = reader.so_far(start);
    if (step + 1 == samples) break;
    discrete->move(state, input, next, moved);
    state.swap(next);
  }
  return result;
}

namespace {

using filters::InformationFactor;

// Modes that no sensor shows have sensitivities of rounding alone, which would pass for unknowns to
// eliminate.
MatrixXd without_rounding(MatrixXd root, Index start) {
  constexpr double rounding = 1e-11;
  const double largest = root.leftCols(start).colwise().norm().maxCoeff();
  for (Index i = 0; i < start; ++i)
    if (root.col(i).norm() < rounding * largest) root.col(i).setZero();
  return root;
}

ParameterBound::Verdict verdict(const ParameterBound& bound, const filters::InformationReport& report,
                                Index i) {
  using Verdict = ParameterBound::Verdict;
  if (report.determined(i)) return bound.bound < bound.size ? Verdict::determined : Verdict::poor;
  const double silent = report.undetermined().row(i).norm();
  return silent > 1.0 - filters::negligible_entry ? Verdict::nothing : Verdict::combination;
}

}  // namespace

const char* to_string(ParameterBound::Verdict verdict) {
  switch (verdict) {
    case ParameterBound::Verdict::determined:
      return "determined";
    case ParameterBound::Verdict::poor:
      return "not in practice";
    case ParameterBound::Verdict::combination:
      return "in combination";
    case ParameterBound::Verdict::nothing:
      return "not at all";
  }
  return "";
}

std::vector<UnknownSize> unknown_sizes(const ObservedMotion& motion) {
  std::vector<UnknownSize> sizes;
  for (std::size_t j = 0; j < motion.model.unknowns.size(); ++j) {
    const Unknown& unknown = motion.model.unknowns[j];
    const Index place = motion.model.unknown_places[j];
    const double state = motion.initial_state[place];
    UnknownSize size{unknown.to_physical(state), 0.0, true, 0.0};
    size.of_value = size.value != 0.0;
    size.size = size.of_value ? std::abs(size.value) : unknown.deviation;
    const double direction = motion.directions.unknowns(place, static_cast<Index>(j));
    size.per_direction = std::abs(unknown.slope(state) * direction) / size.size;
    if (!(size.per_direction > 0.0 && std::isfinite(size.per_direction)))
      throw std::invalid_argument(fmt::format(
          "{} has the standard deviation {:g}; expected a positive number", unknown.name, unknown.deviation));
    sizes.push_back(size);
  }
  return sizes;
}

InformationFactor information_about_unknowns(const ObservedMotion& motion,
                                             const ChannelInformation& information,
                                             const std::vector<NoisyChannel>& channels) {
  const std::vector<UnknownSize> sizes = unknown_sizes(motion);
  const Index start = information.start, q = static_cast<Index>(sizes.size());
  InformationFactor together(start + q);
  for (const NoisyChannel& read : channels) {
    if (!(read.deviation > 0.0 && std::isfinite(read.deviation)))
      throw std::invalid_argument(fmt::format("the noise of channel {} is {:g}; expected a positive number",
                                              read.channel + 1, read.deviation));
    together.add(information.channels[static_cast<std::size_t>(read.channel)].root() / read.deviation);
  }
  InformationFactor clean(start + q);
  clean.add(without_rounding(together.root(), start));
  std::vector<Index> nuisances;
  for (Index i = 0; i < start; ++i) nuisances.push_back(i);

  MatrixXd root = clean.without(nuisances).root();
  for (Index j = 0; j < q; ++j) root.col(j) /= sizes[static_cast<std::size_t>(j)].per_direction;
  InformationFactor result(q);
  result.add(root);
  for (Index j = 0; j < q; ++j) {
    const Unknown& unknown = motion.model.unknowns[static_cast<std::size_t>(j)];
    if (!unknown.nuisance) continue;
    MatrixXd known = MatrixXd::Zero(1, q);
    known(0, j) = sizes[static_cast<std::size_t>(j)].size / unknown.deviation;
    result.add(known);
  }
  return result;
}

VectorXd relative_bounds(const InformationFactor& information) {
  return filters::determined_combinations(information, VectorXd::Ones(information.unknowns())).bounds;
}

std::vector<ParameterBound> parameter_bounds(const ObservedMotion& motion,
                                             const filters::InformationReport& report) {
  const std::vector<UnknownSize> sizes = unknown_sizes(motion);
  std::vector<ParameterBound> result;
  for (std::size_t j = 0; j < sizes.size(); ++j) {
    const Unknown& unknown = motion.model.unknowns[j];
    const auto i = static_cast<Index>(j);
    ParameterBound bound;
    bound.name = unknown.name;
    bound.unit = unknown.unit;
    bound.value = sizes[j].value;
    bound.size = sizes[j].size;
    bound.of_value = sizes[j].of_value;
    bound.bound = report.bounds[i] * bound.size;
    bound.conditional_bound = report.conditional_bounds[i] * bound.size;
    bound.nuisance = unknown.nuisance;
    bound.prior_deviation = unknown.deviation;
    bound.verdict = verdict(bound, report, i);
    if (bound.verdict == ParameterBound::Verdict::nothing)
      bound.conditional_bound = std::numeric_limits<double>::infinity();
    const double state = motion.initial_state[motion.model.unknown_places[j]];
    const double reach = quantile_95 * bound.bound / std::abs(unknown.slope(state));
    bound.lower_95 = unknown.to_physical(state - reach);
    bound.upper_95 = unknown.to_physical(state + reach);
    result.push_back(bound);
  }
  return result;
}

namespace {

constexpr double usual_test_ratio = 0.005;  // of every mode, where neither damping nor a dashpot is described
constexpr Index fewest_test_samples = 16;   // of a record
constexpr double usual_noise = 0.01;        // of the root mean square of what a sensor shows

bool has_dashpots(const Experiment& experiment) {
  return fem::assemble(experiment.structure, experiment.elements).damping.nonZeros() > 0;
}

/// The experiment with all that it leaves open.
Experiment completed(const Experiment& experiment, std::vector<std::string>& notes) {
  Experiment complete = experiment;
  if (std::holds_alternative<fem::Undamped>(complete.damping) && !has_dashpots(experiment)) {
    complete.damping = fem::ModalDamping{{usual_test_ratio}};
    notes.push_back(
        fmt::format("No [damping] is described: every mode has the ratio {:g} %.", 100.0 * usual_test_ratio));
  }
  if (complete.sensors.empty()) {
    complete.sensors = {Sensor{}};
    notes.emplace_back("No [[sensors]] are described: one accelerometer where the beam moves most easily.");
  }
  return complete;
}

/// The channels that show any motion, with their noises.
std::vector<NoisyChannel> noisy_channels(const Experiment& experiment, const DescribedMotion& described,
                                         Identifiability& result) {
  std::vector<NoisyChannel> channels;
  std::string assumed;
  for (std::size_t i = 0; i < described.sensors.size(); ++i) {
    Sensor sensor = described.sensors[i];
    sensor.noise = experiment.sensors[i].noise;
    const auto general = experiment.noise.find(sensor.quantity);
    if (sensor.noise == 0.0 && general != experiment.noise.end()) sensor.noise = general->second;
    const double shown = described.root_mean_squares[static_cast<Index>(i)];
    const bool silent = shown == 0.0, assume = sensor.noise == 0.0 && !silent;
    if (assume) {
      sensor.noise = usual_noise * shown;
      assumed += (assumed.empty() ? "" : ", ") + sensor.name;
    }
    if (silent)
      result.notes.push_back(sensor.name + " shows no motion at all and is excluded.");
    else
      channels.push_back({static_cast<Index>(i), sensor.noise});
    result.sensors.push_back({sensor, assume});
  }
  if (channels.empty()) throw std::invalid_argument("no sensor shows any motion; expected one that does");
  if (!assumed.empty())
    result.notes.push_back(fmt::format("Assumed noise, {:g} % of the root mean square of the reading: {}.",
                                       100.0 * usual_noise, assumed));
  return channels;
}

/// What is known of the test before any information is.
void describe_test(const Experiment& complete, const DescribedMotion& test, Index samples,
                   Identifiability& result) {
  const JointModel& model = test.motion.model;
  const double rate = complete.simulation.sampling_rate;
  result.model = complete.model.name;
  result.reduction = to_text(complete.reduction);
  result.coordinates = model.motion_size();
  for (const double omega : model.mode_frequencies)
    if (omega > 0.0) result.frequencies_hz.push_back(omega / (2.0 * std::numbers::pi));
  if (result.frequencies_hz.empty())
    throw std::invalid_argument("the model has no mode that vibrates; expected at least one");
  const double first = 2.0 * std::numbers::pi * result.frequencies_hz.front();
  const double ratio = fem::damping_ratios(complete.damping, VectorXd::Constant(1, first))[0];
  result.slowest_decay = ratio > 0.0 ? 1.0 / (ratio * first) : 0.0;
  result.force_measured = test.motion.inputs.size() > 0;
  result.inputs = test.inputs;
  result.begin = test.begin;
  result.sampling_rate = rate;
  const Index left = samples - static_cast<Index>(std::llround(test.begin * rate));
  if (left < fewest_test_samples)
    throw InputError(complete.excitation.place,
                     "the force acts until the record ends; a record without it shows no motion");
  result.duration = static_cast<double>(left - 1) / rate;
  const auto shown = std::count_if(result.frequencies_hz.begin(), result.frequencies_hz.end(),
                                   [&](double frequency) { return frequency < 0.5 * rate; });
  if (shown < static_cast<std::ptrdiff_t>(result.frequencies_hz.size()))
    result.notes.push_back(fmt::format(
        "Only {} of {} modes lie below {:g} Hz, half the sampling rate; the record shows the others at other "
        "frequencies.",
        shown, result.frequencies_hz.size(), 0.5 * rate));
}

}  // namespace

MatrixXd silent_combinations(const filters::InformationReport& report) {
  constexpr double rounding = 1e-6;
  MatrixXd rows = report.undetermined().transpose();
  for (Index k = 0; k < rows.rows(); ++k) {  // Gauss-Jordan with complete pivoting
    Index row = 0, column = 0;
    rows.bottomRows(rows.rows() - k).cwiseAbs().maxCoeff(&row, &column);
    rows.row(k).swap(rows.row(k + row));
    rows.row(k) /= rows(k, column);
    for (Index i = 0; i < rows.rows(); ++i)
      if (i != k) rows.row(i) -= rows(i, column) * rows.row(k);
  }
  for (auto row : rows.rowwise()) {
    Index largest = 0;
    row.cwiseAbs().maxCoeff(&largest);
    row /= double(row[largest]);
  }
  return (rows.array().abs() < rounding).select(0.0, rows).transpose();
}

Identifiability find_identifiability(const Experiment& experiment, const std::filesystem::path& folder,
                                     const Progress& progress) {
  const IdentifiabilitySettings& settings = experiment.identifiability;
  Identifiability result;
  const Experiment complete = completed(experiment, result.notes);
  const double rate = complete.simulation.sampling_rate;
  constexpr double most_samples = 1e6;
  if (!(complete.simulation.duration * rate < most_samples))
    throw std::invalid_argument(
        fmt::format("a record of {:g} s at {:g} Hz has {:.3g} samples; expected at most {:g}: set "
                    "simulation.duration_s or "
                    "simulation.sampling_rate_hz, or check that the beam is described in SI units",
                    complete.simulation.duration, rate, complete.simulation.duration * rate, most_samples));
  const auto samples = static_cast<Index>(std::llround(complete.simulation.duration * rate)) + 1;

  progress("the test as described");
  TestView view{complete.sensors, longest_record * (samples - 1) + 1, complete.simulation.duration,
                settings.force_measured};
  const DescribedMotion test = described_motion(complete, folder, view, progress);
  describe_test(complete, test, samples, result);
  const std::vector<NoisyChannel> channels = noisy_channels(complete, test, result);
  progress("record lengths and sampling rates");
  sweep_in_time(test.motion, channels, result);
  progress("places of sensors");
  if (complete.model.name == "sdof")
    result.notes.emplace_back("The model has one point only: places of sensors make no difference to it.");
  else
    sweep_in_place(complete, folder, channels, result, progress);
  return result;
}

}  // namespace beamid::experiments
