// What a single identification of a record is worth, beside what else is known of the record.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/engine/compared_run.hpp"

namespace beamid::experiments {

constexpr double settled_move = 1.0;    ///< of an unknown by the last pass, at most, in standard deviations
constexpr double unsettled_move = 5.0;  ///< likewise: passes that move further have found nothing yet

/// Status, intervals and warnings of a run, the same whatever command asked for it.
///
/// - Intervals are widened where the noise at the record's mode is denser than white noise of the deviation
///   that the filter assumes (noise_near_mode.hpp), or where a free decay varies with its amplitude
///   (amplitude_sections.hpp); they are never narrowed.
/// - K and C of a free decay: record_identification.hpp.
/// - Of any other model, a warning where its first mode at the estimate and the modal analysis of the first
///   channel differ by more than three of their standard deviations together, in frequency or in damping
///   ratio, with how much; one where the reduction moves the mode (run_verdict.cpp); and one where the
///   innovations are not those of a consistent filter. A filter that diverged is said to have.
///
/// Records driven by a measured force have no modal analysis, models that are not linear no mode: of the
/// three, the last.
void judge_run(const RunContext& context, ComparedRun& run);

/// A warning where the deviation of a parameter asked about, no nuisance, is nearly the one assumed
/// beforehand.
void judge_what_is_said(ComparedRun& run);

/// By which a deviation grows until the 95 % interval of an estimate holds that of another.
double factor_to_hold(double estimate, double deviation, double other, double other_deviation);

// Estimates that a change of the description, of a clock or of an input's noise would move.

/// The move that matters most.
struct Move {
  double deviations = 0.0;  ///< as they are reported
  std::size_t unknown = 0;
  bool is_material = false;  ///< whether one leaves its interval and moves by more than 0.1 % of its value
};
/// @param moved of the unknowns, in deviations of their state (q)
Move farthest_move(const ComparedRun& run, const Eigen::VectorXd& moved);

/// Deviations grow until the intervals hold the estimates so moved, too. @param moved likewise
void hold_moved(ComparedRun& run, const Eigen::VectorXd& moved);

/// Whether what is left is too little to speak against a description, where no move is material: less than a
/// thousandth of the motion. Of a record that is simulated without noise the interpolation of its input is
/// such.
bool has_small_residual(const ComparedRun& run);

// What a reduction does by itself to what is identified with it (reduction_bias.cpp).

/// Predicted relative errors of the unknowns (q), from the frequencies that the reduced model has at its
/// estimate where the mesh has others, weighed by what the record determines of each; 0 for those that move
/// no frequency. Empty without a reduction, for models without a parameter of the structure, for models that
/// are not linear and where the record holds no mode of the model.
Eigen::VectorXd reduction_bias(const RunContext& context, const ComparedRun& run);

/// Predicted relative error of one parameter by a reduction of some order, from what a free decay holds.
struct OrderError {
  std::string method;         ///< of the reduction
  Eigen::Index order = 0;     ///< r, coordinates of the model
  std::size_t parameter = 0;  ///< its place in the run
  double bias = 0.0;          ///< by the frequencies and damping that the reduction moves
  double others = 0.0;        ///< root mean square over the phases of the omitted modes: coloured noise
  double deviation = 0.0;     ///< the Cramer-Rao bound in the noise of the sensors, by the modes kept

  double expected() const;  ///< of all three, as squares add
};

/// Of every parameter of a run, for each order up to that of the highest mode in the record, eight at most,
/// of the run's own reduction, or of modal_truncation where its order is no number. Empty where
/// reduction_bias() is for want of a parameter or a linear model, of driven records, and where the record
/// holds fewer than two modes.
std::vector<OrderError> errors_by_order(const RunContext& context, const ComparedRun& run);

/// A sentence where the mode that a run is identified by is moved by more than three of the frequency's
/// standard deviations; else empty, as where reduction_bias() is.
std::string reduction_error(const RunContext& context, const ComparedRun& run);

// What the discretisation does to the higher modes of a model (step_error.cpp).

/// A sentence where the scheme of a run, by its closed form (discretisation_bias.hpp), moves the stiffness of
/// a mode that holds a hundredth of the record by more than the narrowest interval of the run: what is
/// determined by that mode comes out wrong by as much. Empty otherwise, and for exact schemes. Of damping
/// likewise: the scheme of the run turns each pole of another motion, log(g(lambda_f dt)) / dt, into that of
/// the model as found, forward Euler C into C + dt K; said where the damping ratio of a mode that the record
/// holds differs by more than the narrowest interval of a damping. Of a model that is not linear the poles
/// are those at rest.
///
/// A mode holds what the outputs' spectra do within a tenth of its frequency; modes above half the sampling
/// rate are left out.
std::string step_error(const RunContext& context, const ComparedRun& run);

// What a record itself says against its clocks and its measured inputs, though nobody stated it
// (input_faults.cpp).

/// Where a driven record is surely likelier with a clock late or at another rate (likeliest_clock.hpp), or
/// else with noise in its inputs (noise_in_estimates.hpp): contradicted where that moves an unknown out of
/// its 95 % interval, or where it makes most of what is left; a warning where it moves one by more than a
/// deviation.
void judge_inputs(const RunContext& context, ComparedRun& run);

/// Whether noise of the inputs, its size well known, makes a judged run of exact inputs surely likelier and,
/// where the run is contradicted, by more than a clock does, or anything of the description
/// (DescriptionFault::gain), each by itself. Estimates then allow for it.
bool shows_input_noise(const RunContext& context, const ComparedRun& run);

/// What is said of them, and what to do.
std::string clock_scatter_text(const Record& record, const ClockScatter& scatter);

/// Contradicted where the channels of a free decay do not ring at one frequency (joint_decay_fit.hpp).
void judge_clock_scatter(const RunContext& context, ComparedRun& run);

// Estimates beside the prior that they started from (against_description.cpp).

/// Estimates beside what was described or given as a prior, p0 +- s0.
struct AgainstDescription {
  std::string scale;         ///< all masses and stiffnesses are wrong by one factor; empty: they are not
  bool contradicts = false;  ///< the priors exclude that factor
  std::vector<std::string>
      differences;  ///< parameters, each more than four s0 away; none where `scale` has it
};

/// The force, and nothing else, fixes the scale of what it weighs: with a force e times too large all masses,
/// stiffnesses and dashpots of M x'' + C x' + K x = f come out e times too large, the motion is met as well
/// as ever, and only what was known beforehand can tell. With r_j = log(p_j / p0_j) and s_j^2 = (s0_j /
/// p0_j)^2 + (s_j / p_j)^2 the factor is g = sum r_j / s_j^2 / sum 1 / s_j^2, with the deviation (sum 1 /
/// s_j^2)^-1/2. It is one factor where sum (r_j - g)^2 / s_j^2 is less than its chi-square's 99.9 % point.
/// The priors exclude it from four deviations on. From one and a half on it is still no coincidence where
/// all r_j lie together within a tenth of g.
///
/// A damping known to 100 % or less well states no prior, and is left out.
/// @param by_force whether a force was measured, which the scale then comes from
/// @param unknowns of the same parameters, in whose coordinates they are away from their priors; empty:
/// linear
AgainstDescription against_description(const std::vector<ComparedParameter>& parameters, bool by_force,
                                       const std::vector<Unknown>& unknowns = {});

/// ", as with 9.80665, a force in N taken for kgf ...": of a force's reading over the force, or a motion over
/// its reading, what makes such a factor within exp(+-near); empty: nothing usual.
/// @param by_force whether a force was measured; else the motion alone can be in another unit
std::string usual_scale(double factor, double near, bool by_force);

/// Puts it among the warnings of a run; its status becomes contradicted where the priors exclude the factor.
void judge_description(const RunContext& context, ComparedRun& run);

}  // namespace beamid::experiments
