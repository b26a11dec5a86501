#include "filters/innovation_passes.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "filters/batch_avx2.hpp"

namespace beamid::filters {
namespace {

using algorithms::InnovationGroup, Eigen::Index, Eigen::MatrixXd;

void run_side_by_side(InnovationGroup& group) {
  if (algorithms::avx2_is_usable()) return algorithms::run_innovations_avx2(group);
  algorithms::run_innovations<2, algorithms::Baseline>(group);
}

InnovationGroup::Lane lane_of(const LinearGaussian& model, InnovationPass& pass) {
  return {model.a.data(),
          model.g.data(),
          model.h.data(),
          model.d.data(),
          model.q.data(),
          model.r.data(),
          model.start.mean.data(),
          model.start.covariance.data(),
          pass.innovations.data(),
          pass.covariances.size() > 0 ? pass.covariances.data() : nullptr,
          0.0,
          1.0,
          0,
          false};
}

void take(const InnovationGroup::Lane& lane, InnovationPass& pass) {
  pass.squares = lane.sum_of_squares;
  pass.log_determinants = std::log(lane.mantissa) + static_cast<double>(lane.exponent) * std::numbers::ln2;
  pass.failed = lane.failed || !std::isfinite(pass.cost());
}

}  // namespace

std::vector<InnovationPass> innovation_passes(const std::vector<LinearGaussian>& models,
                                              const Measurements& record, double interval, bool covariances) {
  require_even_stamps(record, interval);
  const Index n = models.front().a.rows(), m = models.front().g.cols(), p = record.outputs.rows(),
              samples = record.size();
  const std::size_t lanes = algorithms::avx2_is_usable() ? 4 : 2;
  std::vector<std::int64_t> seen(static_cast<std::size_t>(2 * p));
  constexpr std::size_t boundary = 32;  // bytes
  std::vector<double> numbers(lanes * static_cast<std::size_t>(algorithms::innovation_room(n, m, p)) +
                              boundary / sizeof(double));
  void* room = numbers.data();
  std::size_t size = numbers.size() * sizeof(double);
  std::align(boundary, 1, room, size);
  std::vector<InnovationPass> passes(models.size());
  for (InnovationPass& pass : passes) {
    pass.innovations = MatrixXd::Constant(p, samples, std::nan(""));
    if (covariances) pass.covariances.resize(p * p, samples);  // touched as far as steps differ
  }
  for (std::size_t first = 0; first < models.size(); first += lanes) {
    const std::size_t used = std::min(lanes, models.size() - first);
    std::vector<std::int64_t> step_of(static_cast<std::size_t>(samples));
    InnovationGroup group{n,
                          m,
                          p,
                          samples,
                          record.outputs.data(),
                          record.inputs.data(),
                          {},
                          step_of.data(),
                          seen.data(),
                          static_cast<double*>(room)};
    for (std::size_t lane = 0; lane < lanes; ++lane) {  // those without a model repeat the last one
      const std::size_t i = first + std::min(lane, used - 1);
      group.lanes[lane] = lane_of(models[i], passes[i]);
    }
    run_side_by_side(group);
    for (std::size_t lane = 0; lane < used; ++lane) {
      take(group.lanes[lane], passes[first + lane]);
      passes[first + lane].step_of = step_of;
    }
  }
  return passes;
}

}  // namespace beamid::filters
