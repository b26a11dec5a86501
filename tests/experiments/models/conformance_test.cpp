// Conformance: every registered model keeps what the filters rely on. A new one is found by itself.
#include <gtest/gtest.h>

#include <set>

#include "experiments/joint_model.hpp"
#include "filters/central_differences.hpp"
#include "tests/experiments/models/one_coordinate.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

const std::vector<std::vector<Quantity>> observations{
    {Quantity::displacement},
    {Quantity::velocity},
    {Quantity::acceleration},
    {Quantity::displacement, Quantity::velocity},
    {Quantity::acceleration, Quantity::displacement, Quantity::velocity}};

class EveryModel : public testing::TestWithParam<std::string> {
 protected:
  std::shared_ptr<const filters::LinearMotion> make(const std::vector<Quantity>& observed) {
    return std::dynamic_pointer_cast<const filters::LinearMotion>(
        model_registry()
            .make(GetParam(), {}, at_one_point(test::one_coordinate(3.0, 515.8), observed))
            ->motion);
  }
  // A state with nothing zero in it, parameters of the right size for the system above.
  static VectorXd state_of(const filters::LinearMotion& motion) {
    const Index l = motion.motion_size(), q = motion.parameter_size();
    VectorXd state = VectorXd::LinSpaced(l + q, 0.3, 1.7);
    state[l] = 480.0;
    state[l + 1] = 9.0;
    return state;
  }
};

TEST_P(EveryModel, LabelsEveryStateAndOutput) {
  // Oracle: state [z, z', theta], of which K and C come first; outputs as observed, in that order.
  for (const auto& observed : observations) {
    const auto motion = make(observed);
    const auto states = motion->state_labels();
    const auto l = static_cast<std::size_t>(motion->motion_size());
    ASSERT_EQ(states.size(), l + static_cast<std::size_t>(motion->parameter_size()));
    EXPECT_EQ(states[l].name + " " + states[l].unit, "stiffness N/m");
    EXPECT_EQ(states[l + 1].name + " " + states[l + 1].unit, "damping N s/m");
    std::set<std::string> names;
    for (const filters::Label& label : states) {
      EXPECT_FALSE(label.unit.empty()) << label.name;
      EXPECT_TRUE(names.insert(label.name).second) << label.name << " is there twice";
    }
    const auto outputs = motion->output_labels();
    ASSERT_EQ(outputs.size(), observed.size());
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      EXPECT_EQ(outputs[i].name, to_string(observed[i]));
      EXPECT_EQ(outputs[i].unit, si_unit(observed[i]));
    }
  }
}

TEST_P(EveryModel, GivesTheDerivativesOfItsRateAndOutput) {
  // Oracle: central differences.
  const VectorXd no_input;
  for (const auto& observed : observations) {
    const auto motion = make(observed);
    const VectorXd state = state_of(*motion);
    MatrixXd given, difference;
    motion->rate_jacobian(state, no_input, given);
    const auto rate = [&](const VectorXd& z, VectorXd& value) { motion->rate(z, no_input, value); };
    filters::central_differences(rate, state, state.size(), difference);
    EXPECT_LT((given - difference).cwiseAbs().maxCoeff(), 1e-7 * given.cwiseAbs().maxCoeff());
    motion->output_jacobian(state, no_input, given);
    const auto output = [&](const VectorXd& z, VectorXd& value) { motion->output(z, no_input, value); };
    filters::central_differences(output, state, static_cast<Index>(observed.size()), difference);
    ASSERT_EQ(given.rows(), difference.rows());
    EXPECT_LT((given - difference).cwiseAbs().maxCoeff(), 1e-7 * given.cwiseAbs().maxCoeff());
  }
}

TEST_P(EveryModel, GivesTheDerivativesOfItsMotionMatrix) {
  // Oracle: central differences of A, parameter by parameter.
  const auto motion = make({Quantity::displacement});
  const Index l = motion->motion_size();
  const VectorXd state = state_of(*motion);
  for (Index j = 0; j < motion->parameter_size(); ++j) {
    MatrixXd given, above, below;
    VectorXd moved = state;
    const double step = 1e-4 * state[l + j];
    moved[l + j] = state[l + j] + step;
    motion->motion_matrix(moved, above);
    moved[l + j] = state[l + j] - step;
    motion->motion_matrix(moved, below);
    motion->motion_matrix_derivative(state, j, given);
    EXPECT_LT((given - (above - below) / (2.0 * step)).cwiseAbs().maxCoeff(), 1e-8) << j;
  }
}

TEST_P(EveryModel, LeavesItsParametersAtRest) {
  // Oracle: theta' = 0, whatever the motion does.
  for (const auto& observed : observations) {
    const auto motion = make(observed);
    VectorXd rate;
    motion->rate(state_of(*motion), {}, rate);
    EXPECT_EQ(rate.tail(motion->parameter_size()).cwiseAbs().maxCoeff(), 0.0);
  }
}

TEST_P(EveryModel, TellsTheMassAtItsOutput) {
  // Oracle: y = r q and M q'' make M / r^2 at y.
  const auto model = model_registry().make(
      GetParam(), {}, at_one_point(test::one_coordinate(3.0, 515.8, 0.5), {Quantity::velocity}));
  EXPECT_DOUBLE_EQ(model->equivalent_mass, 12.0);
}

TEST_P(EveryModel, RefusesUnknownOptionsAndWhatItCannotObserve) {
  const auto system = test::one_coordinate(3.0, 515.8);
  EXPECT_THROW(model_registry().make(GetParam(), {{"no_such_option", 1.0}},
                                     at_one_point(system, {Quantity::velocity})),
               std::invalid_argument);
  EXPECT_THROW(model_registry().make(GetParam(), {}, at_one_point(system, {})), std::invalid_argument);
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const auto& [name, entry] : model_registry().entries()) result.push_back(name);
  return result;
}
INSTANTIATE_TEST_SUITE_P(Registered, EveryModel, testing::ValuesIn(names()),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace beamid::experiments
