// A chain of one storey against the models of one coordinate.
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/models/joint_model.hpp"
#include "tests/experiments/models/storey_setting.hpp"

namespace beamid::experiments::one_storey_test {
namespace {

using Eigen::Index, Eigen::VectorXd;
using test::asked, test::bouc_wen, test::setting_of, test::spring;

// One storey is the model of one coordinate. Oracle: models duffing and bouc_wen, to rounding.
TEST(OneStorey, IsTheModelOfOneCoordinate) {
  const double mass = 800.0, stiffness = 3.0e5, damping = 700.0;
  struct Case {
    std::string law;
    filters::Options options;
    std::vector<std::string> quantities;
    std::vector<double> values;
  };
  const std::vector<Case> cases{
      {"duffing", {{"cubic_stiffness_n_per_m3", 4.0e7}}, {"cubic_stiffness"}, {4.0e7}},
      {"bouc_wen", bouc_wen, {"post_yield_ratio", "hysteresis_beta", "hysteresis_gamma"}, {0.3, 60.0, 25.0}}};
  for (const Case& one : cases) {
    ModelSetting setting =
        setting_of({{mass}, {stiffness}, {damping}, {3}}, {spring(1, one.law, one.options)});
    for (const std::string& quantity : one.quantities) setting.parameters.push_back(asked(quantity));
    const auto coordinate = model_registry().make(one.law, {}, setting);
    setting.parameters.push_back(asked("storey_stiffness"));
    setting.parameters.push_back(asked("storey_damping"));
    const auto chain = model_registry().make("beam", {}, setting);

    const auto state = [&](const JointModel& model, double x, double v, double slip) {
      VectorXd z = VectorXd::Zero(static_cast<Index>(model.motion->state_labels().size()));
      z.head<2>() << x, v;
      for (const Index place : model.slips) z[place] = slip;
      for (std::size_t j = 0; j < model.unknowns.size(); ++j) {
        const std::string& quantity = model.unknowns[j].quantity;
        double& entry = z[model.unknown_places[j]];
        if (quantity.ends_with("stiffness") && quantity != "cubic_stiffness") entry = 1.2 * stiffness;
        if (quantity.ends_with("damping")) entry = 1.5 * damping;
        if (quantity == "mass") entry = mass;
        for (std::size_t i = 0; i < one.quantities.size(); ++i)
          if (quantity == one.quantities[i]) entry = 0.9 * one.values[i];
      }
      return z;
    };
    const Eigen::Vector2d input(130.0, 0.7);
    for (const double x : {-0.03, 0.02})
      for (const double v : {0.4, -0.1}) {
        const VectorXd z = state(*chain, x, v, 0.4 * x), w = state(*coordinate, x, v, 0.4 * x);
        VectorXd rate, expected, read, wanted;
        chain->motion->rate(z, input, rate);
        coordinate->motion->rate(w, input, expected);
        EXPECT_NEAR(rate[1], expected[1], 1e-12 * std::abs(expected[1])) << one.law;
        if (!chain->slips.empty()) {
          EXPECT_EQ(rate[chain->slips[0]], expected[2]);
        }
        chain->motion->output(z, input, read);
        coordinate->motion->output(w, input, wanted);
        for (Index i = 0; i < 3; ++i) EXPECT_NEAR(read[i], wanted[i], 1e-12 * std::abs(wanted[i])) << i;
      }
  }
}

}  // namespace
}  // namespace beamid::experiments::one_storey_test
