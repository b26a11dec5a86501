#include "filters/innovation_consistency.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "filters/whiteness.hpp"

namespace beamid::filters {
namespace {

using Eigen::Index, Eigen::VectorXd;

// Bounds that the mean of so many chi-square variables of one degree leaves with probability `outside`.
std::pair<double, double> band(double freedoms, double outside) {
  const boost::math::chi_squared distribution(freedoms);
  return {quantile(distribution, 0.5 * outside) / freedoms,
          quantile(distribution, 1.0 - 0.5 * outside) / freedoms};
}

}  // namespace

InnovationConsistency innovation_consistency(const FilterRun& run) {
  constexpr Index fewest = 100, parts = 10;
  const Index reached = run.failure ? run.failure->step : run.normalised_squares.size();
  std::vector<Index> told;  // samples that told something, and how many outputs did
  std::vector<double> outputs;
  for (Index k = 0; k < reached; ++k)
    if (const Index count = (!run.innovations.col(k).array().isNaN()).count(); count > 0) {
      told.push_back(k);
      outputs.push_back(static_cast<double>(count));
    }
  const auto samples = static_cast<Index>(told.size());
  if (samples < fewest)
    throw std::invalid_argument("innovations: " + std::to_string(samples) + "; expected at least " +
                                std::to_string(fewest));
  const VectorXd squares = run.normalised_squares(told);
  const Eigen::Map<const VectorXd> degrees(outputs.data(), samples);

  InnovationConsistency result;
  result.mean_normalised_square = squares.sum() / degrees.sum();
  std::tie(result.lower_95, result.upper_95) = band(degrees.sum(), 0.05);
  const Index part = samples / parts;
  result.windows.resize(parts);
  double fewest_degrees = degrees.sum();  // the band is that of the window where the fewest were measured
  for (Index i = 0; i < parts; ++i) {
    const double all = degrees.segment(i * part, part).sum();
    result.windows[i] = squares.segment(i * part, part).sum() / all;
    fewest_degrees = std::min(fewest_degrees, all);
  }
  std::tie(result.window_lower_95, result.window_upper_95) = band(fewest_degrees, 0.05 / parts);

  const Whiteness whiteness = whiteness_of(run.whitened_innovations.row(0).head(reached).transpose());
  result.lag_one_correlation = whiteness.autocorrelation[0];
  result.whiteness_p_value = whiteness.p_value;
  return result;
}

}  // namespace beamid::filters
