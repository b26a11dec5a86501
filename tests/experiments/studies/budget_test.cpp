// Oracles: closed forms of single causes, the Cramer-Rao bound, and sums.
#include "experiments/studies/budget/budget.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/studies/paper/monte_carlo.hpp"

namespace beamid::experiments::budget_test {
namespace {

// The beam S(11.8), on a coarser mesh and for a shorter time.
PipelineSettings small_settings() {
  PipelineSettings settings;
  settings.beam = paper::steel_beam(paper::test_beams[1]);
  settings.elements = 20;
  settings.damping_ratios = Eigen::Vector4d(0.0045, 0.005, 0.005, 0.005);
  settings.duration = 12.0;
  settings.sampling_rate = 500.0;
  return settings;
}

TEST(Pipeline, WithoutAnyCauseFindsTheTruth) {
  const ParameterErrors errors = Pipeline(small_settings()).errors({});
  EXPECT_NEAR(errors.stiffness, 0.0, 1e-6);
  EXPECT_NEAR(errors.damping, 0.0, 1e-4);
}

TEST(Pipeline, WithForwardEulerErrsAsTheClosedFormSays) {
  const Pipeline pipeline(small_settings());
  for (const bool stated_rate : {false, true}) {
    Causes on = only(Cause::discretisation);
    on.set(index_of(Cause::sampling), stated_rate);
    const ParameterErrors found = pipeline.errors(on),
                          predicted = pipeline.discretisation(stated_rate ? 2e-3 : 1e-3);
    EXPECT_NEAR(found.damping, predicted.damping, 1e-4 * predicted.damping) << stated_rate;
    EXPECT_NEAR(found.stiffness, predicted.stiffness, 1e-3 * std::abs(predicted.stiffness)) << stated_rate;
  }
}

TEST(Pipeline, WithRayleighsMassErrsAsThatMassDoes) {
  const Pipeline pipeline(small_settings());
  const ParameterErrors found = pipeline.errors(only(Cause::reduction));
  EXPECT_GT(std::abs(pipeline.reduction().stiffness), 1e-2);
  EXPECT_NEAR(found.stiffness, pipeline.reduction().stiffness, 1e-5);
  EXPECT_NEAR(found.damping, pipeline.reduction().damping, 1e-3);
}

// M w^2 falls by the square of the frequency: the loaded first mode against the bare one.
TEST(Pipeline, WithAnUncountedMassFindsTheSlowerMode) {
  PipelineSettings settings = small_settings();
  settings.sensor_mass = 0.01;
  const Pipeline pipeline(settings);
  const double share = settings.sensor_mass / pipeline.truth().mass;
  EXPECT_NEAR(pipeline.errors(only(Cause::sensor_mass)).stiffness, -100.0 * share, 5.0 * share * share * 100);
}

// Cramer-Rao over seeds: rms error near one bound; a band of 99.9 % for 16 runs.
TEST(Pipeline, WithNoiseScattersAsTheBoundSays) {
  PipelineSettings settings = small_settings();
  double squares = 0.0, bound = 0.0;
  constexpr int runs = 16;
  for (int i = 0; i < runs; ++i) {
    settings.stream = static_cast<std::uint64_t>(i);
    const Pipeline pipeline(settings);
    bound = pipeline.noise_bound().damping;
    squares += std::pow(pipeline.errors(only(Cause::sensor_noise)).damping / bound, 2);
  }
  EXPECT_GT(bound, 0.0);
  EXPECT_GT(squares, 3.9);
  EXPECT_LT(squares, 39.3);
}

TEST(Pipeline, WithAmplitudeDampingFindsBetweenTheSmallestAndTheLargest) {
  const ParameterErrors errors = Pipeline(small_settings()).errors(only(Cause::amplitude_damping));
  EXPECT_GT(errors.damping, 0.5);
  EXPECT_LT(errors.damping, 2.0);
}

// The numbers of docs/theory/error_budget.md, of S(11.8) as `beamid budget` sets it up.
TEST(Pipeline, OfTheDocumentedBeamErrsAsDocumented) {
  PipelineSettings settings;
  settings.beam = paper::steel_beam(paper::test_beams[1]);
  settings.damping_ratios = Eigen::VectorXd::Constant(8, 0.005);
  settings.damping_ratios[0] = paper::test_beams[1].first_damping_ratio;
  settings.stream = paper::stream_of(1, 0);
  const Pipeline pipeline(settings);
  const ParameterErrors total = pipeline.errors(all_causes());
  EXPECT_NEAR(total.stiffness, -2.77, 0.005);
  EXPECT_NEAR(total.damping, 234.2, 0.05);
  EXPECT_NEAR(pipeline.reduction().stiffness, -2.596, 0.0005);
  const ParameterErrors gain = total - pipeline.errors(all_causes().reset(index_of(Cause::sampling)));
  EXPECT_NEAR(gain.damping, 117.2, 0.05);
}

TEST(Budget, AddsUpToItsTotal) {
  const Budget budget = make_budget("S(11.8)", small_settings(), 4);
  ParameterErrors sequence = budget.clean, average = budget.clean, alone = budget.clean + budget.interaction;
  for (const Contribution& c : budget.contributions) {
    sequence = sequence + c.in_sequence;
    average = average + c.average;
    alone = alone + c.alone;
  }
  for (const ParameterErrors& sum : {sequence, average, alone}) {
    EXPECT_NEAR(sum.stiffness, budget.total.stiffness, 1e-9);
    EXPECT_NEAR(sum.damping, budget.total.damping, 1e-9);
  }
  EXPECT_EQ(largest(budget.contributions, &Contribution::average, &ParameterErrors::damping),
            index_of(Cause::discretisation));
}

TEST(Budget, RefusesARecordThatShowsTooLittle) {
  PipelineSettings settings = small_settings();
  settings.duration = 1.0;
  EXPECT_THROW(make_budget("short", settings, 2), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::budget_test
