// A part of a chain between measured sections, identified by forward Euler: what its step does to the
// dashpots of cut storeys and of those inside. Oracle: the first term of the law, dt K
// (many_degrees_of_freedom.md).
#include <gtest/gtest.h>

#include <memory>

#include "experiments/studies/atlas/many_degrees.hpp"
#include "filters/discrete_model.hpp"
#include "filters/filter_run.hpp"
#include "filters/step_input.hpp"

namespace beamid::experiments::part_of_chain_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Floors 2 and 3 of the chain of three above floor 1, whose displacement and velocity are inputs. State
/// [x_2, x_3, x_2', x_3', k_2, k_3, c_2, c_3].
class UpperPart final : public filters::LinearMotion {
 public:
  Index input_size() const override { return 2; }
  Index motion_size() const override { return 4; }
  Index parameter_size() const override { return 4; }
  void motion_matrix(const VectorXd& state, MatrixXd& matrix) const override {
    matrix.setZero(4, 4);
    matrix.topRightCorner(2, 2).setIdentity();
    matrix.bottomLeftCorner(2, 2) = rows(state[4], state[5]);
    matrix.bottomRightCorner(2, 2) = rows(state[6], state[7]);
  }
  void motion_matrix_derivative(const VectorXd&, Index j, MatrixXd& matrix) const override {
    matrix.setZero(4, 4);
    matrix.block(2, j < 2 ? 0 : 2, 2, 2) = rows(j % 2 == 0 ? 1.0 : 0.0, j % 2 == 0 ? 0.0 : 1.0);
  }
  void input_matrix(const VectorXd& state, MatrixXd& matrix) const override {
    matrix.setZero(4, 2);
    matrix.row(2) << state[4] / lower, state[6] / lower;
  }
  void input_matrix_derivative(const VectorXd&, Index j, MatrixXd& matrix) const override {
    matrix.setZero(4, 2);
    if (j % 2 == 0) matrix(2, j / 2) = 1.0 / lower;
  }
  std::vector<filters::Label> state_labels() const override {
    return std::vector<filters::Label>(8, filters::Label{"z", "1"});
  }
  std::vector<filters::Label> output_labels() const override {
    return std::vector<filters::Label>(2, filters::Label{"x", "m"});
  }
  void output(const VectorXd& state, const VectorXd&, VectorXd& output) const override {
    output = state.head(2);
  }

 private:
  static constexpr double lower = 800.0, upper = 900.0;  // masses [kg]
  static MatrixXd rows(double below, double above) {
    MatrixXd matrix(2, 2);
    matrix << -(below + above) / lower, above / lower, above / upper, -above / upper;
    return matrix;
  }
};

// [k_2, k_3, c_2, c_3] that an extended Kalman filter finds.
VectorXd found_in_part(const std::string& scheme, double dt) {
  UnknownFamily family = chain_family(3, dt, "storeys");
  family.velocities = true;
  family.samples = static_cast<Index>(4.0 / dt);
  const MatrixXd whole = exact_record(family).outputs;  // x, x'
  filters::Measurements record = exact_record(family);
  record.outputs = whole.middleRows(1, 2);
  MatrixXd section(2, whole.cols());
  section << whole.row(0), whole.row(3);
  record.inputs =
      filters::input_path(1, record.time, section, 1e-6 * dt).columns;  // straight between samples
  const VectorXd truth = family.values();
  VectorXd state(8), scale(8);
  state << whole.col(0).segment(1, 2), whole.col(0).tail(2), truth[1], truth[2], truth[4], truth[5];
  const double noise = 1e-9;
  for (const double share : {1.0, 1e-1, 1e-2}) {
    scale << 0.01, 0.01, 1.0, 1.0, share * 1e5 * VectorXd::Ones(2), share * 3e3 * VectorXd::Ones(2);
    const auto filter =
        filters::filter_registry().make("ekf", {},
                                        filters::discretise(std::make_shared<UpperPart>(), dt, scheme,
                                                            {{}, noise * noise * MatrixXd::Identity(2, 2)}));
    const filters::FilterRun run =
        filters::run(*filter, {state, MatrixXd(scale.cwiseAbs2().asDiagonal())}, record);
    EXPECT_FALSE(run.failure);
    state.tail(4) = run.last.mean.tail(4);
  }
  return state.tail(4) - VectorXd(Eigen::Vector4d(truth[1], truth[2], truth[4], truth[5]));
}

TEST(PartOfAChain, HasDtKInTheDashpotsOfCutStoreysToo) {
  constexpr double dt = 5e-4, stiffnesses[] = {1.5e6, 1.2e6};
  for (const auto& [scheme, times] : {std::pair{"forward_euler", 1.0}, {"backward_euler", -1.0}}) {
    const VectorXd change = found_in_part(scheme, dt);
    for (Index j = 0; j < 2; ++j)
      EXPECT_NEAR(change[2 + j] / (stiffnesses[j] * dt), times, 0.03) << scheme << ", storey " << j + 2;
  }
}

}  // namespace
}  // namespace beamid::experiments::part_of_chain_test
