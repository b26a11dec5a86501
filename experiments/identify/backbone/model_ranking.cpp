#include "experiments/identify/backbone/model_ranking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace beamid::experiments {

double ModelRanking::noise() const {
  double least = std::numeric_limits<double>::infinity();
  for (const RecordFit& fit : fits)
    if (fit.residuals.size() > 0)
      least = std::min(least, fit.residuals.squaredNorm() / (count_ - static_cast<double>(fit.unknowns)));
  const double smallest = 1e-7 * peak_;
  return std::max(std::sqrt(least), smallest);
}

double ModelRanking::bic(const RecordFit& fit, double noise) const {
  return std::log(count_) * static_cast<double>(fit.unknowns) + fit.residuals.squaredNorm() / (noise * noise);
}

const RecordFit* ModelRanking::best_of(const std::string& name, double noise) const {
  const RecordFit* best = nullptr;
  for (const RecordFit& fit : fits)
    if (fit.name == name &&
        (!best || (fit.converged && (!best->converged || bic(fit, noise) < bic(*best, noise)))))
      best = &fit;
  return best;
}

const RecordFit* ModelRanking::best_spring() const {
  const double s = noise();
  const RecordFit *elastic = best_of("elastic", s), *masing = best_of("masing", s);
  const RecordFit* better = elastic && elastic->converged ? elastic : nullptr;
  if (masing && masing->converged && (!better || bic(*masing, s) < bic(*better, s))) better = masing;
  return better;
}

std::vector<RecordFit> ModelRanking::best_of_each(double noise, double scale) const {
  const double variance = noise * noise, normalised = std::log(2 * std::numbers::pi * variance);
  std::vector<RecordFit> each;
  for (const char* const name : {"linear", "elastic", "masing", "between", "duffing", "bouc_wen"}) {
    const RecordFit* const best = best_of(name, noise);
    if (!best) continue;
    RecordFit fit = *best;
    if (fit.residuals.size() > 0) {
      fit.log_likelihood = -0.5 * count_ * normalised - 0.5 * fit.residuals.squaredNorm() / variance;
      fit.bic = bic(fit, noise) + count_ * normalised;
      fit.spring.covariance *= scale;
      fit.masing_deviation *= std::sqrt(scale);
    }
    each.push_back(std::move(fit));
  }
  return each;
}

}  // namespace beamid::experiments
