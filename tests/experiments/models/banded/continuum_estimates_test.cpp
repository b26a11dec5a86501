// What filters estimate from the mesh, banded or sparse, and from the same as dense matrices
// (dense_continuum.hpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fem/modes.hpp"
#include "filters/filter.hpp"
#include "tests/experiments/models/banded/banded_cases.hpp"

namespace beamid::experiments::continuum_estimates_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// What a filter estimates from a record of a motion in the first two modes, with the last estimate's mean and
// deviations.
std::pair<VectorXd, VectorXd> identify(const BandedCase& given, const std::string& filter_name,
                                       std::unique_ptr<filters::DiscreteModel> model,
                                       const MatrixXd& record) {
  const StateLayout places = layout(given.description, given.equations.system.size());
  const Index n = places.coordinates, q = static_cast<Index>(given.description.unknowns.size());
  const fem::Modes modes = fem::modes(given.equations.system, 2);
  const auto offsets = static_cast<Index>(places.offsets.size());
  VectorXd mean = VectorXd::Zero(places.size);
  MatrixXd factor = MatrixXd::Zero(places.size, 4 + q + offsets);
  for (Index i = 0; i < 2; ++i) {
    factor.col(2 * i).head(n) = 0.005 * modes.shape.col(i);
    factor.col(2 * i + 1).segment(n, n) = 0.005 * modes.angular_frequency[i] * modes.shape.col(i);
    mean.head(n) += 0.01 / static_cast<double>(1 + 9 * i) * modes.shape.col(i);
  }
  for (Index j = 0; j < q; ++j) {
    const Unknown& unknown = given.description.unknowns[static_cast<std::size_t>(j)];
    mean[places.unknowns + j] = unknown.to_state(unknown.guess);
    factor(places.unknowns + j, 4 + j) = unknown.deviation / unknown.slope(mean[places.unknowns + j]);
  }
  for (Index k = 0; k < offsets; ++k)
    factor(places.offsets[static_cast<std::size_t>(k)].place, 4 + q + k) = 0.1;
  auto filter = filters::filter_registry().make(filter_name, {}, std::move(model));
  if (filter_name == "ekf")
    filter->reset({mean, factor * factor.transpose()});
  else
    filter->reset({mean, {}, factor});
  const VectorXd input = VectorXd::LinSpaced(2, 0.5, 1.0);
  for (Index k = 0; k < record.cols(); ++k) {
    filter->correct(record.col(k), input);
    filter->predict(input);
  }
  return {filter->estimate().mean, filter->estimate().deviations()};
}

// Noisy readings of a motion in the first two modes, the parameters 2 % off their guess.
MatrixXd record_of(const BandedCase& given, filters::DiscreteModel& model) {
  const StateLayout places = layout(given.description, given.equations.system.size());
  const Index n = places.coordinates, samples = 100;
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  VectorXd state = VectorXd::Zero(places.size), next, read;
  const fem::Modes modes = fem::modes(given.equations.system, 2);
  state.head(n) = 0.012 * modes.shape.col(0) + 0.001 * modes.shape.col(1);
  for (std::size_t j = 0; j < given.description.unknowns.size(); ++j) {
    const Unknown& unknown = given.description.unknowns[j];
    state[places.unknowns + static_cast<Index>(j)] = unknown.to_state(unknown.guess * 1.02);
  }
  MatrixXd record(static_cast<Index>(given.description.observations.size()), samples);
  const VectorXd input = VectorXd::LinSpaced(2, 0.5, 1.0);
  for (Index k = 0; k < samples; ++k) {
    model.output(state, input, read);
    for (Index i = 0; i < record.rows(); ++i)
      record(i, k) = read[i] + std::sqrt(model.output_noise()(i, i)) * normal(generator);
    model.transition(state, input, next);
    state.swap(next);
  }
  return record;
}

void expect_equal_estimates(const BandedCase& given, const std::string& oracle) {
  auto [banded, dense] = banded_and_dense(given);
  const MatrixXd record = record_of(given, *dense);
  const auto [mean, deviations] = identify(given, "low_rank_ekf", std::move(banded), record);
  const auto [expected, expected_deviations] = identify(given, oracle, std::move(dense), record);
  const StateLayout places = layout(given.description, given.equations.system.size());
  const Index n = places.coordinates, q = static_cast<Index>(given.description.unknowns.size());
  for (Index j = places.unknowns; j < places.unknowns + q; ++j) {
    EXPECT_NEAR(mean[j], expected[j], 1e-8 * std::abs(expected[j])) << j - places.unknowns;
    EXPECT_NEAR(deviations[j], expected_deviations[j], 1e-8 * expected_deviations[j]) << j - places.unknowns;
  }
  EXPECT_LT((mean - expected).head(n).norm(), 1e-8 * expected.head(n).norm());
  EXPECT_LT((mean - expected).segment(n, n).norm(), 1e-8 * expected.segment(n, n).norm());
}

TEST(ContinuumMotion, EstimatesAreThoseOfTheDenseMatrices) {
  // Oracle: the same filter on the dense scheme `pade`.
  for (const BandedCase& given : all_cases()) {
    SCOPED_TRACE(given.name);
    expect_equal_estimates(given, "low_rank_ekf");
  }
}

TEST(ContinuumMotion, EstimatesAreThoseOfTheFilterThatCarriesTheWholeCovariance) {
  // Oracle: `ekf` on the dense scheme. It observes displacement and velocity: an acceleration is a small
  // difference of the coordinates, by which a covariance of all of them loses twice as many digits as its
  // factor.
  for (BandedCase given : all_cases()) {
    SCOPED_TRACE(given.name);
    given.description.observations = {{Quantity::displacement}, {Quantity::velocity}};
    given.equations.system.outputs = fem::SparseMatrix(given.equations.system.outputs.topRows(2));
    expect_equal_estimates(given, "ekf");
  }
}

}  // namespace
}  // namespace beamid::experiments::continuum_estimates_test
