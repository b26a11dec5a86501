// Whether the channels of a free decay agree on its motion, with the first mode's shape as described.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/identify/engine/analysis.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/modal/subspace_realisation.hpp"
#include "fem/modes.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

// u_i s^k_i of the first mode as described (p); empty: not to be had.
VectorXcd expected(const Experiment& experiment, const Record& record, const std::vector<Index>& outputs,
                   Complex rate) {
  constexpr double node = 0.05;  // of the largest reading of the same kind
  constexpr Index most_rigid = 6;
  const Choice one_mode{"modal_truncation",
                        reduction::reduction_registry().completed("modal_truncation", {})};
  const fem::StructuralSystem system = model_setting(experiment, record, one_mode).system;
  const fem::Modes modes = fem::modes(system, std::min<Index>(most_rigid + 1, system.size()));
  if (modes.rigid >= modes.size()) throw std::invalid_argument("no mode that oscillates");
  const VectorXd shape = system.outputs * modes.shape.col(modes.rigid);
  VectorXcd found(shape.size());
  for (Index i = 0; i < shape.size(); ++i) {
    const Quantity own =
        record.channels[static_cast<std::size_t>(outputs[static_cast<std::size_t>(i)])].quantity;
    double largest = 0.0;
    for (Index j = 0; j < shape.size(); ++j)
      if (record.channels[static_cast<std::size_t>(outputs[static_cast<std::size_t>(j)])].quantity == own)
        largest = std::max(largest, std::abs(shape[j]));
    found[i] = std::abs(shape[i]) > node * largest ? shape[i] * std::pow(rate, times_differentiated(own))
                                                   : Complex(0.0);
  }
  return found;
}

// What a reading too large by a factor is taken for.
std::string usual_unit(double factor, Quantity quantity) {
  struct Usual {
    double factor;
    const char *is, *taken_for;
    bool acceleration;
  };
  constexpr double near = 0.15;  // of a logarithm: a place that is not quite right
  for (const auto& [usual, is, taken_for, acceleration] :
       {Usual{1.0 / 9.80665, "g", "m/s2", true}, Usual{9.80665, "m/s2", "g", true},
        Usual{1000.0, "thousandths of a unit", "whole ones (mm for m)", false},
        Usual{0.001, "whole units", "thousandths (m for mm)", false}})
    if (std::abs(std::log(factor / usual)) < near && (!acceleration || quantity == Quantity::acceleration))
      return fmt::format(", as where {} {} taken for {}", is, acceleration ? "is" : "are", taken_for);
  return {};
}

std::string named(const Channel& channel) {
  return fmt::format("{} '{}'", to_string(channel.quantity), channel.name);
}

ChannelAmplitudes amplitudes_of(const Record& record, const std::vector<Index>& outputs,
                                const VectorXcd& found, const VectorXcd& expected,
                                const VectorXd& deviation) {
  constexpr double far = 1.5, too_far = 3.0, beyond_noise = 5.0;
  ChannelAmplitudes result;
  const auto channel = [&](Index i) -> const Channel& {
    return record.channels[static_cast<std::size_t>(outputs[static_cast<std::size_t>(i)])];
  };
  if (std::abs(found[0]) < beyond_noise * deviation[0]) return result;
  for (Index i = 1; i < found.size(); ++i) {
    if (expected[i] == Complex(0.0)) continue;
    const Complex should_be = found[0] * expected[i] / expected[0], ratio = found[i] / should_be;
    const double noise = std::hypot(deviation[i], deviation[0] * std::abs(expected[i] / expected[0])),
                 size = std::abs(ratio), off = std::max(size, 1.0 / size);
    const bool turned = ratio.real() < -0.5 * size;
    if (!(std::abs(found[i] - should_be) > beyond_noise * noise) || (!turned && off < far)) continue;
    result.contradict |= turned || off > too_far;
    result.text += fmt::format("{}{} has {:.4g} times the amplitude{} that the mode's shape makes of {}{}",
                               result.text.empty() ? "" : "; ", named(channel(i)), size,
                               turned ? ", with its sign turned," : "", named(channel(0)),
                               usual_unit(size, channel(i).quantity));
  }
  return result;
}

}  // namespace

ChannelAmplitudes channel_amplitudes(const Experiment& experiment, const RecordAnalysis& analysis) {
  if (analysis.forced() || !analysis.modal || analysis.aliased) return {};
  const Record& record = analysis.even.record;
  const std::vector<Index> outputs = output_channels(record);
  if (outputs.size() < 2) return {};
  try {
    const Complex rate = analysis.modal->rate();
    const MatrixXd samples = record.samples(outputs, Eigen::all);
    const ShapeFit fit = fit_shapes(samples, record.interval(), {rate, 0.0}, {true, false});
    const double fading = 2.0 * std::max(0.0, -rate.real()) * record.interval(),
                 count = static_cast<double>(samples.cols()),
                 whole = fading > 0.0 ? -std::expm1(-fading * count) / fading : count;
    const VectorXd deviation = fit.residual_standard_deviation * std::sqrt(2.0 / whole);
    const VectorXcd should_be = expected(experiment, record, outputs, rate);
    if (should_be[0] == Complex(0.0)) return {};
    ChannelAmplitudes result = amplitudes_of(record, outputs, fit.shapes.col(0), should_be, deviation);
    if (!result.text.empty())
      result.text =
          "The channels do not agree on the motion: " + result.text +
          ". A unit, gain, sign or place is likely wrong in [record], and the estimates make up for it: "
          "correct it, or omit the channel (--channel).";
    return result;
  } catch (const std::exception&) {  // no such shape, or a channel with gaps too long to fill
    return {};
  }
}

}  // namespace beamid::experiments
