// Likelihoods of linear models by their Kalman filters: side by side in lanes against a plain loop of
// matrices, one model after the other. Google Benchmark; `per_second` counts models. Arguments: oscillators
// of a chain (n is twice that), samples, models; the last oscillator is read, nothing moves it but its start,
// so that no gain settles.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "filters/innovation_likelihood.hpp"

namespace beamid::bench {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

filters::LinearGaussian chain(Index storeys, double stiffness) {
  constexpr double dt = 0.01, damping = 1e-3;
  MatrixXd k = MatrixXd::Zero(storeys, storeys);
  for (Index i = 0; i < storeys; ++i) {
    k(i, i) += stiffness;
    if (i > 0) k(i - 1, i - 1) += stiffness, k(i, i - 1) = k(i - 1, i) = -stiffness;
  }
  MatrixXd a = MatrixXd::Zero(2 * storeys, 2 * storeys);
  a.topRightCorner(storeys, storeys).setIdentity();
  a.bottomLeftCorner(storeys, storeys) = -k, a.bottomRightCorner(storeys, storeys) = -damping * k;
  const MatrixXd exact = (a * dt).exp();
  filters::LinearGaussian model;
  model.a = exact, model.g = MatrixXd::Zero(2 * storeys, 0), model.d = MatrixXd::Zero(1, 0);
  model.h = a.row(2 * storeys - 1);
  model.q = MatrixXd::Zero(2 * storeys, 2 * storeys), model.r = MatrixXd::Constant(1, 1, 0.01);
  model.start = {VectorXd::Zero(2 * storeys), MatrixXd::Identity(2 * storeys, 2 * storeys), {}};
  return model;
}

struct Job {
  std::vector<filters::LinearGaussian> models;
  filters::Measurements record;
};

Job job_of(const benchmark::State& state) {
  Job job;
  for (Index i = 0; i < state.range(2); ++i)
    job.models.push_back(chain(state.range(0), 900.0 + static_cast<double>(i)));
  const Index samples = state.range(1);
  job.record = {VectorXd::LinSpaced(samples, 0.0, 0.01 * static_cast<double>(samples - 1)),
                MatrixXd(1, samples), MatrixXd(0, samples)};
  for (Index k = 0; k < samples; ++k) job.record.outputs(0, k) = std::sin(0.1 * static_cast<double>(k));
  return job;
}

void plain_loop(benchmark::State& state) {
  const Job job = job_of(state);
  for ([[maybe_unused]] auto _ : state)
    for (const filters::LinearGaussian& model : job.models)
      benchmark::DoNotOptimize(filters::kalman_pass(model, job.record, 0.01).cost);
  state.counters["per_second"] =
      benchmark::Counter(static_cast<double>(state.range(2)), benchmark::Counter::kIsIterationInvariantRate);
}

void lanes(benchmark::State& state) {
  const Job job = job_of(state);
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(filters::innovation_passes(job.models, job.record, 0.01, false).front().cost());
  state.counters["per_second"] =
      benchmark::Counter(static_cast<double>(state.range(2)), benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(plain_loop)->Args({2, 401, 8})->Args({6, 401, 8})->Args({12, 401, 8});
BENCHMARK(lanes)->Args({2, 401, 8})->Args({6, 401, 8})->Args({12, 401, 8})->Args({2, 401, 1});

}  // namespace
}  // namespace beamid::bench

BENCHMARK_MAIN();
