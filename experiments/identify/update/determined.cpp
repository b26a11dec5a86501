#include "experiments/identify/update/determined.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/identify/update/directions.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/signal/chi_square_limit.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

}  // namespace

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

}  // namespace beamid::experiments
