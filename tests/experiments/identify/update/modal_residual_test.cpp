// Derivatives of modal residuals, pairing, weights. Oracle of the derivatives: central differences.
#include "experiments/identify/update/modal_residual.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "experiments/identify/update/modal_model.hpp"
#include "experiments/identify/update/mode_pairing.hpp"
#include "filters/random.hpp"
#include "tests/experiments/identify/update/update_cases.hpp"

namespace beamid::experiments::modal_residual_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Largest difference between the Jacobian and central differences with steps h, relative to its column.
double derivative_error(const Experiment& experiment, Index modes, double error_of_shapes, double h) {
  std::vector<fem::Point> points;
  for (const Sensor& sensor : experiment.sensors)
    points.push_back({"s" + std::to_string(points.size()), sensor.position.value()});
  const ModalModel model(experiment.structure, experiment.elements, points, asked_parameters(experiment),
                         modes + 2);
  const SearchSpace space(model.asked());
  VectorXd truth = VectorXd::Zero(space.size());
  for (Index j = 0; j < truth.size(); ++j) truth[j] = 0.2 * std::cos(static_cast<double>(j));
  ModalData data = predicted_data(experiment, space.physical(truth), modes);
  for (std::size_t i = 0; i < data.modes.size(); ++i)
    data.modes[i].shape +=
        error_of_shapes * filters::RandomStream(7, i).normal(data.modes[i].shape.size(), 1);
  const ModalResidual residual(model, space, data, {});
  const VectorXd x = 0.5 * truth;
  const MatrixXd jacobian = residual.at(x, true).jacobian;
  double error = 0.0;
  for (Index j = 0; j < x.size(); ++j) {
    VectorXd above = x, below = x;
    above[j] += h;
    below[j] -= h;
    const VectorXd slope =
        (residual.at(above, false).residual - residual.at(below, false).residual) / (2 * h);
    error = std::max(error, (jacobian.col(j) - slope).norm() / slope.norm());
  }
  return error;
}

constexpr const char* cantilever = R"toml(
[beam]
length_m = 1.0
width_m = 0.03
height_m = 0.005
youngs_modulus_pa = 2.1e11
density_kg_per_m3 = 7850
tip_mass_kg = 0.2
elements = {}
[[parameters]]
quantity = "bending_stiffness"
from_m = 0
to_m = 0.5
[[parameters]]
quantity = "bending_stiffness"
from_m = 0.5
to_m = 1.0
[[parameters]]
quantity = "tip_mass"
[[sensors]]
position_m = 0.25
[[sensors]]
position_m = 0.5
[[sensors]]
position_m = 1.0
)toml";

Experiment cantilever_of(int elements) {
  std::string text = cantilever;
  return experiment_of(text.replace(text.find("{}"), 2, std::to_string(elements)));
}

TEST(ModalResidual, HasTheDerivativesOfAChain) {
  EXPECT_LT(derivative_error(four_storeys(), 4, 0.05, 1e-5), 1e-7);
}

TEST(ModalResidual, HasTheDerivativesOfABeamWithATipMass) {
  EXPECT_LT(derivative_error(cantilever_of(20), 3, 0.05, 5e-4), 1e-6);
}

// Solved through the strain factors, with the lowest modes and the static rest.
TEST(ModalResidual, HasTheDerivativesOfALargeSystem) {
  EXPECT_LT(derivative_error(cantilever_of(120), 3, 0.05, 1e-4), 1e-4);
}

// Oracle: |psi|^2 (1 - MAC) / s^2, for shapes of any sign and scale.
TEST(ModalResidual, OfAShapeIsItsMac) {
  const Experiment experiment = four_storeys();
  std::vector<fem::Point> points;
  for (int floor = 1; floor <= 4; ++floor) points.push_back({"s" + std::to_string(floor), double(floor)});
  const ModalModel model(experiment.structure, experiment.elements, points, asked_parameters(experiment), 4);
  const SearchSpace space(model.asked());
  ModalData data = predicted_data(experiment, model.described().values, 1);
  data.modes[0].shape = VectorXd{{-3.0, -5.0, -9.0, -8.0}};
  data.modes[0].shape_deviation = 0.5;
  const ModalResidual residual(model, space, data, {0.01, 0.0});
  const auto value = residual.at(VectorXd::Zero(4), false);
  const double mac = modal_assurances(data, value.modes)(0, 0);
  EXPECT_NEAR(value.residual.tail(4).squaredNorm(), data.modes[0].shape.squaredNorm() * (1 - mac) / 0.25,
              1e-9);
  EXPECT_EQ(residual.independent(value), 4);  // a frequency, and four components of one scale
}

// Oracle: all permutations.
TEST(BestAssignment, IsTheBestOfAllPermutations) {
  for (std::uint64_t trial = 0; trial < 50; ++trial) {
    const MatrixXd scores = filters::RandomStream(3, trial).normal(4, 6);
    std::vector<Index> order(6);
    std::iota(order.begin(), order.end(), 0);
    double best = -1e9;
    do {
      double sum = 0;
      for (Index i = 0; i < 4; ++i) sum += scores(i, order[static_cast<std::size_t>(i)]);
      best = std::max(best, sum);
    } while (std::next_permutation(order.begin(), order.end()));
    double sum = 0;
    const auto assigned = best_assignment(scores);
    for (Index i = 0; i < 4; ++i) sum += scores(i, assigned[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(sum, best, 1e-12);
  }
}

}  // namespace
}  // namespace beamid::experiments::modal_residual_test
