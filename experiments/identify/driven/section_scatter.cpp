#include "experiments/identify/driven/section_scatter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/identify/noise_near_mode.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

std::optional<SectionScatter> section_scatter(const JointModel& model, const filters::Measurements& record,
                                              const filters::Gaussian& prior, const VectorXd& theta,
                                              double lowest_hz) {
  constexpr double fewest_periods = 20.0;
  constexpr Index fewest_sections = 6, most_sections = 20;
  auto whole = driven_problem(model, record, prior);
  if (!whole || !(lowest_hz > 0.0)) return {};
  const double periods = lowest_hz * record.interval() * static_cast<double>(record.size());
  const Index sections = std::min(most_sections, static_cast<Index>(periods / fewest_periods));
  if (sections < fewest_sections) return {};
  try {
    whole->weights.setOnes(record.outputs.rows());
    const DrivenFit all = evaluate_driven(*whole, theta);
    whole->weights = all.left.cwiseMax(1e-150).cwiseInverse();
    const auto parts = in_sections(*whole, record, sections);
    if (!parts) return {};
    const DrivenFit fit = evaluate_driven(*parts, theta);
    const Index q = theta.size();
    // Half of a line's squares are real: information of unit noise is twice J^T J.
    const MatrixXd known = prior.covariance.llt().solve(MatrixXd::Identity(q, q)),
                   information = 2.0 * fit.information + known;
    const Eigen::LDLT<MatrixXd> all_sections(information);
    SectionScatter found;
    found.sections = sections;
    found.periods = periods / static_cast<double>(sections);
    found.left_share = all.left_share;
    found.estimates.resize(q, sections);
    found.own_deviation.resize(q, sections);
    found.size.resize(sections);
    MatrixXd spread = MatrixXd::Zero(q, q);
    VectorXd weights = VectorXd::Zero(q), squares = VectorXd::Zero(q);
    const VectorXd mean_score = 2.0 * fit.scores.rowwise().mean();
    for (Index i = 0; i < sections; ++i) {
      const MatrixXd own = 2.0 * fit.part_information[static_cast<std::size_t>(i)];
      const VectorXd score = 2.0 * fit.scores.col(i) - mean_score, step = all_sections.solve(score);
      spread += step * step.transpose();
      const Eigen::LDLT<MatrixXd> alone(own + known);
      found.estimates.col(i) = theta + alone.solve(2.0 * fit.scores.col(i));
      const MatrixXd covariance = alone.solve(MatrixXd::Identity(q, q));
      found.own_deviation.col(i) = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
      found.size[i] = parts->parts[static_cast<std::size_t>(i)].outputs.norm();
      weights += own.diagonal();
      squares += own.diagonal().cwiseAbs2();
    }
    found.size /= std::max(1e-300, std::sqrt(found.size.squaredNorm() / static_cast<double>(sections)));
    found.covariance =
        spread * (static_cast<double>(sections) / static_cast<double>(std::max<Index>(1, sections - q)));
    found.freedom = (weights.cwiseAbs2().cwiseQuotient(squares.cwiseMax(1e-300)).array() - 1.0).cwiseMax(1.0);
    if (!found.covariance.allFinite()) return {};
    return found;
  } catch (const std::runtime_error&) {  // no motion at these unknowns
    return {};
  }
}

double section_factor(const SectionScatter& scatter, Index unknown, double deviation) {
  const double scattered = std::sqrt(std::max(0.0, scatter.covariance(unknown, unknown)));
  return deviation > 0.0 ? student_factor(scatter.freedom[unknown]) * scattered / deviation : 1.0;
}

}  // namespace beamid::experiments
