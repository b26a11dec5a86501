#include "experiments/identify/update/determined.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/signal/chi_square_limit.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double normal_quantile_95 = 1.959963985;
constexpr double endless_deviation = 1e3 * open_deviation;  // of a direction that changes nothing

/// In the parameter's own form: of p, of ln p, of the logit between bounds.
void set_parameter_interval(const Unknown& unknown, double deviation, UpdatedParameter& parameter) {
  parameter.deviation = deviation;
  Unknown form = unknown;
  if (form.form == Form::linear && parameter.value > 0.0 && deviation > 0.2 * parameter.value)
    form.form = Form::logarithmic;  // a straight interval would reach zero
  if (form.form == Form::bounded && !(parameter.value > form.lower && parameter.value < form.upper)) {
    parameter.lower_95 = parameter.upper_95 = parameter.value;
    return;
  }
  const double state = form.to_state(parameter.value),
               half = normal_quantile_95 * deviation / form.slope(state);
  parameter.lower_95 = form.to_physical(state - half);
  parameter.upper_95 = form.to_physical(state + half);
}

}  // namespace

void judge_parameters(const FitResidual& residual, Updating& result) {
  const ParameterSet& set = result.sets.front();
  const SearchSpace& space = residual.space();
  const Index q = space.size();
  std::vector<Index> free;
  for (Index j = 0; j < q; ++j)
    if (!set.fit.on_bound[static_cast<std::size_t>(j)]) free.push_back(j);
  const MatrixXd jacobian = set.fit.value.jacobian(Eigen::all, free);
  const auto count = static_cast<Index>(free.size());
  MatrixXd covariance = MatrixXd::Zero(q, q);  // of all directions that change anything
  VectorXd open_share = VectorXd::Zero(q), open_variance = VectorXd::Zero(q);
  Index determined = 0;
  if (count > 0) {
    const Eigen::JacobiSVD<MatrixXd, Eigen::FullPivHouseholderQRPreconditioner> svd(jacobian,
                                                                                    Eigen::ComputeFullV);
    for (Index i = 0; i < count; ++i) {
      const double value = i < svd.singularValues().size() ? svd.singularValues()[i] : 0.0;
      const double deviation =
          value > 1e-8 * svd.singularValues()[0] ? 1.0 / value : std::numeric_limits<double>::infinity();
      VectorXd weights = VectorXd::Zero(q);
      for (Index c = 0; c < count; ++c) weights[free[static_cast<std::size_t>(c)]] = svd.matrixV()(c, i);
      if (std::isfinite(deviation)) covariance += deviation * deviation * weights * weights.transpose();
      if (deviation < open_deviation) {
        ++determined;
        continue;
      }
      open_share += weights.cwiseAbs2();
      open_variance += std::min(deviation, endless_deviation) * std::min(deviation, endless_deviation) *
                       weights.cwiseAbs2();
      Index largest = 0;
      weights.cwiseAbs().maxCoeff(&largest);
      if (weights[largest] < 0.0) weights = -weights;
      result.open.push_back({weights, deviation});
    }
  }
  result.independent = residual.independent(set.fit.value);
  result.freedom = std::max<Index>(0, result.independent - determined);
  const double chi_square = set.fit.chi_square();
  result.limit = result.freedom > 0 ? chi_square_limit(static_cast<double>(result.freedom)) : 0.0;
  if (result.freedom > 0 && chi_square > result.limit)
    result.widening = std::sqrt(chi_square / static_cast<double>(result.freedom));
  else if (result.freedom == 0 && chi_square > 1e-6)  // as many parameters as numbers, and still no fit
    result.widening = std::sqrt(1.0 + chi_square);
  const VectorXd slope = space.slope(set.fit.x);
  const VectorXd deviation = covariance.diagonal().cwiseSqrt();
  result.correlation = MatrixXd::Identity(q, q);
  for (Index i = 0; i < q; ++i)
    for (Index j = 0; j < q; ++j)
      if (i != j && deviation[i] * deviation[j] > 0.0)
        result.correlation(i, j) = covariance(i, j) / (deviation[i] * deviation[j]);
  for (Index j = 0; j < q; ++j) {
    UpdatedParameter parameter{set.values[j]};
    parameter.determined = open_share[j] < 0.01 && open_variance[j] < open_deviation * open_deviation;
    const bool at_limit = set.fit.x[j] <= space.lower()[j] || set.fit.x[j] >= space.upper()[j];
    parameter.on_bound = at_limit && space.stated(j);
    parameter.at_search_limit = at_limit && !space.stated(j);
    set_parameter_interval(residual.model().asked().unknowns[static_cast<std::size_t>(j)],
                           result.widening * deviation[j] * std::abs(slope[j]), parameter);
    result.parameters.push_back(parameter);
  }
}

}  // namespace beamid::experiments
