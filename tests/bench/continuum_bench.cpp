// A joint filter on the whole finite-element beam: processor time per sample, for meshes of several sizes,
// and the digits that a step keeps.
//
//     continuum_bench cost [SAMPLES] [ELEMENTS ...]     one line per mesh: coordinates, and microseconds
//     continuum_bench record [ELEMENTS] [SECONDS]       a record at 1 kHz through the filter low_rank_ekf
//     continuum_bench digits [ELEMENTS ...]             error of the frequency that the steps show
//
// The beam is the study's cantilever with a tip mass; unknown are its bending stiffness, the tip mass, the
// damping ratio of its first three modes and the accelerometer's offset; with the start of these three modes
// uncertain the covariance has rank 10.
#include <Eigen/SparseCholesky>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/models/banded/banded_step.hpp"
#include "fem/beam.hpp"
#include "fem/modes.hpp"
#include "fem/stiffness_solver.hpp"
#include "filters/filter.hpp"
#include "tests/bench/mesh_problem.hpp"

namespace {

using namespace beamid;
using namespace beamid::bench;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using experiments::Drive, experiments::Quantity;

constexpr double interval = 1e-3;  // [s]

fem::Beam study_beam(double tip_mass) {
  fem::Cantilever beam;
  beam.length = 1.10;
  beam.bending_stiffness = 2.12e11 * fem::rectangle_second_moment(0.060, 0.006);
  beam.mass_per_length = 3.055 / 1.10;
  beam.tip_mass = tip_mass;
  return beam;
}

Problem make_problem(int elements) {
  using Property = fem::BeamParameter::Quantity;
  Problem problem;
  problem.equations = fem::assemble_parametric(study_beam(0.36049), elements, {{"tip", 1.10}},
                                               {{Property::bending_stiffness, {}}, {Property::tip_mass, {}}});
  const fem::StructuralSystem& system = problem.equations.system;
  problem.modes = fem::modes(system, mode_count);
  experiments::MotionDescription& description = problem.description;
  description.reference = problem.equations.values;
  description.unknowns = {
      {"bending_stiffness", "N m2", description.reference[0], 0.05 * description.reference[0]},
      {"tip_mass", "kg", description.reference[1], 0.02 * description.reference[1]},
      {"damping_ratio", "", 0.0045, 0.002}};
  description.drives = {
      {Drive::Kind::property, 0}, {Drive::Kind::property, 1}, {Drive::Kind::damping_ratio, -1}};
  description.observations = {{Quantity::acceleration}};
  description.sensor_bias = true;
  damp_modes(2, problem);
  // A release from 12 mm as far as it moves these modes.
  start_in_modes(problem.modes.shape.transpose() * (system.mass * (0.012 * static_shape(system))), 0.0,
                 problem);
  return problem;
}

// A reading per sample of a motion that starts a hundredth off the estimate, with parameters off the guess.
VectorXd readings(const Problem& problem, filters::DiscreteModel& model, Index samples) {
  const Index n = problem.equations.system.size();
  VectorXd state = problem.start.mean, next, read, history(samples);
  state.head(n) *= 1.01;
  const Index first = layout(problem.description, n).unknowns;
  state[first] *= 1.03;
  state[first + 1] *= 0.99;
  state[first + 2] = 0.004;
  for (Index k = 0; k < samples; ++k) {
    model.output(state, {}, read);
    history[k] = read[0];
    model.transition(state, {}, next);
    state.swap(next);
  }
  return history;
}

void cost(Index samples, const std::vector<int>& meshes) {
  std::printf(cost_columns);
  for (const int elements : meshes)
    print_cost(make_problem(elements), interval, {}, std::max<Index>(20, samples * 200 / (200 + elements)));
}

void record(int elements, double length) {
  const Problem problem = make_problem(elements);
  const auto samples = static_cast<Index>(length / interval);
  auto source = discrete(problem, interval);
  double from = processor_seconds();
  const VectorXd history = readings(problem, *source, samples);
  std::printf("%ld coordinates, %ld samples; simulated in %.2f s\n",
              static_cast<long>(problem.equations.system.size()), static_cast<long>(samples),
              processor_seconds() - from);
  auto filter = filters::filter_registry().make("low_rank_ekf", {}, discrete(problem, interval));
  filter->reset(problem.start);
  from = processor_seconds();
  for (Index k = 0; k < samples; ++k) {
    filter->correct(history.segment(k, 1), {});
    if (k + 1 < samples) filter->predict({});
  }
  const double spent = processor_seconds() - from;
  std::printf("filtered in %.2f s, %.1f us per sample\n", spent, 1e6 * spent / static_cast<double>(samples));
  const VectorXd mean = filter->estimate().mean, deviation = filter->estimate().deviations();
  const Index first = layout(problem.description, problem.equations.system.size()).unknowns;
  const double truth[] = {1.03 * problem.start.mean[first], 0.99 * problem.start.mean[first + 1], 0.004};
  for (Index j = 0; j < 3; ++j)
    std::printf("%-20s %.6f of the truth, deviation %.1e of it\n",
                problem.description.unknowns[static_cast<std::size_t>(j)].name.c_str(),
                mean[first + j] / truth[j], deviation[first + j] / truth[j]);
}

// The frequency of the first mode, undamped, as `steps` steps turn it, against that of the (2,2) Pade step
// for the mode's exact one; K times q through the strain factors, or assembled as anywhere else.
void print_errors(const Problem& problem, bool assembled, int steps) {
  using namespace experiments::banded;
  const fem::StructuralSystem& system = problem.equations.system;
  experiments::MotionDescription bare;
  bare.reference = problem.equations.values;
  BandedEquations equations(problem.equations, bare);
  equations.set({{}, {}, VectorXd::Zero(2), VectorXd(0), 0.0, 0.0});
  const Index n = system.size();
  BandedStep step(equations, interval);
  step.watch_growth(true);
  step.factor(equations);
  const Complex lambda{3.0 / interval, std::numbers::sqrt3 / interval};
  std::vector<Complex> entries;
  equations.assemble(lambda, entries);
  StepFactor factor(equations.pattern());
  factor.factor(entries);
  const fem::SparseMatrix stiffness = system.stiffness.assembled();
  std::vector<Complex> d(static_cast<std::size_t>(n));

  const double omega = problem.modes.angular_frequency[0];
  const std::complex<double> z(0.0, omega * interval), below = 12.0 - 6.0 * z + z * z;
  const double turn = std::arg((12.0 + 6.0 * z + z * z) / below);
  VectorXd q = problem.modes.shape.col(0), rate = VectorXd::Zero(n), next(n), next_rate(n);
  const VectorXd zero = VectorXd::Zero(n), momentum = system.mass * q;
  double angle = 0.0, size = 1.0;
  for (int k = 1; k <= steps; ++k) {
    if (assembled) {
      const VectorXd force = stiffness * q, moving = system.mass * rate;
      for (Index i = 0; i < n; ++i) d[i] = {force[i] - lambda.re * moving[i], -lambda.im * moving[i]};
      factor.solve(d.data());
      for (Index i = 0; i < n; ++i) {
        next[i] = q[i] + 4.0 * std::numbers::sqrt3 * d[i].im;
        next_rate[i] = rate[i] + 12.0 / interval * (d[i].re + std::numbers::sqrt3 * d[i].im);
      }
    } else {
      step.advance(equations, q.data(), rate.data(), {zero, zero}, next.data(), next_rate.data());
    }
    q.swap(next);
    rate.swap(next_rate);
    const double measured = std::atan2(-momentum.dot(rate) / omega, momentum.dot(q));
    size = std::hypot(momentum.dot(rate) / omega, momentum.dot(q));
    angle = turn * k + std::remainder(measured - turn * k, 2.0 * std::numbers::pi);
  }
  std::printf("  %s: frequency %8.1e, damping ratio %8.1e", assembled ? "assembled" : "strain factors",
              angle / (turn * steps) - 1.0, -std::log(size) / (turn * steps));
  if (!assembled) std::printf(", growth %.2f", step.growth());
}

// Error [m/s2] of the acceleration at the tip while the undamped first mode moves with 12 mm for `steps`
// steps: the motion that rounding brings into modes far above, as an accelerometer at the very point would
// read it and as ContinuumSensors does.
void acceleration_error(double tip_mass, int elements, int steps) {
  Problem problem;
  problem.equations = fem::assemble_parametric(study_beam(tip_mass), elements, {{"tip", 1.10}}, {});
  const fem::StructuralSystem& system = problem.equations.system;
  problem.modes = fem::modes(system, 1);
  problem.description.observations = {{Quantity::acceleration}};
  const auto model = discrete(problem, interval);
  const Index n = system.size();
  const double omega = problem.modes.angular_frequency[0];
  const std::complex<double> z(0.0, omega * interval);
  const double turn = std::arg((12.0 + 6.0 * z + z * z) / (12.0 - 6.0 * z + z * z));
  const VectorXd row = MatrixXd(system.outputs).row(0);
  const VectorXd g = Eigen::SimplicialLDLT<fem::SparseMatrix>(system.mass).solve(row),
                 strain = system.stiffness.strain * g;
  VectorXd state = VectorXd::Zero(2 * n), next, read;
  state.head(n) = problem.modes.shape.col(0) * (0.012 / row.dot(problem.modes.shape.col(0)));
  double at_point = 0.0, as_read = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double exact = -omega * omega * 0.012 * std::cos(turn * k);
    const VectorXd bent = system.stiffness.strain * state.head(n);
    at_point = std::max(at_point, std::abs(-strain.dot(system.stiffness.rigidity * bent) - exact));
    model->output(state, {}, read);
    as_read = std::max(as_read, std::abs(read[0] - exact));
    model->transition(state, {}, next);
    state.swap(next);
  }
  std::printf("%6ld coordinates, tip mass %.4f kg, %d steps: at the point %8.1e m/s2, as read %8.1e m/s2\n",
              static_cast<long>(n), tip_mass, steps, at_point, as_read);
  std::fflush(stdout);
}

void digits(const std::vector<int>& meshes, int steps) {
  for (const int elements : meshes) {
    const Problem problem = make_problem(elements);
    std::printf("%6ld coordinates", static_cast<long>(problem.equations.system.size()));
    print_errors(problem, true, steps);
    print_errors(problem, false, steps);
    std::printf("\n");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "cost";
  const auto numbers = [&](int first, std::vector<int> otherwise) {
    std::vector<int> given;
    for (int i = first; i < argc; ++i) given.push_back(std::atoi(argv[i]));
    return given.empty() ? otherwise : given;
  };
  if (what == "cost")
    cost(argc > 2 ? std::atoi(argv[2]) : 2000, numbers(3, {100, 200, 500, 1000, 2000, 5000, 10000}));
  if (what == "digits") digits(numbers(2, {100, 500, 1000, 5000, 10000}), 2000);
  if (what == "acceleration")
    for (const int elements : numbers(2, {20, 50, 100, 200, 500, 1000, 2000}))
      for (const double tip_mass : {0.0, 0.0198575, 0.36049}) acceleration_error(tip_mass, elements, 2000);
  if (what == "record") record(argc > 2 ? std::atoi(argv[2]) : 1000, argc > 3 ? std::atof(argv[3]) : 25.0);
}
