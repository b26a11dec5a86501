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
#include "fem/matrix_system.hpp"
#include "fem/structure.hpp"
#include "filters/scheme.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index;

bool is_damping(const fem::Structure& structure, const Unknown& unknown) {
  const std::string& quantity = unknown.quantity;
  if (quantity == "factor")  // of a user-supplied matrix, where that is of dashpots alone
    if (const fem::MatrixSystem* const given = structure.matrices())
      return std::ranges::any_of(given->parameters, [&](const fem::MatrixSystem::Parameter& one) {
        return one.name == unknown.name && one.damping.nonZeros() > 0 && one.stiffness.nonZeros() == 0 &&
               one.mass.nonZeros() == 0;
      });
  return quantity == "damping" || quantity == "storey_damping" || quantity == "damping_ratio" ||
         quantity == "mass_damping" || quantity == "stiffness_damping";
}

/// Of the unknowns of a run, or of its dampings alone, the narrowest 95 % half interval over the value; 1 at
/// most, and 2 where no damping is an unknown.
double narrowest_interval(const RunContext& context, const ComparedRun& run, bool dampings = false) {
  double narrowest = dampings ? 2 : 1;
  for (std::size_t j = 0; j < run.parameters.size(); ++j) {
    const Estimate& estimate = run.parameters[j].estimate;
    if (estimate.nuisance) continue;
    if (dampings) {
      if (j >= run.unknowns.size() || !is_damping(context.experiment.structure, run.unknowns[j])) continue;
      narrowest = std::min(narrowest, 1.0);
    }
    if (estimate.value != 0)
      narrowest = std::min(narrowest, quantile_95 * estimate.deviation / std::abs(estimate.value));
  }
  return narrowest;
}

/// Poles of the motion as found, of whatever model: of a spring that is not linear those at rest, where
/// forward Euler adds dt times its tangent. None of a whole mesh, which is not made into dense matrices.
Eigen::VectorXcd found_poles(const ComparedRun& run) {
  Eigen::VectorXd state = run.run.last.mean;
  if (state.size() == 0 || !run.has_estimate() || is_whole_mesh(*run.model)) return {};
  Eigen::MatrixXd matrix;
  if (const auto* const linear = dynamic_cast<const filters::LinearMotion*>(run.model->motion.get()))
    linear->motion_matrix(state, matrix);
  else {
    Index motion = state.size();
    for (const Index place : run.model->unknown_places) motion = std::min(motion, place);
    for (const JointModel::Offset& offset : run.model->offsets) motion = std::min(motion, offset.place);
    state.head(motion).setZero();
    run.model->motion->rate_jacobian(state, Eigen::VectorXd::Zero(run.model->motion->input_size()), matrix);
    matrix = matrix.topLeftCorner(motion, motion).eval();
  }
  return matrix.allFinite() ? Eigen::VectorXcd(matrix.eigenvalues()) : Eigen::VectorXcd();
}

/// A mode as found, and the motion behind it, which the scheme turns into it: by the law of many degrees of
/// freedom (filters/scheme_bias.hpp) log(g(lambda_f dt)) / dt, whatever the damping.
struct SteppedMode {
  Oscillator found, behind;

  double stiffness_error() const { return found.stiffness / behind.stiffness - 1; }
  double damping_share() const { return 1 - behind.damping_ratio() / found.damping_ratio(); }
};

/// Of the modes that the record holds.
std::vector<SteppedMode> stepped_modes(const ComparedRun& run, double interval,
                                       const std::function<bool(double)>& holds) {
  const auto scheme = filters::scheme_registry().make(run.discretisation, {});
  std::vector<SteppedMode> modes;
  for (const std::complex<double> pole : found_poles(run)) {
    if (!(pole.imag() > 0 && std::abs(pole) * interval < std::numbers::pi)) continue;
    const std::complex<double> behind = std::log(scheme->amplification(pole * interval).value) / interval;
    const SteppedMode one{Oscillator::from_eigenvalue(1, pole), Oscillator::from_eigenvalue(1, behind)};
    if (holds(one.behind.frequency_hz())) modes.push_back(one);
  }
  return modes;
}

/// What the scheme adds to the damping of the mode of which it makes most.
std::string damping_of_step(const RunContext& context, const ComparedRun& run, double interval,
                            const std::vector<SteppedMode>& modes) {
  constexpr double much = 0.01;
  const double narrowest = narrowest_interval(context, run, true);
  if (modes.empty() || narrowest > 1) return {};
  const SteppedMode& one = *std::ranges::max_element(
      modes, {}, [](const SteppedMode& mode) { return std::abs(mode.damping_share()); });
  if (!(std::abs(one.damping_share()) > std::max(much, narrowest))) return {};
  return fmt::format(
      "WRONG BY THE STEP: at {:.3g} ms {} has a damping ratio of {:.3g} % at {:.4g} Hz where {:.3g} % make "
      "the same record; dampings are too {} by that. Expected the discretisation {}.",
      1e3 * interval, run.discretisation, 100 * one.found.damping_ratio(), one.found.frequency_hz(),
      100 * one.behind.damping_ratio(),
      one.found.damping_ratio() > one.behind.damping_ratio() ? "large" : "small",
      finest_discretisation(*run.model, interval));
}

}  // namespace

std::string step_error(const RunContext& context, const ComparedRun& run) {
  constexpr double least_share = 0.01, light_damping = 0.005, rounding = 1e-6;
  if (run.discretisation == "exponential" || !run.model) return {};
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
  const std::vector<SteppedMode> modes = stepped_modes(run, interval, holds);
  for (const SteppedMode& mode : modes)
    if (const double error = mode.stiffness_error(); std::abs(error) > std::abs(worst))
      worst = error, at_hz = mode.found.frequency_hz();
  for (const double w : run.model->mode_frequencies) {
    if (!is_whole_mesh(*run.model)) break;
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
  const std::string of_damping = damping_of_step(context, run, interval, modes);
  if (!(std::abs(worst) > std::max(rounding, narrowest_interval(context, run)))) return of_damping;
  const std::string of_stiffness = fmt::format(
      "WRONG BY THE STEP: at {:.3g} ms {} makes the stiffness of the mode at {:.4g} Hz {:.2g} % too {}, more "
      "than the narrowest interval here. What that mode determines comes out wrong by as much. Expected a "
      "reduction, such as modal_truncation, with the discretisation exponential, or a higher sampling rate.",
      1e3 * interval, run.discretisation, at_hz, 100 * std::abs(worst), worst > 0 ? "large" : "small");
  if (of_damping.empty()) return of_stiffness;
  return of_damping + " Also, " + of_stiffness.substr(of_stiffness.find(": ") + 2);
}

}  // namespace beamid::experiments
