// The whole mesh under measured forces. Oracle: all of its modes, each moved exactly under the same force.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "beamid/testing/oscillator.hpp"
#include "experiments/models/banded/continuum_motion.hpp"
#include "fem/beam.hpp"
#include "filters/batch_estimator.hpp"
#include "filters/discrete_model.hpp"
#include "filters/scheme.hpp"
#include "filters/step_input.hpp"
#include "tests/experiments/models/banded/dense_continuum.hpp"

namespace beamid::experiments::forced_mesh_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using filters::InputPaths;
using std::numbers::pi;

constexpr double interval = 1e-3, ratio = 0.005;
constexpr Index samples = 500, damped = 8;

struct Mesh {
  fem::ParametricSystem equations;
  MotionDescription description;
};

// A force at the middle, accelerometers there and at the tip, a displacement at the tip.
Mesh mesh(int elements) {
  fem::Cantilever beam;
  beam.length = 1.10;
  beam.bending_stiffness = 2.12e11 * fem::rectangle_second_moment(0.060, 0.006);
  beam.mass_per_length = 3.055 / 1.10;
  beam.tip_mass = 0.36049;
  Mesh made{
      fem::assemble_parametric(beam, elements, {{"middle", 0.55}, {"tip", 1.10}},
                               {fem::BeamParameter{fem::BeamParameter::Quantity::bending_stiffness, {}}}),
      {}};
  MotionDescription& description = made.description;
  description.reference = made.equations.values;
  const double guess = description.reference[0];
  description.unknowns.push_back({"stiffness", "", guess, 0.1 * guess, Form::linear, 0.0, 10.0 * guess});
  description.drives.push_back({Drive::Kind::property, 0});
  description.damped_modes =
      test::damped_modes(made.equations, std::vector<double>(static_cast<std::size_t>(damped), ratio));
  description.observations = {{Quantity::acceleration}, {Quantity::acceleration}, {Quantity::displacement}};
  const MatrixXd rows = made.equations.system.outputs;
  MatrixXd observed(3, rows.cols());
  observed << rows.row(0), rows.row(1), rows.row(1);
  made.equations.system.outputs = observed.sparseView();
  description.forces = {0};
  return made;
}

// Random, below `highest` [Hz].
MatrixXd force(double highest) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * pi);
  MatrixXd sampled = MatrixXd::Zero(1, samples);
  for (double f = 1.0; f < highest; f += 1.7) {
    const double start = phase(random);
    for (Index k = 0; k < samples; ++k)
      sampled(0, k) += std::sin(2.0 * pi * f * interval * static_cast<double>(k) + start);
  }
  // from rest
  for (Index k = 0; k < 100; ++k) sampled(0, k) *= std::pow(std::sin(0.005 * pi * static_cast<double>(k)), 2);
  return sampled;
}

MatrixXd read_of_the_mesh(const Mesh& mesh, const InputPaths& path) {
  const auto model = filters::discretise(std::make_shared<ContinuumMotion>(mesh.equations, mesh.description),
                                         interval, "pade", {{}, MatrixXd::Identity(3, 3)});
  VectorXd state = VectorXd::Zero(2 * mesh.equations.system.size() + 1), next, read;
  state[state.size() - 1] = mesh.description.unknowns[0].guess;
  MatrixXd result(3, samples);
  for (Index k = 0; k < samples; ++k) {
    model->output(state, path.columns.col(k), read);
    result.col(k) = read;
    model->transition(state, path.columns.col(k), next);
    state.swap(next);
  }
  return result;
}

MatrixXd read_of_all_modes(const Mesh& mesh, const InputPaths& path) {
  const fem::StructuralSystem& system = mesh.equations.system;
  const fem::Modes modes = fem::modes(system, system.size());
  const MatrixXd shown = system.outputs * modes.shape, inputs = MatrixXd(system.inputs);
  const VectorXd pushed = modes.shape.transpose() * inputs.col(0);
  const auto scheme = filters::scheme_registry().make("exponential", {});
  const beamid::test::Oscillator one(1.0, 1, true);
  MatrixXd result = MatrixXd::Zero(3, samples);
  for (Index i = 0; i < modes.size(); ++i) {
    const double omega = modes.angular_frequency[i];
    VectorXd z(4), next;
    z << 0.0, 0.0, omega * omega, 2.0 * (i < damped ? ratio : 0.0) * omega;
    for (Index k = 0; k < samples; ++k) {
      const VectorXd input = pushed[i] * path.columns.col(k);
      const double acceleration = input[0] - z[2] * z[0] - z[3] * z[1];
      result.col(k).head(2) += shown.col(i).head(2) * acceleration;
      result(2, k) += shown(2, i) * z[0];
      scheme->step(one, z, input, interval, next, nullptr);
      z.swap(next);
    }
  }
  return result;
}

VectorXd relative_error(const MatrixXd& found, const MatrixXd& expected) {
  return (found - expected).rowwise().norm().cwiseQuotient(expected.rowwise().norm());
}

InputPaths path_of(int degree, double highest) {
  const VectorXd time = VectorXd::LinSpaced(samples, 0.0, interval * static_cast<double>(samples - 1));
  return filters::input_path(degree, time, force(highest), 1e-9);
}

TEST(ForcedMesh, FollowsABandLimitedForceAsAllItsModesDo) {
  // Held, the force left 90 % of the acceleration at its own place with 10 elements and 214 % with 40: modes
  // far above the sampling rate do not follow jumps.
  for (const int elements : {10, 40}) {
    const Mesh given = mesh(elements);
    const InputPaths path = path_of(4, 60.0);
    const VectorXd error = relative_error(read_of_the_mesh(given, path), read_of_all_modes(given, path));
    EXPECT_LT(error.maxCoeff(), 2e-4) << elements << ": " << error.transpose();
  }
}

TEST(ForcedMesh, FollowsAStraightForceButForTheKinks) {
  const Mesh given = mesh(20);
  const InputPaths path = path_of(1, 60.0);
  const VectorXd error = relative_error(read_of_the_mesh(given, path), read_of_all_modes(given, path));
  EXPECT_LT(error[0], 0.15) << error.transpose();
  EXPECT_LT(error[1], 0.05) << error.transpose();
  EXPECT_LT(error[2], 1e-4) << error.transpose();
}

TEST(ForcedMesh, TellsItsStiffness) {
  // Oracle: the stiffness of the motion in all modes; R says that each sensor errs by 0.1 % of what it reads.
  const Mesh given = mesh(40);
  const InputPaths path = path_of(4, 60.0);
  const MatrixXd read = read_of_all_modes(given, path);
  const VectorXd noise = 1e-3 * read.rowwise().norm() / std::sqrt(static_cast<double>(samples));
  const auto model =
      filters::discretise(std::make_shared<ContinuumMotion>(given.equations, given.description), interval,
                          "pade", {{}, noise.cwiseAbs2().asDiagonal()});
  const double stiffness = given.description.unknowns[0].guess;
  VectorXd state = VectorXd::Zero(2 * given.equations.system.size() + 1);
  state[state.size() - 1] = 1.03 * stiffness;
  const VectorXd time = VectorXd::LinSpaced(samples, 0.0, interval * static_cast<double>(samples - 1));
  const filters::BatchEstimate found =
      filters::estimate_batch(*model, state, stiffness * VectorXd::Unit(state.size(), state.size() - 1),
                              {time, read, path.columns}, {.tolerance = 1e-3, .first_samples = 50});
  ASSERT_EQ(found.status, filters::BatchStatus::converged) << found.reason;
  const double deviation = std::sqrt(found.covariance(0, 0));
  EXPECT_LT(std::abs(found.state[state.size() - 1] / stiffness - 1.0), deviation);
  EXPECT_LT(deviation, 1e-4);
}

}  // namespace
}  // namespace beamid::experiments::forced_mesh_test
