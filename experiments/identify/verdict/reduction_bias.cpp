// What a reduction does by itself to the parameters that are identified with it.
//
// A filter fits the frequencies that its reduced model has to those of the record. Where the model, reduced,
// has another frequency than the structure with the same parameters, as a static shape's mass and stiffness
// make it, the parameters come out wrong, and no interval shows it. Of mode k let e_k = ln f_k of the model
// less that of the mesh, S_kj = d ln f_k / d ln p_j of the mesh, and I_k the information of the record on ln
// f_k. Least squares are then off by
//
//     d ln p = -(S^T I S + L)^-1 S^T I e,     L = diag((p_j / s0_j)^2), the prior's information.
//
// By Fisher's information, its phase unknown, a damped sine of decay rate sigma and energy E, the sum of
// squares over the samples, in white noise s has I = E / (4 s^2 sigma^2) on its angular frequency where it
// dies away, and E T^2 / (12 s^2) where it lasts longer than the record, T. Between both, 1 / sigma^2 becomes
// 1 / (sigma^2 + 3 / T^2).
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/verdict/run_verdict.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/motion/beam_equations.hpp"
#include "experiments/signal/spectrum.hpp"
#include "fem/modes.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

fem::BeamParameter structure_parameter(const Unknown& unknown) {
  return {*beam_quantity(unknown.quantity), unknown.region, unknown.name};
}

/// The structure with what the run found of it; absent where it found nothing of it, or what cannot be.
std::optional<fem::Structure> found_structure(const Experiment& experiment, const ComparedRun& run) {
  fem::Structure structure = experiment.structure;
  bool any = false;
  try {
    for (std::size_t j = 0; j < run.unknowns.size() && j < run.parameters.size(); ++j)
      if (beam_quantity(run.unknowns[j].quantity)) {
        structure = fem::with_value(structure, structure_parameter(run.unknowns[j]),
                                    run.parameters[j].estimate.value);
        any = true;
      }
  } catch (const std::invalid_argument&) {
    return {};
  }
  return any ? std::optional(structure) : std::nullopt;
}

/// Of its lowest modes, without rigid ones [Hz].
VectorXd frequencies(const fem::Structure& structure, int elements, Index enough) {
  const fem::StructuralSystem system = fem::assemble(structure, elements);
  const fem::Modes modes = fem::modes(system, std::min(enough, system.size()));
  return modes.frequency_hz().tail(modes.size() - modes.rigid);
}

Index nearest(const VectorXd& hz, double wanted) {
  Index place = 0;
  (hz.array() - wanted).abs().minCoeff(&place);
  return place;
}

/// A mode of a reduced model at its estimate, and what the record holds of it.
struct HeldMode {
  double hz = 0.0;           ///< of the model
  double information = 0.0;  ///< of the record on ln f
};

/// Those that the record holds: more than its noise there, and a thousandth of a channel.
std::vector<HeldMode> held_modes(const RunContext& context, const ComparedRun& run) {
  const auto* const motion = dynamic_cast<const filters::LinearMotion*>(run.model->motion.get());
  if (!motion || run.run.last.mean.size() == 0) return {};
  constexpr double least_share = 1e-3;
  const Record& record = context.analysis.even.record;
  const double interval = record.interval(), duration = interval * static_cast<double>(record.size());
  MatrixXd matrix;
  motion->motion_matrix(run.run.last.mean, matrix);
  std::vector<HeldMode> held;
  for (const std::complex<double> pole : matrix.eigenvalues())
    if (pole.imag() > 0.0 && std::abs(pole) * interval < std::numbers::pi) {
      const double slowness = std::pow(pole.real(), 2) + 3.0 / (duration * duration);
      held.push_back({std::abs(pole) / (2.0 * std::numbers::pi), std::norm(pole) / (4.0 * slowness)});
    }
  const std::vector<Index> outputs = output_channels(record);
  std::vector<double> energy_over_noise(held.size(), 0.0);
  for (std::size_t i = 0; i < outputs.size() && static_cast<Index>(i) < run.noise.size(); ++i) {
    const VectorXd signal = record.samples.row(outputs[i]).transpose();
    const double square = (signal.array() - signal.mean()).square().sum(),
                 noise = std::pow(run.noise[static_cast<Index>(i)], 2);
    if (!(square > 0.0 && noise > 0.0)) continue;
    const AmplitudeSpectrum spectrum = amplitude_spectrum(signal, interval);
    for (std::size_t k = 0; k < held.size(); ++k) {
      const SpectrumShare share = share_near(spectrum, held[k].hz);
      const double chance = noise * static_cast<double>(signal.size()) * share.lines;
      if (share.squares > least_share)
        energy_over_noise[k] += std::max(0.0, share.squares * square - chance) / noise;
    }
  }
  for (std::size_t k = 0; k < held.size(); ++k) held[k].information *= energy_over_noise[k];
  std::erase_if(held, [](const HeldMode& mode) { return !(mode.information > 0.0); });
  return held;
}

}  // namespace

VectorXd reduction_bias(const RunContext& context, const ComparedRun& run) {
  constexpr double change = 1e-3, rounding = 1e-9;
  const auto q = static_cast<Index>(run.parameters.size());
  if (run.reduction == "none" || !run.model || !run.has_estimate()) return {};
  const int elements = context.experiment.elements;
  const auto structure = found_structure(context.experiment, run);
  if (!structure || run.unknowns.size() != run.parameters.size()) return {};
  const std::vector<HeldMode> held = held_modes(context, run);
  const auto count = static_cast<Index>(held.size());
  if (count == 0) return {};
  MatrixXd slope = MatrixXd::Zero(count, q), precision = MatrixXd::Zero(q, q);
  VectorXd error(count), information(count);
  try {
    const Index enough = std::max<Index>(8, 2 * run.coordinates);
    const VectorXd whole = frequencies(*structure, elements, enough);
    for (Index k = 0; k < count; ++k) {
      const HeldMode& mode = held[static_cast<std::size_t>(k)];
      error[k] = std::log(mode.hz / whole[nearest(whole, mode.hz)]);
      if (std::abs(error[k]) < rounding) error[k] = 0.0;
      information[k] = mode.information;
    }
    for (Index j = 0; j < q; ++j) {
      const Unknown& unknown = run.unknowns[static_cast<std::size_t>(j)];
      const Estimate& found = run.parameters[static_cast<std::size_t>(j)].estimate;
      precision(j, j) = std::pow(found.value / found.prior_deviation, 2);
      if (!beam_quantity(unknown.quantity)) continue;
      const auto moved = [&](double factor) {
        return frequencies(fem::with_value(*structure, structure_parameter(unknown), factor * found.value),
                           elements, enough);
      };
      const VectorXd above = moved(1.0 + change), below = moved(1.0 - change);
      for (Index k = 0; k < count; ++k) {
        const Index place = nearest(whole, held[static_cast<std::size_t>(k)].hz);
        slope(k, j) = std::log(above[place] / below[place]) / (2.0 * change);
      }
    }
  } catch (const std::exception&) {  // a structure without such modes has no such error
    return {};
  }
  const MatrixXd weighted = information.asDiagonal() * slope;
  precision += slope.transpose() * weighted;
  return (-precision.ldlt().solve(weighted.transpose() * error)).array().exp() - 1.0;
}

std::string reduction_error(const RunContext& context, const ComparedRun& run) {
  constexpr double surely = 3.0, rounding = 1e-6;
  if (run.reduction == "none" || !run.mode) return {};
  const auto structure = found_structure(context.experiment, run);
  if (!structure) return {};
  double whole = 0.0;
  try {
    const VectorXd all = frequencies(*structure, context.experiment.elements, 8);
    whole = all[nearest(all, run.mode->frequency_hz)];
  } catch (const std::exception&) {  // a structure without such modes has no such error
    return {};
  }
  const double error = run.mode->frequency_hz / whole - 1.0,
               deviation = run.mode->frequency_deviation_hz / run.mode->frequency_hz;
  if (!(std::abs(error) > std::max(surely * deviation, rounding))) return {};
  return fmt::format(
      "WRONG BY THE REDUCTION: with these parameters the structure has a mode at {:.5g} Hz, and the model "
      "that {} makes of it {:.5g} Hz, {:+.2g} %, {:.2g} standard deviations. Stiffness comes out wrong by "
      "about {:+.2g} %, which no interval here holds. Expected a reduction that keeps the mode, such as "
      "modal_truncation.",
      whole, run.reduction, run.mode->frequency_hz, 100.0 * error, std::abs(error) / deviation,
      100.0 * (1.0 / std::pow(1.0 + error, 2) - 1.0));
}

}  // namespace beamid::experiments
