// Whole frames that move sparse, against what is known of them otherwise.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/models/banded/banded_step.hpp"
#include "experiments/models/banded/continuum_motion.hpp"
#include "fem/modes.hpp"
#include "fem/structure.hpp"
#include "tests/experiments/models/banded/banded_cases.hpp"

namespace beamid::experiments::frame_mesh_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Quantity = fem::BeamParameter::Quantity;
using Kind = fem::Coordinate::Kind;

constexpr double length = 1.10;

// The cantilever of banded_beam() along x as a frame: two halves side by side that share their ends and
// stretch too. Closing a loop they are no band.
fem::Frame beam_as_frame() {
  const fem::Beam beam = banded_beam();
  fem::Frame frame;
  frame.joints = {{0.0, 0.0, "root"}, {length, 0.0, "tip"}};
  fem::Section section = beam.segments[0].section;
  section.bending_stiffness = fem::Variation(0.5) * section.bending_stiffness;
  section.mass_per_length = fem::Variation(0.5) * section.mass_per_length;
  section.axial_stiffness = fem::Variation(2.5e7);
  const fem::Frame::Member half{0, 1, section, false, false, 1.0, "all"};
  frame.members = {half, half};
  frame.supports = {{0}};
  frame.bodies = {{1, 0.36049}};
  frame.base_axis = 'y';
  return frame;
}

void describe(fem::ParametricSystem& equations, MotionDescription& description) {
  description.reference = equations.values;
  const double guess = equations.values[0];
  description.unknowns = {{"stiffness", "", guess, 0.1 * guess, Form::linear, 0.0, 10.0 * guess}};
  description.drives = {{Drive::Kind::property, 0}};
  description.mass_damping = 0.3;
  description.stiffness_damping = 2e-6;
  description.observations = {{experiments::Quantity::acceleration}, {experiments::Quantity::displacement}};
  const MatrixXd row = MatrixXd(equations.system.outputs);
  MatrixXd rows(2, row.cols());
  rows << row, row;
  equations.system.outputs = rows.sparseView();
  description.forces = {0, 1};  // at the tip, and the acceleration of the base
  description.base = 1;
  description.carried.setZero(2, 2);
  description.carried.col(1).setOnes();
}

std::unique_ptr<filters::DiscreteModel> stepping(const fem::ParametricSystem& equations,
                                                 const MotionDescription& description) {
  return filters::discretise(std::make_shared<ContinuumMotion>(equations, description), banded_interval,
                             "pade", {{}, MatrixXd::Identity(2, 2)});
}

bool is_sparse(const fem::ParametricSystem& equations, const MotionDescription& description) {
  const banded::BandedEquations matrices(equations, description);
  return !banded::BandedStep(matrices, banded_interval).is_band();
}

TEST(FrameMesh, MovesAStraightMemberAsTheBandMovesTheBeam) {
  // Oracle: the banded step of the same cantilever. Readings over 400 steps under a force and a moving base,
  // and their derivative by the stiffness, E I beside its factor.
  constexpr int elements = 100, steps = 400;
  fem::ParametricSystem beam = fem::assemble_parametric(banded_beam(), elements, {{"tip", length}},
                                                        {{Quantity::bending_stiffness, {}, {}}});
  fem::ParametricSystem frame = fem::assemble_parametric(beam_as_frame(), elements, {{"tip", 0.0, "tip.y"}},
                                                         {{Quantity::factor, {}, "all"}});
  MotionDescription of_beam, of_frame;
  describe(beam, of_beam);
  describe(frame, of_frame);
  EXPECT_FALSE(is_sparse(beam, of_beam));
  EXPECT_TRUE(is_sparse(frame, of_frame));
  const auto band = stepping(beam, of_beam), sparse = stepping(frame, of_frame);
  const double stiffness = beam.values[0];

  const auto start = [](Index coordinates, double guess) {
    VectorXd state = VectorXd::Zero(2 * coordinates + 1);
    state[2 * coordinates] = 1.02 * guess;
    return state;
  };
  VectorXd one = start(beam.system.size(), stiffness), other = start(frame.system.size(), 1.0), next;
  MatrixXd along = VectorXd::Unit(one.size(), one.size() - 1) * stiffness;
  MatrixXd along_other = VectorXd::Unit(other.size(), other.size() - 1);
  VectorXd read, expected;
  MatrixXd seen, seen_expected;
  double largest[2] = {}, apart[2] = {}, largest_slope[2] = {}, slopes_apart[2] = {};
  for (int k = 0; k < steps; ++k) {
    VectorXd input(4);
    input << std::sin(0.05 * k), 2.0 * std::cos(0.02 * k), 0.05 * std::cos(0.05 * k),
        -0.04 * std::sin(0.02 * k);
    band->output(one, input.head(2), expected);
    sparse->output(other, input.head(2), read);
    band->output_jacobian(one, input.head(2), seen_expected);
    sparse->output_jacobian(other, input.head(2), seen);
    const VectorXd slope_expected = seen_expected * along, slope = seen * along_other;
    for (int i = 0; i < 2; ++i) {
      largest[i] = std::max(largest[i], std::abs(expected[i]));
      apart[i] = std::max(apart[i], std::abs(read[i] - expected[i]));
      largest_slope[i] = std::max(largest_slope[i], std::abs(slope_expected[i]));
      slopes_apart[i] = std::max(slopes_apart[i], std::abs(slope[i] - slope_expected[i]));
    }
    band->move(one, input, next, along);
    one.swap(next);
    sparse->move(other, input, next, along_other);
    other.swap(next);
  }
  // What rounding leaves of an acceleration on either mesh (docs/theory/continuum_filter.md): 2e-9 m/s2.
  EXPECT_LT(apart[0], 4e-9);
  EXPECT_GT(largest[0], 5.0);
  EXPECT_LT(apart[1], 1e-10 * largest[1]);
  for (int i = 0; i < 2; ++i) EXPECT_LT(slopes_apart[i], 1e-9 * largest_slope[i]) << i;
}

// Two storeys of two bays.
fem::Frame two_bays() {
  fem::Section section;
  section.bending_stiffness = fem::Variation(2e6);
  section.mass_per_length = fem::Variation(80.0);
  section.axial_stiffness = fem::Variation(2e9);
  fem::Frame frame;
  for (int level = 0; level <= 2; ++level)
    for (int line = 0; line <= 2; ++line) frame.joints.push_back({5.0 * line, 3.2 * level, {}});
  for (int level = 1; level <= 2; ++level)
    for (int line = 0; line <= 2; ++line) {
      frame.members.push_back(
          {3 * level - 3 + line, 3 * level + line, section, false, false, 1.0, "columns"});
      if (line > 0)
        frame.members.push_back(
            {3 * level + line - 1, 3 * level + line, section, false, false, 1.0, "girders"});
    }
  for (int line = 0; line <= 2; ++line) frame.supports.push_back({line});
  return frame;
}

TEST(FrameMesh, AFineFrameKeepsTheFrequencyAndTheEnergy) {
  // Oracle: R(i omega dt) in closed form for the frequency of the mesh, undamped, 1,000 steps of 5 ms.
  constexpr double interval = 5e-3;
  const fem::ParametricSystem equations =
      fem::assemble_parametric(two_bays(), 60, {{"roof", 0.0, "9.x"}}, {});
  MotionDescription description;
  description.observations = {{experiments::Quantity::displacement}};
  EXPECT_TRUE(is_sparse(equations, description));
  const fem::StructuralSystem& system = equations.system;
  const Index n = system.size();
  ASSERT_GT(n, 1700);
  const fem::Modes modes = fem::modes(system, 1);
  const double omega = modes.angular_frequency[0];
  const auto model = filters::discretise(std::make_shared<ContinuumMotion>(equations, description), interval,
                                         "pade", {{}, MatrixXd::Identity(1, 1)});
  VectorXd state = VectorXd::Zero(2 * n), next;
  state.head(n) = modes.shape.col(0);
  const int steps = 1000;
  for (int k = 0; k < steps; ++k) {
    model->transition(state, {}, next);
    state.swap(next);
  }
  const VectorXd momentum = system.mass * modes.shape.col(0);
  const double cosine = momentum.dot(state.head(n)), sine = -momentum.dot(state.segment(n, n)) / omega;
  const std::complex<double> z(0.0, omega * interval);
  const double turn = std::arg((12.0 + 6.0 * z + z * z) / (12.0 - 6.0 * z + z * z));
  EXPECT_NEAR(std::hypot(cosine, sine), 1.0, 1e-11);
  EXPECT_NEAR(std::remainder(std::atan2(sine, cosine) - steps * turn, 2.0 * std::numbers::pi), 0.0, 1e-10);
}

TEST(FrameMesh, EliminatesWithoutGrowth) {
  // Oracle: entries grow less than threefold [george2002].
  const fem::ParametricSystem equations =
      fem::assemble_parametric(two_bays(), 20, {{"roof", 0.0, "9.x"}}, {});
  const banded::BandedEquations matrices(equations, {});
  banded::BandedStep step(matrices, 5e-3);
  step.watch_growth(true);
  step.factor(matrices);
  EXPECT_LE(step.growth(), 3.0);
  EXPECT_GT(step.growth(), 0.5);
}

}  // namespace
}  // namespace beamid::experiments::frame_mesh_test
