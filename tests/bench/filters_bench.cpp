// Filter steps on one job: joint identification of [x v K C] from displacement and velocity, 25,000 samples
// of 1 ms. Google Benchmark; `ns_per_step` is per step and trial. The yardstick is plain_ekf.hpp.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "beamid/testing/oscillator.hpp"
#include "filters/algorithms/extended_kalman.hpp"
#include "filters/algorithms/oscillator.hpp"
#include "filters/algorithms/square_root_kalman.hpp"
#include "filters/algorithms/unscented_kalman.hpp"
#include "filters/batch.hpp"
#include "filters/filter_run.hpp"
#include "tests/bench/plain_ekf.hpp"

namespace beamid::bench {
namespace {

using Eigen::Matrix2d, Eigen::Matrix4d, Eigen::MatrixXd, Eigen::Vector2d, Eigen::Vector4d, Eigen::VectorXd;
using filters::Quantity, filters::algorithms::Spread;

constexpr double mass = 3.0, dt = 1e-3, stiffness = 515.8, damping = 0.4;
constexpr Eigen::Index samples = 25'000;
constexpr int batch_size = 64;
const Matrix4d process = Vector4d(1e-16, 1e-14, 1e-8, 1e-10).asDiagonal();
const Matrix2d noise = Vector2d(1e-8, 1e-6).asDiagonal();
const Vector4d guess(0.012, 0.0, 400.0, 1.0);
const Matrix4d prior = Vector4d(1e-4, 1e-2, 1e4, 1.0).asDiagonal();

filters::algorithms::Oscillator<double, 2> model() {
  return {mass, dt, {Quantity::displacement, Quantity::velocity}, process, noise};
}

const MatrixXd& record() {
  static const MatrixXd made = [] {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    MatrixXd outputs(2, samples);
    Vector4d z(0.012, 0.0, stiffness, damping), next;
    for (Eigen::Index k = 0; k < samples; ++k) {
      outputs.col(k) << z[0] + 1e-4 * normal(random), z[1] + 1e-3 * normal(random);
      model().transition(z, next);
      z = next;
    }
    return outputs;
  }();
  return made;
}

// Times `run`, which gives the identified stiffness; a filter that has not found it is not timed at all.
template <class Run>
void time(benchmark::State& state, int trials, const Run& run) {
  double found = run();
  if (!(std::abs(found / stiffness - 1.0) < 1e-2)) return state.SkipWithError("the stiffness was not found");
  for (auto _ : state) benchmark::DoNotOptimize(found = run());
  state.counters["ns_per_step"] =
      benchmark::Counter(1e-9 * static_cast<double>(samples) * trials,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

[[gnu::noinline, gnu::flatten]] double run_plain() {
  PlainEkf filter{mass, dt, process, noise, guess, prior};
  for (Eigen::Index k = 0; k < samples; ++k) {
    if (k > 0) filter.predict();
    filter.correct(record().col(k));
  }
  return filter.mean[2];
}

template <class Algorithm>
[[gnu::noinline]] double run_fixed(Algorithm& filter) {
  const auto at_step = model();
  for (Eigen::Index k = 0; k < samples; ++k) {
    if (k > 0) filter.predict(at_step);
    filter.look(at_step, Vector2d(record().col(k)));
    filter.update(at_step);
  }
  return filter.mean[2];
}

void plain_ekf(benchmark::State& state) {
  time(state, 1, run_plain);
}

void fixed_ekf(benchmark::State& state) {
  filters::algorithms::ExtendedKalman<double, 4, 2> filter;
  time(state, 1, [&] {
    filter.mean = guess;
    filter.covariance = prior;
    return run_fixed(filter);
  });
}

void fixed_ukf(benchmark::State& state) {
  filters::algorithms::UnscentedKalman<double, 4, 2> filter(Spread{2.0, 1.0, true});
  time(state, 1, [&] {
    filter.mean = guess;
    filter.covariance = prior;
    return run_fixed(filter);
  });
}

void fixed_srukf(benchmark::State& state) {
  filters::algorithms::SquareRootKalman<double, 4, 2> filter(Spread{2.0, 1.0, true});
  time(state, 1, [&] {
    filter.mean = guess;
    filter.root = prior.cwiseSqrt();
    return run_fixed(filter);
  });
}

void batch_ekf(benchmark::State& state) {
  const filters::OscillatorTrials kind{
      mass, dt, {Quantity::displacement, Quantity::velocity}, noise, process};
  const std::vector<filters::LaneTrial> trials(batch_size, filters::LaneTrial{record(), {guess, prior}});
  state.SetLabel(filters::batch_instructions());
  time(state, batch_size, [&] { return run_batch(kind, trials)[batch_size / 2].last.mean[2]; });
}

void registered(benchmark::State& state, const char* name) {
  const auto filter = filters::filter_registry().make(
      name, {},
      filters::discretise(std::make_shared<test::Oscillator>(mass, 2), dt, "exponential", {process, noise}));
  VectorXd input, output(2);
  time(state, 1, [&] {
    filter->reset({guess, prior});
    for (Eigen::Index k = 0; k < samples; ++k) {
      if (k > 0) filter->predict(input);
      output = record().col(k);
      filter->correct(output, input);
    }
    return filter->estimate().mean[2];
  });
}

BENCHMARK(plain_ekf)->Unit(benchmark::kMillisecond);
BENCHMARK(fixed_ekf)->Unit(benchmark::kMillisecond);
BENCHMARK(fixed_ukf)->Unit(benchmark::kMillisecond);
BENCHMARK(fixed_srukf)->Unit(benchmark::kMillisecond);
BENCHMARK(batch_ekf)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(registered, ekf, "ekf")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(registered, ukf, "ukf")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(registered, srukf, "srukf")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(registered, ckf, "ckf")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(registered, srckf, "srckf")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace beamid::bench

BENCHMARK_MAIN();
