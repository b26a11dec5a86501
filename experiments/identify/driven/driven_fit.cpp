#include "experiments/identify/driven/driven_fit.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <boost/math/distributions/students_t.hpp>

#include "experiments/identify/driven/driven_part.hpp"
#include "experiments/identify/engine/low_mode_fit.hpp"
#include "experiments/identify/verdict/noise_near_mode.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/signal/in_double.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

namespace {

/// By how much the sections' scores scatter beyond their information, all directions of the unknowns alike,
///
///     c = S / ((S - 1) q) sum_i s_i^T I^-1 s_i,    1 of noise, as of a chi-square of nu degrees of freedom
///
/// with nu = q^2 / sum_i tr (I^-1 I_i)^2 - q. A few sections determine one variance of V poorly: by chance it
/// is a tenth of what it should be, and then it is at least that of c I^-1. 1 where c may be chance.
/// @param steps I^-1 s_i of every section (q x S); @param scores s_i, without their mean (q x S)
double common_scatter(const MatrixXd& steps, const MatrixXd& scores, double squared_shares) {
  constexpr double surely = 0.999;
  const auto q = static_cast<double>(scores.rows()), sections = static_cast<double>(scores.cols());
  const double c = sections / ((sections - 1.0) * q) * steps.cwiseProduct(scores).sum(),
               freedom = std::max(1.0, q * q / squared_shares - q);
  return c * freedom > chi_square_limit(freedom, surely) ? c : 1.0;
}

}  // namespace

std::optional<SectionScatter> section_scatter(const JointModel& model, const filters::Measurements& record,
                                              const filters::Gaussian& prior, const VectorXd& theta,
                                              double lowest_hz, const VectorXd& input_noise) {
  constexpr double short_periods = 8.0;
  constexpr Index fewest_sections = 6, most_sections = 20, more_than_unknowns = 3;
  auto whole = driven_problem(model, record, prior);
  if (!whole || !(lowest_hz > 0.0)) return {};
  const double periods = lowest_hz * record.interval() * static_cast<double>(record.size());
  const auto sections_of = [&](double each) {
    return std::min(most_sections, static_cast<Index>(periods / each));
  };
  Index sections = sections_of(SectionScatter::long_periods), fewest = fewest_sections;
  if (sections < fewest) {
    sections = sections_of(short_periods);
    fewest = std::max(fewest, theta.size() + more_than_unknowns);
  }
  if (sections < fewest) return {};
  try {
    if (has_noise(input_noise)) whole->input_noise = input_noise;
    const DrivenFit all = weigh_by_residual(*whole, theta);
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
    const VectorXd mean_score = 2.0 * fit.scores.rowwise().mean();
    const MatrixXd scores = (2.0 * fit.scores).colwise() - mean_score, steps = all_sections.solve(scores);
    VectorXd weights = VectorXd::Zero(q), squares = VectorXd::Zero(q);
    double squared_shares = 0.0;  // of the information
    for (Index i = 0; i < sections; ++i) {
      const MatrixXd own = 2.0 * fit.part_information[static_cast<std::size_t>(i)];
      const Eigen::LDLT<MatrixXd> alone(own + known);
      found.estimates.col(i) = theta + alone.solve(2.0 * fit.scores.col(i));
      const MatrixXd covariance = alone.solve(MatrixXd::Identity(q, q));
      found.own_deviation.col(i) = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
      found.size[i] = parts->parts[static_cast<std::size_t>(i)].outputs.norm();
      const MatrixXd share = all_sections.solve(own);
      squared_shares += share.cwiseProduct(share.transpose()).sum();
      weights += own.diagonal();
      squares += own.diagonal().cwiseAbs2();
    }
    found.size /= std::max(1e-300, std::sqrt(found.size.squaredNorm() / static_cast<double>(sections)));
    found.freedom = (weights.cwiseAbs2().cwiseQuotient(squares.cwiseMax(1e-300)).array() - 1.0).cwiseMax(1.0);
    found.covariance =
        steps * steps.transpose() *
        (static_cast<double>(sections) / static_cast<double>(std::max<Index>(1, sections - q)));
    if (const double common = common_scatter(steps, scores, squared_shares); common > 1.0) {
      const VectorXd formal = all_sections.solve(MatrixXd::Identity(q, q)).diagonal();
      const double all_freedom = static_cast<double>(sections - 1);
      VectorXd wider = VectorXd::Ones(q);
      for (Index j = 0; j < q; ++j) {
        const double student = student_factor(all_freedom) / student_factor(found.freedom[j]),
                     least = student * student * common * formal[j];
        if (least > found.covariance(j, j))
          wider[j] = std::sqrt(least / std::max(1e-300, found.covariance(j, j)));
      }
      found.covariance = wider.asDiagonal() * found.covariance * wider.asDiagonal();
    }
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

SizeTrend trend_with_size(const SectionScatter& scatter, Index unknown) {
  const Index sections = scatter.sections;
  const double freedom = static_cast<double>(sections - 2);
  const VectorXd value = scatter.estimates.row(unknown), own = scatter.own_deviation.row(unknown).cwiseAbs2(),
                 doublings = scatter.size.cwiseMax(1e-300).array().log2();
  Eigen::Matrix2d normal;
  Eigen::Vector2d line;
  const auto fit = [&](double tau_square) {  // sum of squares over their variances
    const VectorXd weight = (own.array() + tau_square).cwiseMax(1e-300).inverse();
    normal << weight.sum(), weight.dot(doublings), weight.dot(doublings), weight.dot(doublings.cwiseAbs2());
    line = normal.ldlt().solve(Eigen::Vector2d(weight.dot(value), weight.dot(value.cwiseProduct(doublings))));
    return weight.dot((value.array() - line[0] - line[1] * doublings.array()).square().matrix());
  };
  if (fit(0.0) > freedom) {
    double low = 0.0, high = (value.array() - value.mean()).square().sum();
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = 0.5 * (low + high);
      (fit(middle) > freedom ? low : high) = middle;
    }
    fit(high);
  }
  SizeTrend trend{line[0], line[1], std::sqrt(std::max(0.0, normal.inverse()(1, 1)))};
  if (!std::isfinite(trend.slope) || !(trend.deviation > 0.0)) return {};
  const boost::math::students_t_distribution<double, InDouble> law(freedom);
  trend.probability = 2.0 * cdf(complement(law, std::abs(trend.slope) / trend.deviation));
  return trend;
}

SizeChange by_twice_the_motion(const SizeTrend& trend, const Unknown& unknown) {
  const double at = unknown.to_physical(trend.at_mean);
  return {unknown.to_physical(trend.at_mean + trend.slope) / at - 1.0,
          trend.deviation * std::abs(unknown.slope(trend.at_mean) / at)};
}

namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double no_motion = std::numeric_limits<double>::infinity();  // J where there is none

DrivenFit summary(const DrivenProblem& problem, const DrivenMotion& lines, const std::vector<PartAt>& parts,
                  const VectorXd& theta) {
  const Index p = problem.weights.size(), q = theta.size();
  DrivenFit fit;
  fit.theta = theta;
  fit.cost = lines.cost(parts, theta);
  fit.information.setZero(q, q);
  fit.scores.resize(q, static_cast<Index>(parts.size()));
  const std::vector<MatrixXd> slopes = lines.slopes(parts, theta);
  VectorXd left = VectorXd::Zero(p), read = VectorXd::Zero(p);
  double freedom = 0.0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Index rows = parts[i].left.size() / 2;
    fit.part_information.emplace_back(slopes[i].transpose() * slopes[i]);
    fit.information += fit.part_information.back();
    fit.scores.col(static_cast<Index>(i)) = slopes[i].transpose() * parts[i].left;
    for (Index c = 0; c < p; ++c) {
      const auto of = Eigen::seqN(c, rows / p, p);
      left[c] += parts[i].left.head(rows)(of).squaredNorm() + parts[i].left.tail(rows)(of).squaredNorm();
      read[c] += problem.parts[i].outputs.row(c).squaredNorm();
    }
    freedom += static_cast<double>(2 * (rows / p)) -
               static_cast<double>(parts[i].ends.rank()) / static_cast<double>(p);
  }
  left = left.cwiseQuotient(problem.weights.cwiseAbs2());
  fit.left_share = std::sqrt(left.cwiseQuotient(read.cwiseMax(1e-300)).mean());
  fit.left = (2.0 * left / std::max(freedom, 1.0)).cwiseSqrt();
  return fit;
}

// Root mean square of every channel's lines (p).
VectorXd sizes(const std::vector<RecordLines>& parts) {
  VectorXd squares = VectorXd::Zero(parts.front().outputs.rows());
  double lines = 0.0;
  for (const RecordLines& part : parts) {
    squares += part.outputs.cwiseAbs2().rowwise().sum();
    lines += static_cast<double>(part.omega.size());
  }
  return (squares / lines).cwiseSqrt().cwiseMax(1e-150);
}

// Every ratio and dashpot that is small, so that resonances are wide enough to be found.
VectorXd well_damped(const JointModel& model, VectorXd theta) {
  constexpr double ratio = 0.03;
  for (Index j = 0; j < theta.size(); ++j) {
    const Unknown& unknown = model.unknowns[static_cast<std::size_t>(j)];
    if (unknown.quantity == "damping_ratio" && unknown.to_physical(theta[j]) < ratio &&
        !(unknown.upper < ratio))
      theta[j] = unknown.to_state(ratio);
  }
  return theta;
}

// The prior's mean with its stiffnesses times a common factor; the least J among neighbours first.
std::vector<VectorXd> scaled_starts(const DrivenProblem& problem, const DrivenMotion& lines) {
  constexpr int steps = 16;
  constexpr double widest = 4.0;
  const FirstGuess guess{state_of_unknowns(*problem.model, problem.prior.mean), {}};
  std::vector<std::pair<double, VectorXd>> tried;
  for (int i = -steps; i <= steps; ++i) {
    const VectorXd change =
        scaled_stiffness(*problem.model, guess, std::pow(widest, static_cast<double>(i) / steps));
    if (change.size() == 0) continue;
    const VectorXd theta = well_damped(*problem.model, problem.prior.mean + change);
    const std::vector<PartAt> parts = lines.tried_at(theta);
    tried.emplace_back(parts.empty() ? no_motion : lines.cost(parts, theta), theta);
    if (change.isZero(0.0) && i != 0) break;  // no stiffness is asked about
  }
  std::vector<std::pair<double, VectorXd>> valleys;
  for (std::size_t i = 0; i < tried.size(); ++i)
    if (std::isfinite(tried[i].first) && (i == 0 || tried[i].first <= tried[i - 1].first) &&
        (i + 1 == tried.size() || tried[i].first <= tried[i + 1].first))
      valleys.push_back(tried[i]);
  std::sort(valleys.begin(), valleys.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<VectorXd> starts{well_damped(*problem.model, problem.prior.mean)};
  for (const auto& [cost, theta] : valleys) starts.push_back(theta);
  return starts;
}

}  // namespace

VectorXd state_of_unknowns(const JointModel& model, const VectorXd& theta) {
  VectorXd state = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
  state(model.unknown_places) = theta;
  return state;
}

MatrixXd DrivenFit::covariance(const filters::Gaussian& prior) const {
  const Index q = theta.size();
  const MatrixXd known = prior.covariance.llt().solve(MatrixXd::Identity(q, q));
  return (2.0 * information + known).llt().solve(MatrixXd::Identity(q, q));
}

std::optional<DrivenProblem> driven_problem(const JointModel& model, const filters::Measurements& record,
                                            filters::Gaussian prior) {
  constexpr double highest_share = 0.9;  // of half the sampling rate
  constexpr Index fewest_lines = 8;
  const Index m = model.motion->input_size();
  if (m == 0 || record.inputs.rows() < m || is_whole_mesh(model) ||
      !dynamic_cast<const filters::LinearMotion*>(model.motion.get()))
    return {};
  try {
    RecordLines lines =
        record_lines(record, record.inputs.topRows(m), highest_share * 0.5 / record.interval());
    const Index last =
        std::min(std::max(fewest_lines - 1, last_strong_line(lines.outputs)), lines.omega.size() - 1);
    lines.omega.conservativeResize(last + 1);
    lines.outputs.conservativeResize(Eigen::NoChange, last + 1);
    lines.inputs.conservativeResize(Eigen::NoChange, last + 1);
    const auto degree = record.inputs.rows() / m - 1;
    return DrivenProblem{&model,
                         {std::move(lines)},
                         degree == 0   ? InputPath::held
                         : degree == 1 ? InputPath::linear
                                       : InputPath::band_limited,
                         {},
                         std::move(prior),
                         {}};
  } catch (const std::invalid_argument&) {  // gaps, uneven stamps, or too short
    return {};
  }
}

std::optional<DrivenProblem> in_sections(const DrivenProblem& whole, const filters::Measurements& record,
                                         Index sections) {
  const Index length = record.size() / sections, m = whole.model->motion->input_size();
  const double highest_hz = whole.parts.front().omega.tail(1)[0] / (2.0 * pi);
  DrivenProblem found = whole;
  found.parts.clear();
  try {
    for (Index i = 0; i < sections; ++i) {
      filters::Measurements part;
      part.time = record.time.segment(i * length, length);
      part.outputs = record.outputs.middleCols(i * length, length);
      part.time_resolution = record.time_resolution;
      found.parts.push_back(record_lines(part, record.inputs.block(0, i * length, m, length), highest_hz));
    }
  } catch (const std::invalid_argument&) {
    return {};
  }
  return found;
}

DrivenFit fit_driven_from(const DrivenProblem& problem, const VectorXd& start, int most_steps) {
  constexpr double close_enough = 1e-3, longest = 3.0;  // of deviations of unit noise; of those beforehand
  const DrivenMotion lines(problem);
  VectorXd theta = start;
  std::vector<PartAt> now = lines.at(theta);
  double cost = lines.cost(now, theta);
  const VectorXd known = problem.prior.covariance.diagonal().cwiseSqrt();
  MatrixXd normal;
  VectorXd gradient;
  const auto linearise = [&] {
    const std::vector<MatrixXd> slopes = lines.slopes(now, theta);
    normal = lines.prior();
    gradient = -lines.prior() * lines.off(theta);
    for (std::size_t i = 0; i < now.size(); ++i) {
      normal += slopes[i].transpose() * slopes[i];
      gradient += slopes[i].transpose() * now[i].left;
    }
  };
  linearise();
  const auto step = [&](double damping) {
    VectorXd found = filters::solve_damped(normal, damping, gradient);
    const double length = found.cwiseQuotient(known).cwiseAbs().maxCoeff();
    if (length > longest) found *= longest / length;
    return found;
  };
  bool converged = false;
  const auto take = [&](const VectorXd& change) {
    filters::TriedStep tried;
    const double expected = change.dot(2.0 * gradient - normal * change);
    if (change.dot(normal * change) < close_enough * close_enough * std::max(1.0, 1e-3 * cost)) {
      tried.settled = converged = true;
      return tried;
    }
    const VectorXd there = theta + change;
    std::vector<PartAt> next = lines.tried_at(there);
    const double reached = next.empty() ? no_motion : lines.cost(next, there);
    if (!(reached < cost)) return tried;
    now = std::move(next);
    tried.gain = expected > 0.0 ? (cost - reached) / expected : 1.0;
    converged = tried.settled = cost - reached < 1e-9 * cost;
    theta = there;
    cost = reached;
    if (!tried.settled) linearise();
    return tried;
  };
  filters::MarquardtDamping rule;
  rule.first = 1e-3;
  rule.most_steps = most_steps;
  converged = filters::levenberg_marquardt(rule, step, take) != filters::DescentEnd::exhausted;
  DrivenFit fit = summary(problem, lines, now, theta);
  fit.converged = converged;
  return fit;
}

DrivenFit evaluate_driven(const DrivenProblem& problem, const VectorXd& theta) {
  const DrivenMotion lines(problem);
  return summary(problem, lines, lines.at(theta), theta);
}

DrivenFit weigh_by_residual(DrivenProblem& problem, const VectorXd& theta) {
  DrivenProblem exact = problem;
  exact.input_noise.resize(0);
  exact.weights.setOnes(problem.parts.front().outputs.rows());
  DrivenFit fit = evaluate_driven(exact, theta);
  const VectorXd& noise = problem.input_noise;
  const VectorXd left = noise.size() > 0 ? likeliest_output_noise(exact, theta, noise) : fit.left;
  problem.weights = left.cwiseMax(1e-150).cwiseInverse();
  return fit;
}

std::optional<DrivenFit> fit_driven(DrivenProblem& problem, int most_draws) {
  constexpr int first_steps = 12;
  constexpr std::size_t most_valleys = 4;
  constexpr int draws = 6;
  constexpr double usual_left = 0.3, least_left = 1e-6;  // of what was read
  constexpr double draw_spread = 0.15;                   // of deviations known beforehand
  constexpr Index enough_lines = 4096;                   // to find a valley; all of them find its bottom
  const Index q = problem.prior.mean.size();
  const VectorXd size = sizes(problem.parts);
  problem.weights = (usual_left * size).cwiseInverse();
  DrivenProblem search = problem;
  for (RecordLines& part : search.parts) {
    const Index stride = std::max<Index>(part.omega.size() / enough_lines, 1);
    part = thinned(part, stride);
    search.weights = std::sqrt(static_cast<double>(stride)) * problem.weights;
  }
  std::optional<DrivenFit> best;
  const auto descend = [&](const DrivenProblem& lines, const VectorXd& start, int most_steps) {
    try {
      DrivenFit fit = fit_driven_from(lines, start, most_steps);
      if (!best || fit.cost < best->cost) best = std::move(fit);
    } catch (const std::runtime_error&) {  // no motion there
    }
  };
  const std::vector<VectorXd> starts = scaled_starts(search, DrivenMotion(search));
  for (std::size_t i = 0; i < std::min(starts.size(), most_valleys); ++i)
    descend(search, starts[i], first_steps);
  if (!best) return best;
  const VectorXd middle = best->theta, known = problem.prior.covariance.diagonal().cwiseSqrt();
  for (int i = 0; i < draws; ++i)
    descend(search,
            well_damped(*problem.model, middle + draw_spread * known.cwiseProduct(standard_normal(
                                                                   q, 1, static_cast<std::uint64_t>(i)))),
            first_steps);
  constexpr double made = 0.1;  // of what was read: a wrong valley may leave a quarter
  const DrivenFit nearest = *best;
  for (int i = 0; i < most_draws && nearest.left_share > usual_left && best->left_share > made; ++i) {
    const double spread = i % 2 == 0 ? 1.0 : 0.3;  // of deviations known beforehand
    const VectorXd& from = i % 4 < 2 ? middle : problem.prior.mean;
    const VectorXd draw = standard_normal(q, 1, static_cast<std::uint64_t>(draws + i));
    descend(search, well_damped(*problem.model, from + spread * known.cwiseProduct(draw)), 20);
  }
  if (best->left_share > made) best = nearest;  // no draw makes the record either
  for (int i = 0; i < 2; ++i) {
    problem.weights = best->left.cwiseMax(least_left * size).cwiseInverse();
    const VectorXd start = best->theta;
    best.reset();
    descend(problem, start, 60);
    if (!best) return best;
  }
  return best;
}

}  // namespace beamid::experiments
