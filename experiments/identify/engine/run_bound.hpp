// The Cramer-Rao bound of a run.
#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "experiments/identify/engine/compared_run.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/joint_model.hpp"
#include "filters/discrete_model.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

// 95 % intervals of parameters, as wide as the record's noise asks for.

/// Standard deviation of parameter j by the covariance of the state [its unit], before anything widens it.
double formal_deviation(const ComparedRun& run, std::size_t j);

/// Of parameter j, from its deviation in the state, `spread` times as wide; the parameter's own form makes it
/// lopsided.
void set_interval(ComparedRun& run, std::size_t j, double spread);

/// A standard deviation over the least there is, that of the Cramer-Rao bound and what was known beforehand;
/// 1 where it is not clearly below that, as chance and linearisation allow. Below 1 a filter is
/// overconfident.
double overconfidence(double deviation, double bound, double prior_deviation);

/// Standard deviation and interval of parameter j times `factor`, or times what brings them to the least
/// there is, if that is more.
void widen(ComparedRun& run, std::size_t j, double factor);

/// Of all parameters and of the mode found, where the record's noise is denser than white noise of the
/// deviation that the filter assumes: near the mode (noise_near_mode.hpp) or, of a forced record, where each
/// parameter is determined (noise_in_estimates.hpp). A remark states the factors. Never narrower.
void widen_intervals(const RunContext& context, ComparedRun& run);

/// Where innovations are not white, or the factor is 3 and more: at least what the scatter of the lines makes
/// of each parameter (DescriptionTests::deviations), which counts forces that nobody measures. A remark
/// states the factors.
void hold_scatter_of_lines(ComparedRun& run);

/// Deviations of the unknowns [their units] that no unbiased estimate falls below, the start unknown;
/// infinite where the record does not determine them. What is known of nuisance parameters, and of how far a
/// joint has slipped at the start, is information. Samples that were not read are none.
/// @param state of the motion at the first sample (n)
Eigen::VectorXd run_bounds(filters::DiscreteModel& discrete, const JointModel& model,
                           const Eigen::VectorXd& state, const StartDirections& directions,
                           const filters::Measurements& record);

// The modes of a record in a model at its estimate.

/// Of the oscillations of the equations of motion at a state that the measured inputs reach and the sensors
/// see: of a tower shaken along x not its mode along y.
struct RecordedModes {
  FoundMode lowest;
  /// The one that the record shows: among the lowest and those as strong in it, by reach and sight, as a
  /// tenth of the strongest, the nearest to the frequency found in the record. Deviations are known of this
  /// one.
  FoundMode shown;
};

/// Absent: nothing oscillates, or the motion is not linear.
/// @param unknowns their estimate and covariance as the state carries them (q): deviations to first order
/// @param record_hz of the mode found in the record [Hz]; absent: the lowest is shown
std::optional<RecordedModes> recorded_modes(const JointModel& model, const Eigen::VectorXd& state,
                                            const filters::Gaussian& unknowns,
                                            std::optional<double> record_hz);

/// Rates of the oscillations of a free motion from this state [rad/s]; none where the motion is not linear.
/// @param least of what the sensors see of the strongest, the part that they see of the others at least
std::vector<std::complex<double>> seen_rates(const JointModel& model, const Eigen::VectorXd& state,
                                             double least);

}  // namespace beamid::experiments
