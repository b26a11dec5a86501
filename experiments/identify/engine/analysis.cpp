#include "experiments/identify/engine/analysis.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <unsupported/Eigen/FFT>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/noise_near_mode.hpp"
#include "experiments/modal/mode_by_mode.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/decimation.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {
namespace {

// Largest line of what the mode leaves of the first channel above twice its frequency, as the deviation of
// white noise whose mean line is as high. No window: what a decay begins with is what does harm.
double largest_line(const Record& record, const ModalEstimate& modal) {
  const Eigen::MatrixXd first = record.samples.row(0);
  const ShapeFit fit = fit_shapes(first, record.interval(), {modal.rate(), 0.0}, {true, false});
  const auto count = static_cast<std::size_t>(record.size()), length = std::bit_ceil(count);
  std::vector<double> left(length, 0.0);
  Eigen::Map<Eigen::RowVectorXd>(left.data(), record.size()) = first - fit.reconstruction;
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> lines;
  transform.fwd(lines, left);
  const double from = 2 * modal.frequency_hz * record.interval() * static_cast<double>(length);
  double largest = 0;
  for (auto k = static_cast<std::size_t>(from) + 1; k < lines.size(); ++k)
    largest = std::max(largest, std::norm(lines[k]));
  return std::sqrt(largest / static_cast<double>(count));
}

}  // namespace

std::optional<Choice> step_against_higher_modes(const Experiment& experiment, const Record& record) {
  constexpr double too_large = 6, samples_per_cycle = 8;
  constexpr Eigen::Index enough = 50;  // samples to be left, as the modal analysis wants them
  const RecordAnalysis found = analyse_mode(experiment, record);
  if (!found.modal_refusal.empty()) throw std::invalid_argument(found.modal_refusal);
  if (!found.modal ||
      !(largest_line(found.even.record, *found.modal) > too_large * found.near_mode->deviation))
    return {};
  const int factor = decimation_factor(
      1 / (samples_per_cycle * found.modal->frequency_hz * record.interval()), record.size() / enough);
  constexpr int least = 2, most = 1000;  // of the step
  if (factor < least || factor > most) return {};
  filters::Options options;
  options.set("factor", static_cast<double>(factor));
  return Choice{"decimate", step_registry().completed("decimate", options)};
}

RecordedFrequency recorded_frequency(const Eigen::VectorXd& output, const Eigen::MatrixXd& inputs,
                                     double interval, double expected_hz) {
  try {
    if (inputs.rows() > 0) return {forced_mode(output, inputs, interval, expected_hz).frequency_hz, ""};
    ModalAnalysisSettings settings;
    settings.expected_frequency_hz = expected_hz;
    return {dominant_mode(output, interval, settings).frequency_hz, ""};
  } catch (const std::exception& error) {
    return {{}, error.what()};
  }
}

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

void refuse_dead_channels(const Record& record) {
  for (const Index i : output_channels(record)) {
    const Channel& channel = record.channels[static_cast<std::size_t>(i)];
    const auto samples = record.samples.row(i).array();
    const auto read = samples.isFinite();
    if (!read.any())
      throw std::invalid_argument(fmt::format("channel '{}' has no reading in this window", channel.name));
    const double largest = read.select(samples, -std::numeric_limits<double>::infinity()).maxCoeff(),
                 least = read.select(samples, std::numeric_limits<double>::infinity()).minCoeff();
    if (largest == least)
      throw std::invalid_argument(
          fmt::format("channel '{}' is dead: it shows {:g} {} throughout; expected motion, or other channels "
                      "(--channel, record.channels)",
                      channel.name, least, si_unit(channel.quantity)));
  }
}

double beam_frequency_hz(const Experiment& experiment) {
  return fem::lowest_frequency_hz(fem::assemble(experiment.structure, experiment.elements));
}

enum class Depth { mode, everything };

// A frequency that falls or rises with the amplitude looks like several modes: sidebands stand beside one.

double shift_of(const AmplitudePoint& from, const AmplitudePoint& to) {
  return (to.frequency_hz - from.frequency_hz) /
         std::hypot(from.frequency_deviation_hz, to.frequency_deviation_hz);
}

/// Whether amplitude and frequency go one way all along a decay, as those of modes that beat do not.
bool go_one_way(const std::vector<AmplitudePoint>& points) {
  constexpr double against = -3.0;             // standard deviations
  constexpr std::size_t fewest = 5, next = 2;  // windows overlap by half
  if (points.size() < fewest) return false;
  const double way = points.back().frequency_hz > points.front().frequency_hz ? 1.0 : -1.0;
  for (std::size_t i = next; i < points.size(); ++i)
    if (!(points[i].amplitude < points[i - next].amplitude) ||
        way * shift_of(points[i - next], points[i]) < against)
      return false;
  return true;
}

/// Windows of the envelope in place of the sections, which are fitted to a mode without companions. Absent
/// where the frequency is steady (amplitude_trend()), moves by less than the half-power width, or does not go
/// one way.
std::optional<AmplitudeSections> sections_of_envelope(const VectorXd& signal, double interval,
                                                      const ModalEstimate& mode, double noise) {
  constexpr double periods = 8.0;              // a chirp within a window makes its deviation larger
  constexpr double poorly = 0.5, chirp = 3.0;  // relative deviation of a damping ratio: at the end; at all
  AmplitudeSettings settings;
  settings.window = periods / mode.frequency_hz;
  settings.largest_deviation = chirp;
  std::vector<AmplitudePoint> points;
  try {
    points = amplitude_dependence(signal, interval, mode.rate(), {}, settings);
  } catch (const std::invalid_argument&) {  // too short
    return {};
  }
  while (!points.empty() &&
         points.back().damping_ratio_deviation > poorly * std::abs(points.back().damping_ratio))
    points.pop_back();
  const auto trend = amplitude_trend(points);
  if (!trend || !trend->frequency || !go_one_way(points)) return {};
  if (std::abs(trend->first.frequency_hz / trend->last.frequency_hz - 1.0) <
      2.0 * std::abs(trend->last.damping_ratio))
    return {};
  const auto count = static_cast<Index>(points.size());
  AmplitudeSections found;
  found.noise = noise;
  for (SectionTrend* one : {&found.frequency, &found.damping}) {
    one->probability = one->constant = 0.0;
    one->values.resize(count);
    one->weight = VectorXd::Ones(1);
  }
  for (Index i = 0; i < count; ++i) {
    const AmplitudePoint& at = points[static_cast<std::size_t>(i)];
    found.sections.push_back({at.time - 0.5 * settings.window, at.time + 0.5 * settings.window, at.amplitude,
                              at.frequency_hz, at.frequency_deviation_hz, at.damping_ratio,
                              at.damping_ratio_deviation});
    found.frequency.values[i] = at.frequency_hz, found.damping.values[i] = at.damping_ratio;
  }
  for (SectionTrend* one : {&found.frequency, &found.damping}) one->possible = one->values;
  return found;
}

// Two modes in the place of one, else phases that wander, whose sidebands may stand as other modes.
void look_beside_one_mode(const VectorXd& signal, double interval, bool alone, RecordAnalysis& found) {
  ModalEstimate& mode = *found.modal;
  auto decay = fitted_decay(signal, interval, mode);
  if (decay) found.pair = close_pair(*decay);
  if (!alone || found.jump || (found.pair && found.pair->contradicts_one())) return;
  const bool steady = mode.companions.empty() && !found.sections.frequency.varies();
  if (!mode.companions.empty()) decay = fitted_decay(signal, interval, without_neighbours(mode));
  for (const WalkAgainst against : {WalkAgainst::noise, WalkAgainst::amplitudes})
    if (decay && !found.walk && (steady || against == WalkAgainst::amplitudes))
      found.walk = phase_walk(decay->fit, decay->record, decay->interval, against);
  if (!found.walk) return;
  const WalkDeviation by_walk = found.walk->deviation(mode.rate());
  found.sections.frequency.walk = by_walk.frequency_hz, found.sections.damping.walk = by_walk.damping_ratio;
  by_walk.widen(mode.frequency_standard_deviation_hz, mode.damping_ratio_standard_deviation);
}

void take_decay(const Experiment& experiment, Depth depth, const ModalAnalysisSettings& settings,
                RecordAnalysis& found) {
  constexpr double mostly_read = 0.7;  // what is filled in follows the mode, not its changes
  const Record& stamped = found.evenly_stamped();
  const Index first = output_channels(stamped)[0];
  const VectorXd signal = stamped.samples.row(first).transpose();
  found.modal = dominant_mode(signal, stamped.interval(), settings);
  found.mode = FoundMode{found.modal->frequency_hz, found.modal->damping_ratio};
  found.mode_noise = found.residual_noise(*found.modal);
  found.near_mode = found.noise_at(*found.modal);
  if (depth == Depth::mode) return;
  found.overtone = third_overtone(signal, stamped.interval(), *found.modal);
  const double interval = found.even.record.interval();
  const VectorXd filled = found.even.record.samples.row(first).transpose();
  if (found.even.share < mostly_read) return;
  found.jump = decay_jump(filled, interval, *found.modal);
  found.sections = amplitude_sections(filled, interval, *found.modal, found.even.share);
  look_beside_one_mode(filled, interval, asks_free_oscillator(experiment, found.record), found);
}

/// One mode whose frequency follows its amplitude, in place of several. @returns whether it is
bool follow_amplitude(const Experiment& experiment, ModalAnalysisSettings settings, RecordAnalysis& found) {
  constexpr double near = 0.3;  // of the frequency: sidebands, no other modes
  const ModalEstimate& mode = *found.modal;
  if (!found.sections.sections.empty() ||
      !std::ranges::all_of(mode.companions, [&](const CompanionMode& other) {
        return std::abs(other.frequency_hz / mode.frequency_hz - 1.0) < near;
      }))
    return false;
  const Record& even = found.even.record;
  const VectorXd signal = even.samples.row(output_channels(even)[0]).transpose();
  auto sections = sections_of_envelope(signal, even.interval(), mode, found.near_mode->deviation);
  if (!sections) return false;
  RecordAnalysis alone = found;
  settings.companion_amplitude = std::numeric_limits<double>::infinity();
  try {
    take_decay(experiment, Depth::everything, settings, alone);
  } catch (const std::exception&) {  // no sine is near the motion
    alone = found;
    alone.modal->companions.clear();
  }
  alone.walk.reset(), alone.pair.reset();
  alone.sections = std::move(*sections);
  found = std::move(alone);
  return true;
}

void find_decaying_mode(const Experiment& experiment, Depth depth, RecordAnalysis& found) {
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = found.expected_hz;
  try {
    take_decay(experiment, depth, settings, found);
    if (depth == Depth::everything && follow_amplitude(experiment, settings, found)) return;
    if (!found.walk || found.modal->companions.empty()) return;
    if (!without_neighbours(*found.modal).companions.empty()) return;
    settings.companion_amplitude = std::numeric_limits<double>::infinity();  // they are sidebands
    found.walk.reset();
    take_decay(experiment, depth, settings, found);
  } catch (const std::invalid_argument& error) {
    const char* const from = experiment.prior.stiffness ? "prior.stiffness_n_per_m"
                             : experiment.is_described
                                 ? "the beam as described. Correct the beam, or set prior.stiffness_n_per_m"
                                 : "the strongest line. beamid modal lists all modes of the record";
    found.modal_refusal = fmt::format("{}. For modal analysis a mode was expected near {:.6g} Hz, from {}",
                                      error.what(), found.expected_hz, from);
  } catch (const std::runtime_error& error) {
    found.modal_failure = error.what();
  }
}

// Of the response to a measured force.
void find_driven_mode(RecordAnalysis& found) {
  const filters::Measurements measured = measurements(found.even.record);
  const RecordedFrequency recorded = recorded_frequency(measured.outputs.row(0).transpose(), measured.inputs,
                                                        found.even.record.interval(), found.expected_hz);
  if (recorded.value_hz) found.mode = FoundMode{*recorded.value_hz, 0.0};
  found.modal_failure = recorded.failure;
}

// Forces run from sample to sample: of their record, what was filled in is left out of the motion only.
void take_complete_forces(RecordAnalysis& found) {
  if (evenly_sampled(found.record) && found.record.samples.allFinite()) return;
  found.record = found.even.record;
  if (found.even.filled.size() == 0) return;
  for (const Index i : output_channels(found.record))
    found.record.samples.row(i) = found.even.filled.row(i).select(std::nan(""), found.record.samples.row(i));
}

// A displacement or a velocity that is read about another point than that of rest: no model moves there.
void leave_out_offsets(RecordAnalysis& found) {
  constexpr double much = 0.1;  // of the motion's root mean square
  if (!found.modal) return;
  for (const Index i : output_channels(found.record)) {
    const Channel& channel = found.record.channels[static_cast<std::size_t>(i)];
    if (channel.quantity != Quantity::displacement && channel.quantity != Quantity::velocity) continue;
    const MatrixXd read = found.even.record.samples.row(i);
    const ShapeFit fit =
        fit_shapes(read, found.even.record.interval(), {found.modal->rate(), 0.0}, {true, false});
    const double offset = fit.shapes(0, 1).real(), size = std::sqrt((read.array() - offset).square().mean());
    if (!(std::abs(offset) > much * size)) continue;
    found.record.samples.row(i).array() -= offset;
    found.even.record.samples.row(i).array() -= offset;
    found.notes.push_back(
        fmt::format("'{}' is read about {:.4g} {}, which is subtracted: the structure rests there.",
                    channel.name, offset, si_unit(channel.quantity)));
  }
}

std::string aliased_text(double beam_hz, double rate, double shown) {
  return fmt::format(
      "ALIASED: the beam's first mode, at {:.5g} Hz, lies above half the sampling rate, {:.5g} Hz. The "
      "record shows it at {:.5g} Hz, as it would show any mode at a multiple of {:.5g} Hz plus or minus "
      "that. Only the initial estimates determine which of them it is.",
      beam_hz, 0.5 * rate, shown, rate);
}

}  // namespace

double described_frequency_hz(const Experiment& experiment, const Record& record) {
  if (!experiment.prior.stiffness || experiment.model.name != "sdof") return beam_frequency_hz(experiment);
  const ModelSetting setting =
      model_setting(experiment, with_places(record, experiment), experiment.reduction);
  const auto model = model_registry().make(experiment.model.name, experiment.model.options, setting);
  return std::sqrt(*experiment.prior.stiffness / model->equivalent_mass) / (2.0 * std::numbers::pi);
}

double shown_at(double frequency_hz, double sampling_rate_hz) {
  return std::abs(std::remainder(frequency_hz, sampling_rate_hz));
}

bool RecordAnalysis::forced() const {
  return !input_channels(record).empty();
}

const Record& RecordAnalysis::evenly_stamped() const {
  return evenly_sampled(record) ? record : even.record;
}

bool asks_free_oscillator(const Experiment& experiment, const Record& record) {
  return experiment.model.name == "sdof" && experiment.parameters.empty() && input_channels(record).empty();
}

VectorXd RecordAnalysis::residual_noise(const ModalEstimate& of) const {
  const std::vector<Index> outputs = output_channels(record);
  const MatrixXd samples = record.samples(outputs, Eigen::all);
  VectorXd noise = mode_residual(samples, record.time, of.rate()).standard_deviation;
  for (Index i = 0; i < noise.size(); ++i)
    noise[i] = std::max(noise[i], smallest_relative_noise * largest_measured(samples.row(i)));
  return noise;
}

NoiseNearMode RecordAnalysis::noise_at(const ModalEstimate& of) const {
  const Record& stamped = evenly_stamped();
  NoiseNearMode near =
      noise_near_mode(stamped.samples.row(output_channels(record)[0]).transpose(), stamped.interval(), of);
  // What is filled in has no noise of its own, and an even grid may be denser than the readings.
  if (&stamped != &record) near.deviation /= std::sqrt(even.share * even.density);
  return near;
}

namespace {

RecordAnalysis analyse_to(Depth depth, const Experiment& experiment, const Record& record) {
  RecordAnalysis found;
  found.record = with_places(record, experiment);
  if (output_channels(found.record).empty())
    throw std::invalid_argument("the record holds forces only; expected at least one channel of motion");
  refuse_dead_channels(found.record);
  found.even = analysable(found.record);
  found.beam_frequency_hz = beam_frequency_hz(experiment);
  const double rate = 1.0 / found.record.interval(),
               described = described_frequency_hz(experiment, found.record);
  found.expected_hz = shown_at(described, rate);
  found.aliased = 2.0 * described > rate;
  if (found.aliased)
    found.objections.emplace_back("aliased", aliased_text(described, rate, found.expected_hz), described,
                                  0.5 * rate);
  if (found.forced()) {
    take_complete_forces(found);
    const auto imposed = [](const Channel& one) { return is_imposed(one.quantity); };
    if (std::ranges::any_of(found.record.channels, imposed))
      found.modal_failure = "a part between supports has other frequencies than the whole";
    else
      find_driven_mode(found);
  } else {
    find_decaying_mode(experiment, depth, found);
    leave_out_offsets(found);
    if (depth == Depth::everything) found.channels = channel_amplitudes(experiment, found);
  }
  if (!found.mode)
    found.notes.push_back(fmt::format(
        "Modal analysis of the record failed: {}. The first estimate is the beam's frequency. No independent "
        "check was made.",
        found.modal_failure.empty() ? found.modal_refusal : found.modal_failure));
  return found;
}

}  // namespace

RecordAnalysis analyse(const Experiment& experiment, const Record& record) {
  return analyse_to(Depth::everything, experiment, record);
}

RecordAnalysis analyse_mode(const Experiment& experiment, const Record& record) {
  return analyse_to(Depth::mode, experiment, record);
}

}  // namespace beamid::experiments
