// One static solution of a uniform beam, factors at hand: the sweeps of the strain factors beside LDL^T of
// the assembled stiffness. Google Benchmark; arguments: number of elements.
#include <benchmark/benchmark.h>

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>

#include "fem/assembly.hpp"
#include "fem/solvers/refined_solver.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/bench/uniform_beam.hpp"

namespace beamid::bench {
namespace {

using Eigen::VectorXd;

fem::StructuralSystem system_of(const benchmark::State& state, const char* supports) {
  return fem::assemble(uniform_beam(supports).beam, static_cast<int>(state.range(0)), {});
}

void sweeps(benchmark::State& state, const char* supports) {
  const auto system = system_of(state, supports);
  const fem::StiffnessSolver solver(system.stiffness);
  const VectorXd load = VectorXd::Random(system.size());
  VectorXd q(system.size()), forces = VectorXd::Zero(system.stiffness.strain.rows());
  for (auto _ : state) {
    solver.solve_into(load, q, forces);
    benchmark::DoNotOptimize(q.data());
  }
}

void careful_sweeps(benchmark::State& state, const char* supports) {
  const auto system = system_of(state, supports);
  const fem::StiffnessSolver solver(system.stiffness);
  const VectorXd load = VectorXd::Random(system.size());
  for (auto _ : state) benchmark::DoNotOptimize(solver.solve_with_forces(load));
}

template <class Factors>
void assembled(benchmark::State& state, const char* supports) {
  const auto system = system_of(state, supports);
  const Factors factors(system.stiffness.assembled());
  const VectorXd load = VectorXd::Random(system.size());
  for (auto _ : state) benchmark::DoNotOptimize(VectorXd(factors.solve(load)));
}

void mixed(benchmark::State& state, const char* supports) {
  const auto system = system_of(state, supports);
  const fem::MixedSolver solver(system.stiffness);
  const VectorXd load = VectorXd::Random(system.size());
  VectorXd q(system.size()), forces(system.stiffness.strain.rows());
  for (auto _ : state) {
    solver.solve(load, q, forces);
    benchmark::DoNotOptimize(q.data());
  }
}

void eigen_ldlt(benchmark::State& state, const char* supports) {
  assembled<Eigen::SimplicialLDLT<fem::SparseMatrix>>(state, supports);
}

void cholmod_ldlt(benchmark::State& state, const char* supports) {
  assembled<Eigen::CholmodSimplicialLDLT<fem::SparseMatrix>>(state, supports);
}

#define BEAMID_STATIC_BENCHMARK(function, supports) \
  BENCHMARK_CAPTURE(function, supports, supports)   \
      ->Arg(500)                                    \
      ->Arg(50'000)                                 \
      ->Arg(500'000)                                \
      ->Unit(benchmark::kMillisecond)

BEAMID_STATIC_BENCHMARK(sweeps, "clamped-free");
BEAMID_STATIC_BENCHMARK(sweeps, "clamped-clamped");
BEAMID_STATIC_BENCHMARK(careful_sweeps, "clamped-free");
BEAMID_STATIC_BENCHMARK(careful_sweeps, "clamped-clamped");
BEAMID_STATIC_BENCHMARK(eigen_ldlt, "clamped-clamped");
BEAMID_STATIC_BENCHMARK(cholmod_ldlt, "clamped-clamped");
BEAMID_STATIC_BENCHMARK(mixed, "clamped-clamped");

}  // namespace
}  // namespace beamid::bench

BENCHMARK_MAIN();
