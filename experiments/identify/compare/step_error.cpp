#include "experiments/identify/compare/step_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/identify/model_setting.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/signal/spectrum.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

/// The share of a channel's squares within a tenth of a frequency.
double share_near(const AmplitudeSpectrum& spectrum, double hz) {
  constexpr double near = 0.1;
  const auto squares = spectrum.amplitude.array().square();
  const auto inside = (spectrum.frequency_hz.array() / hz - 1).abs() < near;
  return inside.select(squares, 0).sum() / squares.sum();
}

/// Of what a run asks for, the narrowest 95 % half interval over the value.
double narrowest_interval(const ComparedRun& run) {
  double narrowest = 1;
  for (const ComparedParameter& p : run.parameters)
    if (!p.estimate.nuisance && p.estimate.value != 0)
      narrowest = std::min(narrowest, quantile_95 * p.estimate.deviation / std::abs(p.estimate.value));
  return narrowest;
}

}  // namespace

std::string step_error(const RunContext& context, const ComparedRun& run) {
  constexpr double least_share = 0.01, light_damping = 0.005, rounding = 1e-6;
  if (run.discretisation == "exponential" || !run.model || is_nonlinear(*run.model)) return {};
  const Record& record = context.analysis.even.record;
  const double interval = record.interval();
  std::vector<AmplitudeSpectrum> spectra;
  for (const Index i : output_channels(record))
    spectra.push_back(amplitude_spectrum(record.samples.row(i).transpose(), interval));
  double worst = 0, at_hz = 0;
  for (const double w : run.model->mode_frequencies) {
    const double hz = w / (2 * std::numbers::pi);
    if (!(w > 0 && w * interval < std::numbers::pi)) continue;
    const bool held = std::any_of(spectra.begin(), spectra.end(), [&](const AmplitudeSpectrum& one) {
      return share_near(one, hz) > least_share;
    });
    if (!held) continue;
    try {
      const Oscillator truth = Oscillator::from_frequency(1, w, light_damping);
      const double error = seen_through(run.discretisation, truth, interval).stiffness / truth.stiffness - 1;
      if (std::abs(error) > std::abs(worst)) worst = error, at_hz = hz;
    } catch (const std::exception&) {  // no closed form for it, or too long a step: the verdict says so
    }
  }
  if (!(std::abs(worst) > std::max(rounding, narrowest_interval(run)))) return {};
  return fmt::format(
      "WRONG BY THE STEP: at {:.3g} ms {} makes the stiffness of the mode at {:.4g} Hz {:.2g} % too {}, more "
      "than the narrowest interval here; what that mode determines comes out wrong by as much. Expected a "
      "reduction, such as modal_truncation, with the discretisation exponential, or a higher sampling rate.",
      1e3 * interval, run.discretisation, at_hz, 100 * std::abs(worst), worst > 0 ? "large" : "small");
}

}  // namespace beamid::experiments
