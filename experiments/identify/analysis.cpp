#include "experiments/identify/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "experiments/config/channel_places.hpp"
#include "experiments/identify/mode_analysis.hpp"
#include "experiments/identify/mode_residual.hpp"
#include "experiments/identify/model_setting.hpp"
#include "experiments/identify/recorded_frequency.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
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
  return fem::modes(fem::assemble(experiment.structure, experiment.elements), 1).frequency_hz()[0];
}

enum class Depth { mode, everything };

void find_decaying_mode(const Experiment& experiment, Depth depth, RecordAnalysis& found) {
  constexpr double mostly_read = 0.7;  // what is filled in follows the mode, not its changes
  const Record& stamped = found.evenly_stamped();
  ModalAnalysisSettings settings;
  settings.expected_frequency_hz = found.expected_hz;
  try {
    found.modal = dominant_mode(stamped.samples.row(output_channels(stamped)[0]).transpose(),
                                stamped.interval(), settings);
    found.mode = FoundMode{found.modal->frequency_hz, found.modal->damping_ratio};
    found.mode_noise = found.residual_noise(*found.modal);
    found.near_mode = found.noise_at(*found.modal);
    if (depth == Depth::mode) return;
    const Index first = output_channels(stamped)[0];
    found.overtone = third_overtone(stamped.samples.row(first).transpose(), stamped.interval(), *found.modal);
    const double interval = found.even.record.interval();
    const VectorXd filled = found.even.record.samples.row(first).transpose();
    if (found.even.share < mostly_read) return;
    found.jump = decay_jump(filled, interval, *found.modal);
    if (asks_free_oscillator(experiment, found.record))
      found.sections = amplitude_sections(filled, interval, *found.modal, found.even.share);
  } catch (const std::invalid_argument& error) {
    found.modal_refusal = fmt::format(
        "modal analysis: {} (looked for near {:.6g} Hz of {})", error.what(), found.expected_hz,
        experiment.prior.stiffness ? "prior.stiffness_n_per_m"
                                   : "the beam as described; prior.stiffness_n_per_m says it better");
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

bool has_supports(const Record& record) {
  return std::any_of(record.channels.begin(), record.channels.end(),
                     [](const Channel& channel) { return is_imposed(channel.quantity); });
}

std::string aliased_text(double beam_hz, double rate, double shown) {
  return fmt::format(
      "ALIASED: the beam's first mode, at {:.5g} Hz, lies above half the sampling rate, {:.5g} Hz. The "
      "record shows it at {:.5g} Hz, as it would show any mode at a multiple of {:.5g} Hz plus or minus "
      "that: which of them it is only the initial estimates say.",
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
  if (found.aliased) found.warnings.push_back(aliased_text(described, rate, found.expected_hz));
  if (found.forced()) {
    take_complete_forces(found);
    if (has_supports(found.record))
      found.modal_failure = "a part between supports has other frequencies than the whole";
    else
      find_driven_mode(found);
  } else {
    find_decaying_mode(experiment, depth, found);
    if (depth == Depth::everything) found.channels = channel_amplitudes(experiment, found);
  }
  if (!found.mode)
    found.notes.push_back(fmt::format(
        "The record's own frequency could not be had without a model ({}): the beam's takes its place as a "
        "first estimate, and runs are not checked against it.",
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
