#include "experiments/identify/section_trend.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double significant = 0.01;

/// log of Student's likelihood of a slope that is z deviations off.
double log_student(double z, double freedom) {
  return -0.5 * (freedom + 1) * std::log1p(z * z / freedom);
}

}  // namespace

SectionLine section_line_through(const VectorXd& u, const VectorXd& v, const VectorXd& deviation) {
  const Eigen::ArrayXd weight = deviation.array().square().inverse();
  const double sum = weight.sum(), u_mean = (weight * u.array()).sum() / sum,
               v_mean = (weight * v.array()).sum() / sum;
  const Eigen::ArrayXd du = u.array() - u_mean, dv = v.array() - v_mean;
  const double spread = (weight * du.square()).sum();
  SectionLine line;
  line.b = (weight * du * dv).sum() / spread;
  line.a = v_mean - line.b * u_mean;
  line.u_mean = u_mean;
  line.b_deviation = std::sqrt(1 / spread);
  line.squares = (weight * (dv - line.b * du).square()).sum();
  return line;
}

Scatter scatter_about_lines(const std::vector<VectorXd>& shapes, const SectionValues& of, double freedom) {
  double squares = std::numeric_limits<double>::infinity();
  for (const VectorXd& u : shapes)
    squares = std::min(squares, section_line_through(u, of.value, of.deviation).squares);
  const double left = static_cast<double>(of.value.size()) - 2;
  const boost::math::fisher_f distribution(left, freedom);
  Scatter scatter{cdf(complement(distribution, squares / left)), 0};
  if (!(scatter.probability < significant)) return scatter;
  const Eigen::ArrayXd weight = of.deviation.array().square().inverse();
  scatter.deviation = std::sqrt((squares - left) / (weight.sum() - weight.square().sum() / weight.sum()));
  return scatter;
}

SectionTrend trend_of(const std::vector<AmplitudeLaw>& laws, LawLine AmplitudeLaw::*line, double usual,
                      const Scatter& scatter) {
  constexpr double odds = 0.05;                                    // that a quantity varies, beforehand
  constexpr std::array<double, 5> z{0, -1.57, 1.57, -0.73, 0.73};  // slopes: their variance is one
  SectionTrend trend;
  if (laws.empty()) return trend;
  const auto best = std::min_element(laws.begin(), laws.end(),
                                     [](const auto& a, const auto& b) { return a.squares < b.squares; });
  const double share = 1 / static_cast<double>(laws.size());
  const auto prior_of = [usual](const AmplitudeLaw& law) {
    return usual / (law.shape.maxCoeff() - law.shape.minCoeff());
  };
  double constant = 0, all = 0;
  std::vector<double> weights;
  for (const AmplitudeLaw& law : laws) {
    const LawLine& l = law.*line;
    const double prior = prior_of(law), together = std::hypot(prior, l.slope_deviation);
    const double as_good = share * std::exp(-0.5 * law.freedom * (law.squares / best->squares - 1));
    constant += as_good * std::exp(log_student(l.slope / l.slope_deviation, law.freedom));
    weights.push_back(odds * as_good * l.slope_deviation / together *
                      std::exp(log_student(l.slope / together, law.freedom)));
    all += weights.back();
  }
  all += constant;
  trend.constant = constant / all;
  const Index instants = best->shape.size(), rounds = static_cast<Index>(z.size());
  trend.possible.resize(instants * rounds, static_cast<Index>(laws.size()));
  trend.weight.resize(trend.possible.cols());
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const LawLine& l = laws[i].*line;
    const double prior = prior_of(laws[i]),
                 kept = prior * prior / (prior * prior + l.slope_deviation * l.slope_deviation);
    trend.weight[static_cast<Index>(i)] = weights[i] / all;
    for (Index r = 0; r < rounds; ++r) {
      const double slope =
          kept * l.slope + z[static_cast<std::size_t>(r)] * std::sqrt(kept) * l.slope_deviation;
      trend.possible.col(static_cast<Index>(i)).segment(r * instants, instants) =
          l.value + slope * (laws[i].shape.array() - l.pivot);
    }
  }
  const LawLine& l = (*best).*line;
  const boost::math::students_t of_slope(best->freedom);
  trend.probability =
      std::min(2 * cdf(complement(of_slope, std::abs(l.slope) / l.slope_deviation)), scatter.probability);
  trend.scatter = scatter.deviation;
  if (trend.probability < significant) trend.values = l.value + l.slope * (best->shape.array() - l.pivot);
  return trend;
}

}  // namespace beamid::experiments
