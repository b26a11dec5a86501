#include "experiments/identify/bounds/parameter_bounds.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::InformationFactor;

// Modes that no sensor shows have sensitivities of rounding alone, which would pass for unknowns to
// eliminate.
MatrixXd without_rounding(MatrixXd root, Index start) {
  constexpr double rounding = 1e-11;
  const double largest = root.leftCols(start).colwise().norm().maxCoeff();
  for (Index i = 0; i < start; ++i)
    if (root.col(i).norm() < rounding * largest) root.col(i).setZero();
  return root;
}

ParameterBound::Verdict verdict(const ParameterBound& bound, const filters::InformationReport& report,
                                Index i) {
  using Verdict = ParameterBound::Verdict;
  if (report.determined(i)) return bound.bound < bound.size ? Verdict::determined : Verdict::poor;
  const double silent = report.undetermined().row(i).norm();
  return silent > 1.0 - filters::negligible_entry ? Verdict::nothing : Verdict::combination;
}

}  // namespace

const char* to_string(ParameterBound::Verdict verdict) {
  switch (verdict) {
    case ParameterBound::Verdict::determined:
      return "determined";
    case ParameterBound::Verdict::poor:
      return "not in practice";
    case ParameterBound::Verdict::combination:
      return "in combination";
    case ParameterBound::Verdict::nothing:
      return "not at all";
  }
  return "";
}

std::vector<UnknownSize> unknown_sizes(const ObservedMotion& motion) {
  std::vector<UnknownSize> sizes;
  for (std::size_t j = 0; j < motion.model.unknowns.size(); ++j) {
    const Unknown& unknown = motion.model.unknowns[j];
    const Index place = motion.model.unknown_places[j];
    const double state = motion.initial_state[place];
    UnknownSize size{unknown.to_physical(state), 0.0, true, 0.0};
    size.of_value = size.value != 0.0;
    size.size = size.of_value ? std::abs(size.value) : unknown.deviation;
    const double direction = motion.directions.unknowns(place, static_cast<Index>(j));
    size.per_direction = std::abs(unknown.slope(state) * direction) / size.size;
    if (!(size.per_direction > 0.0 && std::isfinite(size.per_direction)))
      throw std::invalid_argument(fmt::format("{} has the deviation {:g}; expected a positive number",
                                              unknown.name, unknown.deviation));
    sizes.push_back(size);
  }
  return sizes;
}

InformationFactor information_about_unknowns(const ObservedMotion& motion,
                                             const ChannelInformation& information,
                                             const std::vector<NoisyChannel>& channels) {
  const std::vector<UnknownSize> sizes = unknown_sizes(motion);
  const Index start = information.start, q = static_cast<Index>(sizes.size());
  InformationFactor together(start + q);
  for (const NoisyChannel& read : channels) {
    if (!(read.deviation > 0.0 && std::isfinite(read.deviation)))
      throw std::invalid_argument(fmt::format("the noise of channel {} is {:g}; expected a positive number",
                                              read.channel + 1, read.deviation));
    together.add(information.channels[static_cast<std::size_t>(read.channel)].root() / read.deviation);
  }
  InformationFactor clean(start + q);
  clean.add(without_rounding(together.root(), start));
  std::vector<Index> nuisances;
  for (Index i = 0; i < start; ++i) nuisances.push_back(i);

  MatrixXd root = clean.without(nuisances).root();
  for (Index j = 0; j < q; ++j) root.col(j) /= sizes[static_cast<std::size_t>(j)].per_direction;
  InformationFactor result(q);
  result.add(root);
  for (Index j = 0; j < q; ++j) {
    const Unknown& unknown = motion.model.unknowns[static_cast<std::size_t>(j)];
    if (!unknown.nuisance) continue;
    MatrixXd known = MatrixXd::Zero(1, q);
    known(0, j) = sizes[static_cast<std::size_t>(j)].size / unknown.deviation;
    result.add(known);
  }
  return result;
}

VectorXd relative_bounds(const InformationFactor& information) {
  return filters::determined_combinations(information, VectorXd::Ones(information.unknowns())).bounds;
}

std::vector<ParameterBound> parameter_bounds(const ObservedMotion& motion,
                                             const filters::InformationReport& report) {
  const std::vector<UnknownSize> sizes = unknown_sizes(motion);
  std::vector<ParameterBound> result;
  for (std::size_t j = 0; j < sizes.size(); ++j) {
    const Unknown& unknown = motion.model.unknowns[j];
    const auto i = static_cast<Index>(j);
    ParameterBound bound;
    bound.name = unknown.name;
    bound.unit = unknown.unit;
    bound.value = sizes[j].value;
    bound.size = sizes[j].size;
    bound.of_value = sizes[j].of_value;
    bound.bound = report.bounds[i] * bound.size;
    bound.conditional_bound = report.conditional_bounds[i] * bound.size;
    bound.nuisance = unknown.nuisance;
    bound.prior_deviation = unknown.deviation;
    bound.verdict = verdict(bound, report, i);
    if (bound.verdict == ParameterBound::Verdict::nothing)
      bound.conditional_bound = std::numeric_limits<double>::infinity();
    const double state = motion.initial_state[motion.model.unknown_places[j]];
    const double reach = quantile_95 * bound.bound / std::abs(unknown.slope(state));
    bound.lower_95 = unknown.to_physical(state - reach);
    bound.upper_95 = unknown.to_physical(state + reach);
    result.push_back(bound);
  }
  return result;
}

}  // namespace beamid::experiments
