// The unknowns of a driven linear model, by output error on the lines of its record's spectrum.
#pragma once

#include <optional>
#include <vector>

#include "experiments/identify/parts/line_likelihood.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/record/record.hpp"
#include "filters/gaussian.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

// How far the sections of a driven record differ about the estimates of the whole.

/// A deviation from likelihood alone holds where the model is exact. What sections of a record say one by one
/// counts what the model lacks, too: with s_i = J_i^T r_i of section i at the estimate, and I the sum of the
/// sections' J_i^T J_i and of what is known beforehand,
///
///     V = S / (S - q) I^-1 [sum_i (s_i - s)(s_i - s)^T] I^-1,    s the mean of the s_i
///
/// the covariance that holds whatever the errors within a section are [liang1986], S / (S - q) for what q
/// unknowns take out of the scores.
struct SectionScatter {
  Eigen::Index sections = 0;      ///< S
  double periods = 0.0;           ///< of the lowest mode in each
  Eigen::MatrixXd covariance;     ///< V, in the model's coordinates eta (q x q)
  Eigen::VectorXd freedom;        ///< sections that weigh in each unknown, less one (q)
  Eigen::MatrixXd estimates;      ///< one step from the whole estimate by each section alone (q x S)
  Eigen::MatrixXd own_deviation;  ///< of those, by what the record leaves (q x S)
  Eigen::VectorXd size;           ///< root mean square of each section's outputs over the whole record's (S)
  double left_share = 0.0;        ///< of the lines of the whole record, what the estimates leave

  static constexpr double long_periods = 20.0;
  bool is_long() const { return periods >= long_periods; }
};

/// Of at least 6 sections of at least 20 periods of the lowest mode; of a record that is too short for these,
/// of 8 periods or more, at least three more than unknowns. Such a section holds its start, too, and decides
/// no verdict. Absent where the record is shorter still, or has no lines (driven_problem()).
/// @param theta of the model's unknowns, in its coordinates (q)
/// @param prior what is known beforehand of them
/// @param input_noise standard deviations (m); none above 0: the inputs are exact
std::optional<SectionScatter> section_scatter(const JointModel& model, const filters::Measurements& record,
                                              const filters::Gaussian& prior, const Eigen::VectorXd& theta,
                                              double lowest_hz, const Eigen::VectorXd& input_noise = {});

/// What sections say of one unknown, over a deviation beside which it stands, for 95 % intervals.
double section_factor(const SectionScatter& scatter, Eigen::Index unknown, double deviation);

/// How an unknown follows the size A_i of the motion over the sections of a record,
///
///     eta_i = a + b log2 A_i + e_i,    var e_i = v_i + tau^2
///
/// with v_i what a section's lines say and tau^2 >= 0 what makes the sum of the squares over their variances
/// S - 2 (random effects [dersimonian1986]). Sizes that are alike determine no slope.
struct SizeTrend {
  double at_mean = 0.0;      ///< a, at the size of the whole record
  double slope = 0.0;        ///< b, of eta by every doubling
  double deviation = 0.0;    ///< standard deviation of b
  double probability = 1.0;  ///< of a larger |b| without a trend, by Student's t of S - 2 degrees of freedom

  bool exists(Eigen::Index unknowns) const { return probability < 0.01 / static_cast<double>(unknowns); }
};
SizeTrend trend_with_size(const SectionScatter& scatter, Eigen::Index unknown);

/// By what share of itself an unknown changes where the motion is twice as large.
struct SizeChange {
  double share = 0.0, deviation = 0.0;
};
SizeChange by_twice_the_motion(const SizeTrend& trend, const Unknown& unknown);

/// With y_k and u_k the lines of outputs and inputs, G_k(theta) of the model (supported_response.hpp), Z_k
/// what a part of a record that does not repeat itself adds to a line, W the channels' weights [pintelon2012,
/// ch. 6]:
///
///     J(theta) = sum over parts, min over c of sum_k |W (y_k - G_k(theta) u_k - Z_k(theta) c)|^2
///              + |theta - theta_0|^2_(P_0^-1)
///
/// c is projected out (variable projection [golub1973]). Z has a column for every coordinate of the motion
/// and, for what a part's ends do to its inputs, a constant and a slope of every channel. Where inputs hold
/// noise of covariance R_u, |L_k^-1 W (...)|^2 takes the place of |W (...)|^2,
///
///     L_k L_k^H = 1 + W G_k R_u G_k^H W
///
/// without ln det: E[dJ] is 0 at the truth whatever the inputs were (errors in variables [pintelon2012]).
struct DrivenProblem {
  const JointModel* model = nullptr;  ///< its motion is a filters::LinearMotion
  std::vector<RecordLines> parts;     ///< the whole record, or sections of it
  InputPath path = InputPath::band_limited;
  Eigen::VectorXd weights;           ///< of the channels [1 / unit] (p)
  filters::Gaussian prior;           ///< theta_0, P_0 in the model's coordinates eta (q)
  Eigen::VectorXd input_noise = {};  ///< standard deviations [unit] (m); empty: the inputs are exact
};

/// Where a search ended, with what a part of the record says there.
struct DrivenFit {
  Eigen::VectorXd theta;        ///< in the model's coordinates eta (q)
  double cost = 0.0;            ///< J
  Eigen::VectorXd left;         ///< root mean square of what is left of each channel [unit] (p)
  double left_share = 0.0;      ///< of the lines' size, what is left; channels weighed by their size
  Eigen::MatrixXd information;  ///< of unit noise behind the weights: J^T J of all parts (q x q)
  Eigen::MatrixXd scores;       ///< J^T r of each part (q x parts)
  std::vector<Eigen::MatrixXd> part_information;  ///< J^T J of each part
  bool converged = false;

  /// Of theta with the noise of each channel that is left, what is known beforehand included (q x q).
  Eigen::MatrixXd covariance(const filters::Gaussian& prior) const;
};

/// The whole record as one part, up to the frequency below which all but a thousandth of the squares of every
/// channel lie. Absent where the model is not a small linear one, no input was measured, stamps are uneven,
/// readings are missing, or samples are too few.
/// @param record how its inputs run between samples tells the path
std::optional<DrivenProblem> driven_problem(const JointModel& model, const filters::Measurements& record,
                                            filters::Gaussian prior);

/// The same in consecutive sections of equal length. Absent where one would be too short.
std::optional<DrivenProblem> in_sections(const DrivenProblem& whole, const filters::Measurements& record,
                                         Eigen::Index sections);

/// Levenberg-Marquardt from one start. @throws std::runtime_error where the model has no motion there.
DrivenFit fit_driven_from(const DrivenProblem& problem, const Eigen::VectorXd& start, int most_steps = 60);

/// The same from several starts: every stiffness times a common factor of 1/4 to 4, modes well damped so that
/// their resonances are wide, and draws about the best. The weights become those of what is left.
/// @param most_draws more, about the best and the prior's mean, where 30 % of the lines' size are left, to 10
/// %
/// @returns absent where no start has a motion
std::optional<DrivenFit> fit_driven(DrivenProblem& problem, int most_draws = 0);

/// J^T J and J^T r of every part at a theta; no search.
DrivenFit evaluate_driven(const DrivenProblem& problem, const Eigen::VectorXd& theta);

/// The weights become those of the channels' noise: of all that is left at a theta or, where the inputs hold
/// noise, of the likeliest beside that (likeliest_output_noise()).
/// @returns what is left there, of unit weights and exact inputs
DrivenFit weigh_by_residual(DrivenProblem& problem, const Eigen::VectorXd& theta);

/// What the lines of a record say for noise of its inputs, beside noise of its outputs of any smooth
/// spectrum: with r_k the residual, G_k the responses to a unit of each input, and D_b the variances of the
/// channels in bands of a third of an octave,
///
///     r_k ~ CN(0, D_b)    against    r_k ~ CN(0, D_b + G_k diag(q) G_k^H)
///
/// noise of an input makes channels coherent and resonances stand out; that of sensors does neither.
/// @param theta of the unknowns (q); @param sizes of the inputs, all noisy in proportion (m)
/// @returns the gain of the log-likelihood, at most what the likeliest q gains; 0 where none gains; infinite
/// where the half-power widths of the resonances in the band, 2 xi f each, are less than five lines together:
/// there the lines cannot decide
double input_noise_gain(const DrivenProblem& problem, const Eigen::VectorXd& theta,
                        const Eigen::VectorXd& sizes);

/// White noise of the sensors, standard deviations [unit].
struct LevelsOfNoise {
  Eigen::VectorXd outputs, inputs;     ///< (p), (m)
  Eigen::VectorXd relative_deviation;  ///< standard deviation of ln inputs, by the information (m)
  double whiteness_p = 0.0;            ///< of such levels of L_k^-1 r_k by bands (c) or larger
};

/// The likeliest of r_k ~ CN(0, R + G_k R_u G_k^H), r_k what exact inputs leave of the lines of the first
/// part: each variance times sqrt(a / b) in turn, a its share of sum_k |S_k^-1 r_k|^2, b what noise of these
/// sizes makes of that on average [zhou2019]. Of such noise the mean squares m_c of n_c lines of L_k^-1 r_k,
/// a channel in a third of an octave, make 2 sum_c n_c (m_c - 1 - ln m_c) chi-square, of a degree of freedom
/// for each but those of the levels.
/// @param sizes of the inputs' noise to begin with (m)
LevelsOfNoise likeliest_line_noise(const DrivenProblem& problem, const Eigen::VectorXd& theta,
                                   const Eigen::VectorXd& sizes);

/// Of the outputs alone, beside inputs whose noise is known (p). @param sizes of it (m)
Eigen::VectorXd likeliest_output_noise(const DrivenProblem& problem, const Eigen::VectorXd& theta,
                                       const Eigen::VectorXd& sizes);

/// The whole state of a model at its unknowns, its motion at rest.
Eigen::VectorXd state_of_unknowns(const JointModel& model, const Eigen::VectorXd& theta);

}  // namespace beamid::experiments
