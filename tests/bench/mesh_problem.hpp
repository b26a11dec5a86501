// A joint filter on a whole mesh: what its steps cost. Shared by continuum_bench and frame_bench.
#pragma once

#include <cstdio>
#include <ctime>
#include <memory>

#include "experiments/models/banded/continuum_motion.hpp"
#include "fem/modes.hpp"
#include "filters/filter.hpp"

namespace beamid::bench {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index mode_count = 3;  // that the start is in, and that are damped

struct Problem {
  fem::ParametricSystem equations;
  fem::Modes modes;
  experiments::MotionDescription description;
  filters::Gaussian start;
};

inline double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Modes damped by the unknown `ratio`.
inline void damp_modes(Index ratio, Problem& problem) {
  const fem::StructuralSystem& system = problem.equations.system;
  const auto properties = static_cast<Index>(problem.equations.derivatives.size());
  for (Index i = 0; i < mode_count; ++i) {
    const VectorXd phi = problem.modes.shape.col(i), strain = problem.equations.strain * phi;
    experiments::DampedMode mode{system.mass * phi,
                                 MatrixXd(system.size(), properties),
                                 VectorXd(properties),
                                 system.stiffness.energy(phi),
                                 VectorXd(properties),
                                 0.0,
                                 ratio};
    for (Index j = 0; j < properties; ++j) {
      const auto& slope = problem.equations.derivatives[static_cast<std::size_t>(j)];
      mode.momentum_slopes.col(j) = slope.mass * phi;
      mode.mass_slopes[j] = phi.dot(mode.momentum_slopes.col(j));
      mode.stiffness_slopes[j] = strain.dot(slope.rigidity * strain);
    }
    problem.description.damped_modes.push_back(std::move(mode));
  }
}

/// The modes' amplitudes known to 5 %, or to `least`, the unknowns and a bias of 0.1 m/s2 of each
/// accelerometer.
inline void start_in_modes(const VectorXd& amplitude, double least, Problem& problem) {
  const experiments::StateLayout places = layout(problem.description, problem.equations.system.size());
  const Index n = places.coordinates, q = static_cast<Index>(problem.description.unknowns.size()),
              offsets = static_cast<Index>(places.offsets.size());
  VectorXd mean = VectorXd::Zero(places.size);
  MatrixXd factor = MatrixXd::Zero(places.size, 2 * mode_count + q + offsets);
  for (Index i = 0; i < mode_count; ++i) {
    const double omega = problem.modes.angular_frequency[i], uncertain = std::max(0.05 * amplitude[i], least);
    mean.head(n) += amplitude[i] * problem.modes.shape.col(i);
    factor.col(2 * i).head(n) = uncertain * problem.modes.shape.col(i);
    factor.col(2 * i + 1).segment(n, n) = uncertain * omega * problem.modes.shape.col(i);
  }
  for (Index j = 0; j < q; ++j) {
    mean[places.unknowns + j] = problem.description.unknowns[static_cast<std::size_t>(j)].guess;
    factor(places.unknowns + j, 2 * mode_count + j) =
        problem.description.unknowns[static_cast<std::size_t>(j)].deviation;
  }
  for (Index i = 0; i < offsets; ++i)
    factor(places.offsets[static_cast<std::size_t>(i)].place, 2 * mode_count + q + i) = 0.1;
  problem.start = {mean, {}, factor};
}

/// Sensors of 0.05 m/s2.
inline std::unique_ptr<filters::DiscreteModel> discrete(const Problem& problem, double interval) {
  const auto sensors = static_cast<Index>(problem.description.observations.size());
  return discretise(std::make_shared<experiments::ContinuumMotion>(problem.equations, problem.description),
                    interval, "pade", {{}, 0.05 * 0.05 * MatrixXd::Identity(sensors, sensors)});
}

/// One line: coordinates, directions, and microseconds of the mean alone, mean and directions, reading and
/// its derivatives, readings of the directions, and of prediction and correction together.
inline void print_cost(const Problem& problem, double interval, const VectorXd& input, Index count) {
  const auto model = discrete(problem, interval);
  VectorXd state = problem.start.mean, next, read;
  const Index first = layout(problem.description, problem.equations.system.size()).unknowns;
  const VectorXd now = input.head(static_cast<Index>(problem.description.forces.size()));
  MatrixXd directions = problem.start.factor, jacobian, seen;
  double seconds[4] = {};
  for (Index k = 0; k < count; ++k) {
    const double stiffer = 1.0 + 1e-9 * static_cast<double>(k % 7);
    state[first] = problem.start.mean[first] * stiffer;  // as a filter changes it at every sample
    double from = processor_seconds();
    model->transition(state, input, next);
    seconds[0] += processor_seconds() - from;
    state[first] = problem.start.mean[first] * stiffer * (1.0 + 1e-10);
    from = processor_seconds();
    model->move(state, input, next, directions);
    seconds[1] += processor_seconds() - from;
    from = processor_seconds();
    model->output(state, now, read);
    model->output_jacobian(state, now, jacobian);
    seconds[2] += processor_seconds() - from;
    from = processor_seconds();
    seen.noalias() = jacobian * directions;
    seconds[3] += processor_seconds() - from;
    state.swap(next);
  }
  std::printf("%7ld %3ld", static_cast<long>(problem.equations.system.size()),
              static_cast<long>(directions.cols()));
  for (const double spent : seconds) std::printf(" %10.2f", 1e6 * spent / static_cast<double>(count));
  std::printf(" %10.2f\n", 1e6 * (seconds[1] + seconds[2] + seconds[3]) / static_cast<double>(count));
  std::fflush(stdout);
}

inline const char* const cost_columns =
    "# coordinates, directions, microseconds: mean alone, mean and directions, reading and its derivatives, "
    "readings of the directions, prediction and correction\n";

}  // namespace beamid::bench
