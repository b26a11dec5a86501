// Oracles: modes of the mesh assembled at other values of the unknowns; central differences.
#include "experiments/models/motion/following_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fem/modes.hpp"
#include "filters/central_differences.hpp"
#include "tests/experiments/models/beam_setting.hpp"

namespace beamid::experiments::following_motion_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index modes_kept = 5;

// 40 coordinates that nobody has reduced, two regions and the tip mass asked about, pushed at 0.66 m.
ModelSetting setting() {
  ModelSetting result = test::beam_setting(fem::with_nodes(test::steel_beam(0.36), {0.44}), 20,
                                           {{Quantity::acceleration, 1.1},
                                            {Quantity::velocity, 0.5},
                                            {Quantity::strain, 0.22},
                                            {Quantity::displacement, 0.55}},
                                           {0.66});
  result.damping = fem::ModalDamping{{0.004, 0.01}};
  result.parameters = {test::in_region(0.0, 0.44),      test::in_region(0.44, 1.1),
                       test::parameter("tip_mass"),     test::of_mode("damping_ratio", 1),
                       test::parameter("mass_damping"), test::parameter("stiffness_damping")};
  result.parameters[4].guess = 0.1;
  result.parameters[5].guess = 1e-6;
  for (ParameterChoice& choice : result.parameters) choice.form = Form::linear;
  for (std::size_t j : {4u, 5u}) result.parameters[j].deviation = *result.parameters[j].guess;
  return result;
}

struct Model {
  std::unique_ptr<JointModel> joint =
      model_registry().make("beam", {{"modes", static_cast<double>(modes_kept)}}, setting());
  const FollowingMotion& motion = dynamic_cast<const FollowingMotion&>(*joint->motion);

  // Everything in motion, the unknowns moved by so much of their guesses.
  VectorXd state(const std::vector<double>& moved) const {
    VectorXd result(static_cast<Index>(motion.state_labels().size()));
    for (Index i = 0; i < result.size(); ++i) result[i] = 1e-3 * std::cos(1.0 + 2.0 * static_cast<double>(i));
    for (std::size_t j = 0; j < joint->unknowns.size(); ++j)
      result[joint->unknown_places[j]] =
          joint->unknowns[j].to_state(joint->unknowns[j].guess * (1.0 + (j < moved.size() ? moved[j] : 0.0)));
    return result;
  }
};

TEST(FollowingMotion, HasTheModesOfTheBeamAtItsUnknowns) {
  const Model model;
  const std::vector<double> moved{-0.2034, 0.1171, 0.0512};
  SecondOrderForm form;
  model.motion.evaluate(model.state(moved), form, nullptr);
  fem::Beam beam = setting().continuum->structure.beam();
  for (std::size_t j = 0; j < moved.size(); ++j) {
    const Unknown& unknown = model.joint->unknowns[j];
    const auto quantity =
        j < 2 ? fem::BeamParameter::Quantity::bending_stiffness : fem::BeamParameter::Quantity::tip_mass;
    beam = fem::with_value(beam, {quantity, unknown.region}, unknown.guess * (1.0 + moved[j]));
  }
  const fem::StructuralSystem there = fem::assemble(beam, 20, setting().continuum->points);
  const fem::Modes modes = fem::modes(there, modes_kept);
  const MatrixXd read = setting().system.outputs * modes.shape;  // the same mesh
  const MatrixXd pushed = setting().system.inputs.transpose() * modes.shape;
  const MatrixXd at_guess = setting().system.outputs * fem::modes(setting().system, modes_kept).shape;
  for (Index i = 0; i < modes_kept; ++i) {
    EXPECT_NEAR(form.stiffness(i, i) / std::pow(modes.angular_frequency[i], 2), 1.0, 2e-7);
    // Rows are those of phi, up to the scale that makes the largest displacement 1 at the guess.
    const double scale = model.motion.rows()(0, i) / at_guess(0, i);
    const double sign = read.col(i).dot(at_guess.col(i)) < 0.0 ? -1.0 : 1.0;
    for (Index k = 0; k < read.rows(); ++k)
      EXPECT_NEAR(form.rows(k, i), scale * sign * read(k, i), 1e-6 * (scale * read.col(i)).norm());
    const double push = sign * pushed(setting().forces[0], i) / scale;
    EXPECT_NEAR(form.inputs(i, 0), push, 1e-5 * std::abs(push));
  }
}

TEST(FollowingMotion, ShowsInItsJacobianWhatItDoes) {
  const Model model;
  const VectorXd state = model.state({-0.1034, 0.0671, 0.0212}), force = VectorXd::Constant(1, 0.3);
  MatrixXd jacobian;
  model.motion.output_jacobian(state, force, jacobian);
  const auto output = [&](const VectorXd& x) {
    VectorXd y;
    model.motion.output(x, force, y);
    return y;
  };
  const VectorXd size = state.cwiseAbs();
  for (Index j = 0; j < state.size(); ++j) {
    // Outputs are linear in all but the beam's properties: any step will do there, and a long one loses no
    // digits.
    const auto& places = model.joint->unknown_places;
    const bool property = std::find(places.begin(), places.begin() + 3, j) != places.begin() + 3;
    const double step = property ? 1e-5 * size[j] : size[j];
    const VectorXd by = (output(state + step * VectorXd::Unit(state.size(), j)) -
                         output(state - step * VectorXd::Unit(state.size(), j))) /
                        (2.0 * step);
    for (Index i = 0; i < by.size(); ++i)
      EXPECT_NEAR(jacobian(i, j), by[i], 2e-6 * (by.norm() + jacobian.col(j).norm())) << i << ", " << j;
  }
}

TEST(FollowingMotion, IsTheSameWhateverWasAskedBefore) {
  const Model fresh, travelled;
  SecondOrderForm form, other;
  for (const double there : {0.3, -0.2, 0.013, 0.05})
    travelled.motion.evaluate(travelled.state({there}), other, nullptr);
  travelled.motion.evaluate(travelled.state({0.021, -0.03}), other, nullptr);
  fresh.motion.evaluate(fresh.state({0.021, -0.03}), form, nullptr);
  EXPECT_EQ(form.stiffness, other.stiffness);
  EXPECT_EQ(form.rows, other.rows);
}

TEST(FollowingMotion, SaysWhereTheBeamHasNoModes) {
  const Model model;
  SecondOrderForm form;
  EXPECT_THROW(model.motion.evaluate(model.state({-1.5}), form, nullptr), std::runtime_error);
}

}  // namespace
}  // namespace beamid::experiments::following_motion_test
