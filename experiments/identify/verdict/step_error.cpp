#include "experiments/identify/verdict/run_verdict.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/signal/spectrum.hpp"
#include "filters/scheme.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

bool is_damping(const std::string& quantity) {
  return quantity == "storey_damping" || quantity == "damping_ratio" || quantity == "mass_damping" ||
         quantity == "stiffness_damping";
}

/// Of the unknowns of a run, or of its dampings alone, the narrowest 95 % half interval over the value; 1 at
/// most.
double narrowest_interval(const ComparedRun& run, bool dampings = false) {
  double narrowest = 1;
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    const Estimate& estimate = run.parameters[j].estimate;
    if (estimate.nuisance || estimate.value == 0) continue;
    if (dampings && (j >= run.unknowns.size() || !is_damping(run.unknowns[j].quantity))) continue;
    narrowest = std::min(narrowest, quantile_95 * estimate.deviation / std::abs(estimate.value));
  }
  return narrowest;
}

bool asks_for_damping(const ComparedRun& run) {
  return std::any_of(run.unknowns.begin(), run.unknowns.end(),
                     [](const Unknown& one) { return !one.nuisance && is_damping(one.quantity); });
}

/// What the scheme adds to the damping of the model as found: by the law of many degrees of freedom
/// (filters/scheme_bias.hpp) every pole of the motion behind it is log(g(lambda_f dt)) / dt, whatever the
/// damping. Of the modes that the record holds the one with the largest share.
std::string damping_of_step(const ComparedRun& run, double interval,
                            const std::function<bool(double)>& holds) {
  const auto* const motion = dynamic_cast<const filters::LinearMotion*>(run.model->motion.get());
  if (!motion || !run.has_estimate() || run.run.last.mean.size() == 0 || !asks_for_damping(run)) return {};
  Eigen::MatrixXd matrix;
  motion->motion_matrix(run.run.last.mean, matrix);
  const auto scheme = filters::scheme_registry().make(run.discretisation, {});
  double worst = 0;
  std::optional<Oscillator> found, behind;
  const Eigen::VectorXcd poles = matrix.eigenvalues();
  for (const std::complex<double> pole : poles) {
    if (!(pole.imag() > 0 && std::abs(pole) * interval < std::numbers::pi)) continue;
    const auto one = Oscillator::from_eigenvalue(1, pole),
               other = Oscillator::from_eigenvalue(
                   1, std::log(scheme->amplification(pole * interval).value) / interval);
    const double share = 1 - other.damping_ratio() / one.damping_ratio();
    if (!(std::abs(share) > std::abs(worst)) || !holds(other.frequency_hz())) continue;
    worst = share, found = one, behind = other;
  }
  constexpr double much = 0.01;
  if (!found || !(std::abs(worst) > std::max(much, narrowest_interval(run, true)))) return {};
  return fmt::format(
      "WRONG BY THE STEP: at {:.3g} ms {} has a damping ratio of {:.3g} % at {:.4g} Hz where {:.3g} % make "
      "the same record; dampings are too {} by that. Expected the discretisation exponential.",
      1e3 * interval, run.discretisation, 100 * found->damping_ratio(), found->frequency_hz(),
      100 * behind->damping_ratio(), found->damping_ratio() > behind->damping_ratio() ? "large" : "small");
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
  const auto holds = [&](double hz) {
    return std::any_of(spectra.begin(), spectra.end(), [&](const AmplitudeSpectrum& one) {
      return share_near(one, hz).squares > least_share;
    });
  };
  double worst = 0, at_hz = 0;
  for (const double w : run.model->mode_frequencies) {
    const double hz = w / (2 * std::numbers::pi);
    if (!(w > 0 && w * interval < std::numbers::pi)) continue;
    if (!holds(hz)) continue;
    try {
      const Oscillator truth = Oscillator::from_frequency(1, w, light_damping);
      const double error = seen_through(run.discretisation, truth, interval).stiffness / truth.stiffness - 1;
      if (std::abs(error) > std::abs(worst)) worst = error, at_hz = hz;
    } catch (const std::exception&) {  // no closed form for it, or too long a step: the verdict says so
    }
  }
  const std::string of_damping = damping_of_step(run, interval, holds);
  if (!(std::abs(worst) > std::max(rounding, narrowest_interval(run)))) return of_damping;
  const std::string of_stiffness = fmt::format(
      "WRONG BY THE STEP: at {:.3g} ms {} makes the stiffness of the mode at {:.4g} Hz {:.2g} % too {}, more "
      "than the narrowest interval here. What that mode determines comes out wrong by as much. Expected a "
      "reduction, such as modal_truncation, with the discretisation exponential, or a higher sampling rate.",
      1e3 * interval, run.discretisation, at_hz, 100 * std::abs(worst), worst > 0 ? "large" : "small");
  if (of_damping.empty()) return of_stiffness;
  return of_damping + " Also, " + of_stiffness.substr(of_stiffness.find(": ") + 2);
}

}  // namespace beamid::experiments
