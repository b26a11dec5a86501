#include "experiments/identify/sensing/sensing_draws.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "experiments/models/estimates.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// B with B B^T = P, which may be singular.
MatrixXd symmetric_root(const MatrixXd& p) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(p);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace

MatrixXd drawn_rows(const SensingModel& model, const filters::LinearGaussian& form,
                    const filters::KalmanPass& pass, const MatrixXd& rows, const MatrixXd& feed,
                    filters::RandomStream& random) {
  filters::Measurements record = model.record();
  const Index n = form.a.rows(), samples = record.size();
  const MatrixXd moved = symmetric_root(form.q), noise = symmetric_root(form.r);
  VectorXd x = symmetric_root(form.start.covariance) * random.normal(n, 1);
  MatrixXd own(rows.rows(), samples);
  for (Index k = 0; k < samples; ++k) {
    own.col(k) = rows * x;
    record.outputs.col(k) -= form.h * x + noise * random.normal(form.h.rows(), 1);
    x = (form.a * x + moved * random.normal(n, 1)).eval();
  }
  return filters::smoothed_means(form, record, filters::kalman_pass(form, record, pass), rows, feed) + own;
}

void add_damages(const Experiment& experiment, const SensingModel& model, const filters::LinearGaussian& form,
                 const filters::KalmanPass& pass, const MatrixXd& rows, const MatrixXd& feed,
                 SensingStudy& study) {
  constexpr int draws = 40;
  const std::vector<VirtualSensor>& sensors = experiment.virtual_sensors;
  const auto fails = [](const VirtualSensor& one) {
    return one.quantity == Quantity::strain && !one.bending_moment;
  };
  if (std::none_of(sensors.begin(), sensors.end(), fails)) return;
  std::vector<std::vector<FatigueDamage>> found(sensors.size());
  for (int draw = 0; draw < draws; ++draw) {
    filters::RandomStream random(1, static_cast<std::uint64_t>(draw));
    const MatrixXd histories = drawn_rows(model, form, pass, rows, feed.topRows(rows.rows()), random);
    for (std::size_t i = 0; i < sensors.size(); ++i)
      if (fails(sensors[i]))
        found[i].push_back(
            fatigue_damage(histories.row(static_cast<Index>(i)).transpose(), *experiment.fatigue));
  }
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (found[i].empty()) continue;
    SensingStudy::SensorDamage one{sensors[i].name, {}};
    double logs = 0.0, squares = 0.0;
    for (const FatigueDamage& drawn : found[i]) {
      one.damage.damage += drawn.damage / draws;
      one.damage.cycles += drawn.cycles / draws;
      one.damage.narrow_band += drawn.narrow_band / draws;
      logs += std::log(drawn.damage) / draws;
    }
    for (const FatigueDamage& drawn : found[i])
      squares += std::pow(std::log(drawn.damage) - logs, 2) / (draws - 1);
    const double half = quantile_95 * std::sqrt(squares);
    one.lower_95 = std::exp(logs - half), one.upper_95 = std::exp(logs + half);
    const FatigueLaw& law = *experiment.fatigue;
    one.damage.equivalent_range =
        law.strain_range * std::pow(one.damage.damage * law.cycles / one.damage.cycles, 1.0 / law.exponent);
    study.damages.push_back(std::move(one));
  }
}

}  // namespace beamid::experiments
