#include "experiments/identify/update/updating.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <tbb/parallel_for.h>
#include <Eigen/Core>
#include <Eigen/Dense>
#include <Eigen/SVD>

#include "experiments/models/estimates.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/text/progress.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr int most_iterations = 200;
// Coordinates are logarithms, alike in scale: what hardly changes anything is damped as the others are, in
// part.
constexpr double least_scale = 1e-3, least_damping = 1e-10;
constexpr double shortest_step = 1e-11, least_gain = 1e-15;

std::optional<FitResidual::Value> value_at(const FitResidual& residual, const VectorXd& x, bool jacobian) {
  try {
    FitResidual::Value value = residual.at(x, jacobian);
    if (value.residual.allFinite()) return value;
  } catch (const std::runtime_error&) {
  } catch (const std::invalid_argument&) {  // a value that the structure cannot have
  }
  return std::nullopt;
}

std::vector<bool> held_by_bounds(const SearchSpace& space, const VectorXd& x, const VectorXd& gradient) {
  std::vector<bool> on_bound(static_cast<std::size_t>(x.size()));
  for (Index j = 0; j < x.size(); ++j)
    on_bound[static_cast<std::size_t>(j)] =
        (x[j] <= space.lower()[j] && gradient[j] >= 0.0) || (x[j] >= space.upper()[j] && gradient[j] <= 0.0);
  return on_bound;
}

VectorXd step_from(const MatrixXd& normal, const VectorXd& gradient, const std::vector<bool>& on_bound,
                   double damping) {
  MatrixXd damped = normal;
  VectorXd right = -gradient;
  for (Index j = 0; j < right.size(); ++j) {
    damped(j, j) += damping * std::max(normal(j, j), least_scale * normal.diagonal().maxCoeff()) + 1e-300;
    if (!on_bound[static_cast<std::size_t>(j)]) continue;
    damped.row(j).setZero();
    damped.col(j).setZero();
    damped(j, j) = 1.0;
    right[j] = 0.0;
  }
  return damped.ldlt().solve(right);
}

}  // namespace

std::optional<Fit> least_squares(const FitResidual& residual, const VectorXd& start) {
  const SearchSpace& space = residual.space();
  VectorXd x = start.cwiseMax(space.lower()).cwiseMin(space.upper());
  auto value = value_at(residual, x, true);
  if (!value) return std::nullopt;
  // Of a large system, finding the modes is what costs, and most steps are taken.
  const bool slopes_apart = residual.model().dense();
  const double enough = slopes_apart ? 0.0 : 1e-7;  // of chi^2, where modes have fewer digits
  Fit fit;
  int small_gains = 0;
  const auto step = [&](double damping) -> VectorXd {
    const MatrixXd normal = value->jacobian.transpose() * value->jacobian;
    const VectorXd gradient = value->jacobian.transpose() * value->residual;
    return step_from(normal, gradient, held_by_bounds(space, x, gradient), damping);
  };
  const auto take = [&](const VectorXd& tried) {
    const double length = tried.cwiseAbs().maxCoeff();
    if (!std::isfinite(length)) return filters::TriedStep{};
    const VectorXd there =
        (x + std::min(1.0, (space.longest_step().array() / tried.array().abs()).minCoeff()) * tried)
            .cwiseMax(space.lower())
            .cwiseMin(space.upper());
    auto next = value_at(residual, there, !slopes_apart);
    const double before = value->chi_square();
    if (!next || !(next->chi_square() <= before)) return filters::TriedStep{0.0, length < 1e-8};
    if (slopes_apart) next = value_at(residual, there, true);
    const double gain = before - next->chi_square(), went = (there - x).cwiseAbs().maxCoeff();
    small_gains = gain <= 1e-10 * before ? small_gains + 1 : 0;
    x = there;
    value = std::move(next);
    return filters::TriedStep{1.0, went < shortest_step ||
                                       gain <= std::max(least_gain * before, enough * (1.0 + before)) ||
                                       small_gains > 3};
  };
  filters::MarquardtDamping rule;
  rule.first = 1e-2, rule.raise = 5.0, rule.least_raised = 0.0;
  rule.least = rule.negligible = least_damping, rule.most_steps = most_iterations;
  fit.converged = filters::levenberg_marquardt(rule, step, take) != filters::DescentEnd::exhausted;
  fit.on_bound = held_by_bounds(space, x, value->jacobian.transpose() * value->residual);
  fit.x = std::move(x);
  fit.value = std::move(*value);
  return fit;
}

namespace {

// What the residual's derivative determines, direction by direction.

/// Singular directions v_i of the residual's derivative J = dr/dx (r x q), of standard deviation 1 / s_i.
/// Those below open_deviation are determined, the others open.
struct Directions {
  Eigen::MatrixXd covariance;                 ///< (q x q) sum of v v^T / s^2 over all that change anything
  Eigen::VectorXd open_share, open_variance;  ///< (q) of the open ones, in each parameter
  std::vector<OpenDirection> open;
  Eigen::Index determined = 0;  ///< how many are
};

/// @param columns of J that may change; what is held has no part
Directions directions_of(const Eigen::MatrixXd& derivative, const std::vector<Eigen::Index>& columns);

constexpr double endless_deviation = 1e3 * open_deviation;  // of a direction that changes nothing

Directions directions_of(const MatrixXd& derivative, const std::vector<Index>& columns) {
  const Index q = derivative.cols(), count = static_cast<Index>(columns.size());
  Directions found{MatrixXd::Zero(q, q), VectorXd::Zero(q), VectorXd::Zero(q), {}, 0};
  if (count == 0) return found;
  const MatrixXd jacobian = derivative(Eigen::all, columns);
  const Eigen::JacobiSVD<MatrixXd, Eigen::FullPivHouseholderQRPreconditioner> svd(jacobian,
                                                                                  Eigen::ComputeFullV);
  for (Index i = 0; i < count; ++i) {
    const double value = i < svd.singularValues().size() ? svd.singularValues()[i] : 0.0;
    const double deviation =
        value > 1e-8 * svd.singularValues()[0] ? 1.0 / value : std::numeric_limits<double>::infinity();
    VectorXd weights = VectorXd::Zero(q);
    for (Index c = 0; c < count; ++c) weights[columns[static_cast<std::size_t>(c)]] = svd.matrixV()(c, i);
    if (std::isfinite(deviation)) found.covariance += deviation * deviation * weights * weights.transpose();
    if (deviation < open_deviation) {
      ++found.determined;
      continue;
    }
    const double least = std::min(deviation, endless_deviation);
    found.open_share += weights.cwiseAbs2();
    found.open_variance += least * least * weights.cwiseAbs2();
    Index largest = 0;
    weights.cwiseAbs().maxCoeff(&largest);
    if (weights[largest] < 0.0) weights = -weights;
    found.open.push_back({weights, deviation});
  }
  return found;
}

// What the modes determine of the parameters.

constexpr double surely = 0.999;  // beyond it chi^2 is no chance

/// Of p or of ln p; between bounds that are stated it ends at them.
void set_parameter_interval(const Unknown& unknown, double deviation, UpdatedParameter& parameter) {
  parameter.deviation = deviation;
  const bool bounded = unknown.form == Form::bounded;
  Unknown form = unknown;
  if (bounded) form.form = Form::linear;  // of a logit the interval beside a bound would be all between them
  if (form.form == Form::linear && parameter.value > 0.0 && deviation > 0.2 * parameter.value &&
      unknown.quantity != "axial_load")
    form.form = Form::logarithmic;  // a straight interval would reach zero
  const double state = form.to_state(parameter.value), half = quantile_95 * deviation / form.slope(state);
  parameter.lower_95 = form.to_physical(state - half);
  parameter.upper_95 = form.to_physical(state + half);
  if (!bounded) return;
  parameter.lower_95 = std::max(parameter.lower_95, unknown.lower);
  parameter.upper_95 = std::min(parameter.upper_95, unknown.upper);
}

/// Fills in values, intervals, bounds, open directions, freedom and chi^2 limit of the first set, from the
/// singular values of its Jacobian over the parameters that are not held by a bound: a direction whose
/// standard deviation is above open_deviation is open.
void judge_parameters(const FitResidual& residual, Updating& result) {
  const ParameterSet& set = result.sets.front();
  const SearchSpace& space = residual.space();
  const Index q = space.size();
  std::vector<Index> all, free;
  for (Index j = 0; j < q; ++j) {
    all.push_back(j);
    if (!set.fit.on_bound[static_cast<std::size_t>(j)]) free.push_back(j);
  }
  // On its bound a parameter takes no number to fit, but it is not known to lie there: the truth may be
  // beside it, and intervals count that.
  Directions found = directions_of(set.fit.value.jacobian, all);
  const Index determined =
      free.size() == all.size() ? found.determined : directions_of(set.fit.value.jacobian, free).determined;
  result.open = std::move(found.open);
  result.independent = residual.independent(set.fit.value);
  result.freedom = std::max<Index>(0, result.independent - determined);
  const double chi_square = set.fit.chi_square();
  // As many parameters as numbers, and still no fit: what is left is one number at least.
  const double freedom = static_cast<double>(std::max<Index>(1, result.freedom));
  result.limit = result.freedom > 0 ? chi_square_limit(freedom) : 0.0;
  if (chi_square > chi_square_limit(freedom)) result.widening = std::sqrt(chi_square / freedom);
  result.refuted = chi_square > chi_square_limit(freedom, surely);
  const VectorXd slope = space.slope(set.fit.x);
  const VectorXd deviation = found.covariance.diagonal().cwiseSqrt();
  result.correlation = MatrixXd::Identity(q, q);
  for (Index i = 0; i < q; ++i)
    for (Index j = 0; j < q; ++j)
      if (i != j && deviation[i] * deviation[j] > 0.0)
        result.correlation(i, j) = found.covariance(i, j) / (deviation[i] * deviation[j]);
  for (Index j = 0; j < q; ++j) {
    UpdatedParameter parameter{set.values[j]};
    const bool at_limit = set.fit.x[j] <= space.lower()[j] || set.fit.x[j] >= space.upper()[j];
    parameter.on_bound = at_limit && space.stated(j);
    parameter.at_search_limit = at_limit && !space.stated(j);
    parameter.determined = !parameter.at_search_limit && found.open_share[j] < 0.01 &&
                           found.open_variance[j] < open_deviation * open_deviation;
    set_parameter_interval(residual.model().asked().unknowns[static_cast<std::size_t>(j)],
                           result.widening * deviation[j] * std::abs(slope[j]), parameter);
    result.parameters.push_back(parameter);
  }
}

constexpr double same_set = 1e-4;  // in every coordinate

double no_worse(double chi_square) {
  return chi_square + 1e-6 * (1.0 + chi_square);
}

// Fits that ended at the same place, by rising chi^2.
std::vector<ParameterSet> distinct_sets(std::vector<std::optional<Fit>> fits, std::size_t starts,
                                        const SearchSpace& space, Updating& result) {
  std::vector<ParameterSet> sets;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (fits[i])
      order.push_back(i);
    else if (i < starts)
      ++result.failed;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return fits[a]->chi_square() < fits[b]->chi_square();
  });
  for (const std::size_t i : order) {
    const auto same = std::find_if(sets.begin(), sets.end(), [&](const ParameterSet& set) {
      return (set.fit.x - fits[i]->x).cwiseAbs().maxCoeff() < same_set;
    });
    const bool known = same != sets.end();
    ParameterSet& set = known ? *same : sets.emplace_back();
    set.starts += i < starts ? 1 : 0;
    set.seeded = set.seeded || i >= starts;
    if (known) continue;
    set.values = space.physical(fits[i]->x);
    set.fit = std::move(*fits[i]);
  }
  return sets;
}

// Those that fit as well as the best, the nearest to the description first where they fit the same.
void order_sets(std::vector<ParameterSet>& sets) {
  const double best = sets.front().fit.chi_square();
  for (ParameterSet& set : sets) set.as_well = set.fit.chi_square() - best <= as_well_chi_square;
  const auto equal_end = std::find_if(sets.begin(), sets.end(), [&](const ParameterSet& set) {
    return set.fit.chi_square() > std::max(no_worse(best), 1e-6);
  });
  std::stable_sort(sets.begin(), equal_end, [](const ParameterSet& a, const ParameterSet& b) {
    return a.fit.x.norm() < b.fit.x.norm();
  });
}

}  // namespace

std::size_t Updating::as_well() const {
  return static_cast<std::size_t>(
      std::count_if(sets.begin(), sets.end(), [](const ParameterSet& set) { return set.as_well; }));
}

bool Updating::continuum() const {
  return std::any_of(open.begin(), open.end(),
                     [](const OpenDirection& direction) { return std::isinf(direction.deviation); });
}

int default_starts(const ModesOfParameters& model) {
  if (model.dense()) return model.size() <= 32 ? 300 : 100;
  const double work = static_cast<double>(model.size()) * static_cast<double>(model.parameters() + 10);
  return std::clamp(static_cast<int>(2e6 / work), 4, 48);
}

Updating update(const FitResidual& residual, const UpdateSettings& settings,
                const std::vector<VectorXd>& known, const Progress& progress) {
  Updating result;
  const SearchSpace& space = residual.space();
  result.starts =
      static_cast<std::size_t>(settings.starts > 0 ? settings.starts : default_starts(residual.model()));
  std::vector<std::optional<Fit>> fits(result.starts + known.size());
  Countdown countdown(progress, fits.size(), "starts");
  tbb::parallel_for(std::size_t{0}, fits.size(), [&](std::size_t i) {
    fits[i] =
        least_squares(residual, i < result.starts ? space.start(i) : space.place(known[i - result.starts]));
    countdown.count();
  });
  result.sets = distinct_sets(std::move(fits), result.starts, space, result);
  if (result.sets.empty())
    throw std::invalid_argument(
        "the structure has no modes at any of the parameters tried: its stiffness is not positive; expected "
        "other initial estimates or bounds");
  order_sets(result.sets);
  judge_parameters(residual, result);
  if (result.continuum()) {  // other ends of searches say nothing
    ParameterSet first = std::move(result.sets.front());
    for (std::size_t i = 1; i < result.sets.size(); ++i)
      if (result.sets[i].as_well) first.starts += result.sets[i].starts;
    std::erase_if(result.sets, [&](const ParameterSet& set) { return set.as_well; });
    result.sets.insert(result.sets.begin(), std::move(first));
  }
  for (std::size_t i = 0; i < result.sets.size(); ++i)
    if (!result.sets[i].as_well) result.ended_elsewhere += result.sets[i].starts;
  return result;
}

}  // namespace beamid::experiments
