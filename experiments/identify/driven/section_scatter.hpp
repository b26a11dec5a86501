// How far the sections of a driven record differ about the estimates of the whole.
#pragma once

#include <optional>

#include "experiments/models/joint_model.hpp"
#include "filters/gaussian.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

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
};

/// Of at least 6 sections of at least 20 periods of the lowest mode. Absent where the record is shorter, or
/// has no lines (driven_problem()).
/// @param theta of the model's unknowns, in its coordinates (q)
/// @param prior what is known beforehand of them
std::optional<SectionScatter> section_scatter(const JointModel& model, const filters::Measurements& record,
                                              const filters::Gaussian& prior, const Eigen::VectorXd& theta,
                                              double lowest_hz);

/// What sections say of one unknown, over a deviation beside which it stands, for 95 % intervals.
double section_factor(const SectionScatter& scatter, Eigen::Index unknown, double deviation);

}  // namespace beamid::experiments
