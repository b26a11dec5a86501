// Trials in lanes beside the same trials alone.
#include "filters/batch.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <random>

#include "beamid/testing/oscillator.hpp"
#include "filters/algorithms/extended_kalman.hpp"
#include "filters/algorithms/oscillator.hpp"

namespace beamid::batch_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector4d, Eigen::VectorXd;
using filters::OscillatorTrials, filters::Quantity, filters::LaneTrial, filters::TrialResult;

constexpr double mass = 3.0, dt = 1e-3;

OscillatorTrials kind() {
  OscillatorTrials result{mass, dt, {Quantity::displacement, Quantity::velocity}, MatrixXd(2, 2), {}};
  result.output_noise << 1e-8, 0.0, 0.0, 1e-6;
  result.process_noise = Vector4d(1e-16, 1e-14, 1e-6, 1e-8).asDiagonal();
  return result;
}

// Decays of different stiffness and damping, each with a guess and noise of its own.
std::vector<LaneTrial> trials(int count, Index samples) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  std::vector<LaneTrial> result;
  const filters::algorithms::Oscillator<double, 1> motion(mass, dt, {Quantity::displacement},
                                                          Eigen::Matrix4d::Zero(), MatrixXd::Identity(1, 1));
  for (int i = 0; i < count; ++i) {
    Vector4d z(0.012, 0.0, 400.0 + 30.0 * i, 0.5 + 2.0 * i), next;
    LaneTrial trial{MatrixXd(2, samples), {z, Vector4d(1e-8, 1e-6, 1e4, 4.0).asDiagonal()}};
    trial.initial.mean[2] *= 0.9;
    for (Index k = 0; k < samples; ++k) {
      trial.outputs.col(k) << z[0] + 1e-4 * normal(random), z[1] + 1e-3 * normal(random);
      motion.transition(z, next);
      z = next;
    }
    result.push_back(trial);
  }
  return result;
}

filters::FilterRun alone(const LaneTrial& trial, filters::Start start = filters::Start::at_first_sample) {
  const auto filter = filters::filter_registry().make(
      "ekf", {},
      filters::discretise(std::make_shared<test::Oscillator>(mass, 2), dt, "exponential",
                          {kind().process_noise, kind().output_noise}));
  const filters::Measurements record{
      VectorXd::LinSpaced(trial.outputs.cols(), 0.0, dt * static_cast<double>(trial.outputs.cols() - 1)),
      trial.outputs,
      {}};
  return run(*filter, trial.initial, record, filters::Keep::last_estimate, start);
}

void expect_same(const TrialResult& found, const filters::FilterRun& expected, double tolerance) {
  EXPECT_FALSE(found.failed);
  const VectorXd scale = expected.last.deviations().cwiseInverse();
  EXPECT_LT(scale.cwiseProduct(found.last.mean - expected.last.mean).norm(), tolerance);
  const MatrixXd error = found.last.covariance - expected.last.covariance;
  EXPECT_LT((scale.asDiagonal() * error * scale.asDiagonal()).norm(), tolerance);
  EXPECT_NEAR(found.log_likelihood / expected.log_likelihood, 1.0, 1e-12);
}

TEST(Batch, GivesEachTrialWhatTheScalarFilterOfFixedSizeGivesIt) {
  const auto given = trials(7, 1000);  // not a multiple of any number of lanes
  const auto found = run_batch(kind(), given);
  const filters::algorithms::Oscillator<double, 2> model(
      mass, dt, {Quantity::displacement, Quantity::velocity}, kind().process_noise, kind().output_noise);
  for (std::size_t i = 0; i < given.size(); ++i) {
    filters::algorithms::ExtendedKalman<double, 4, 2> filter;
    filter.mean = given[i].initial.mean;
    filter.covariance = given[i].initial.covariance;
    for (Index k = 0; k < 1000; ++k) {
      if (k > 0) filter.predict(model);
      filter.look(model, Eigen::Vector2d(given[i].outputs.col(k)));
      filter.update(model);
    }
    EXPECT_LT((found[i].last.mean - filter.mean).cwiseQuotient(filter.mean).norm(), 1e-12) << i;
    const VectorXd scale = filter.covariance.diagonal().cwiseSqrt().cwiseInverse();
    EXPECT_LT(
        (scale.asDiagonal() * (found[i].last.covariance - filter.covariance) * scale.asDiagonal()).norm(),
        1e-11)
        << i;
  }
}

TEST(Batch, IsTheRegisteredFilterOnManyTrials) {
  const auto given = trials(5, 500);
  for (const auto start : {filters::Start::at_first_sample, filters::Start::one_interval_before}) {
    const auto found = run_batch(kind(), given, start);
    for (std::size_t i = 0; i < given.size(); ++i) expect_same(found[i], alone(given[i], start), 1e-9);
  }
}

TEST(Batch, SeesWhatWasMeasuredOnly) {
  auto given = trials(4, 300);
  for (Index k = 50; k < 80; ++k) given[1].outputs(0, k) = std::nan("");
  for (Index k = 60; k < 90; ++k) given[2].outputs.col(k).setConstant(std::nan(""));
  given[3].outputs(1, 0) = std::nan("");
  const auto found = run_batch(kind(), given);
  for (std::size_t i = 0; i < given.size(); ++i) expect_same(found[i], alone(given[i]), 1e-9);
}

TEST(Batch, LeavesOtherTrialsAloneWhenOneFails) {
  const auto whole = trials(4, 300);
  auto given = whole;
  given[2].outputs(0, 123) = std::numeric_limits<double>::infinity();
  const auto found = run_batch(kind(), given), expected = run_batch(kind(), whole);
  ASSERT_TRUE(found[2].failed);
  EXPECT_EQ(*found[2].failed, 123);
  auto short_of_it = whole[2];
  short_of_it.outputs = short_of_it.outputs.leftCols(123).eval();
  expect_same({found[2].last, found[2].log_likelihood, {}}, alone(short_of_it), 1e-9);
  for (const std::size_t i : {0u, 1u, 3u}) {
    EXPECT_FALSE(found[i].failed);
    EXPECT_EQ(found[i].last.mean, expected[i].last.mean);
    EXPECT_EQ(found[i].last.covariance, expected[i].last.covariance);
    EXPECT_EQ(found[i].log_likelihood, expected[i].log_likelihood);
  }
}

TEST(Batch, ObservesAnyOfTheThreeQuantities) {
  // Oracle: the scalar filter on the same outputs.
  auto given = trials(3, 400);
  OscillatorTrials observed{mass, dt, {Quantity::acceleration}, MatrixXd::Constant(1, 1, 2.5e-3), {}};
  for (auto& trial : given) {
    const double k = trial.initial.mean[2] / 0.9, c = trial.initial.mean[3];
    trial.outputs = MatrixXd(-(k * trial.outputs.row(0) + c * trial.outputs.row(1)) / mass);
  }
  const auto found = run_batch(observed, given);
  const filters::algorithms::Oscillator<double, 1> model(mass, dt, {Quantity::acceleration},
                                                         Eigen::Matrix4d::Zero(), observed.output_noise);
  for (std::size_t i = 0; i < given.size(); ++i) {
    filters::algorithms::ExtendedKalman<double, 4, 1> filter;
    filter.mean = given[i].initial.mean;
    filter.covariance = given[i].initial.covariance;
    for (Index k = 0; k < 400; ++k) {
      if (k > 0) filter.predict(model);
      filter.look(model, given[i].outputs.col(k));
      filter.update(model);
    }
    EXPECT_FALSE(found[i].failed);
    EXPECT_NEAR(found[i].last.mean[2] / filter.mean[2], 1.0, 1e-11);
    EXPECT_NEAR(found[i].last.mean[3] / filter.mean[3], 1.0, 1e-10);
  }
}

TEST(Batch, RefusesWhatDoesNotFit) {
  const auto given = trials(2, 10);
  const auto refused = [&](auto change) {
    auto changed_kind = kind();
    auto changed = given;
    change(changed_kind, changed);
    EXPECT_THROW(run_batch(changed_kind, changed), std::invalid_argument);
  };
  refused([](auto& k, auto&) { k.mass = 0.0; });
  refused([](auto& k, auto&) { k.interval = std::nan(""); });
  refused([](auto& k, auto&) { k.observed.clear(); });
  refused([](auto& k, auto&) { k.output_noise.resize(1, 1); });
  refused([](auto& k, auto&) { k.output_noise(0, 0) = -1.0; });
  refused([](auto& k, auto&) { k.process_noise.setZero(2, 2); });
  refused([](auto&, auto& t) { t[1].outputs.conservativeResize(2, 9); });
  refused([](auto&, auto& t) { t[1].initial.mean[0] = std::nan(""); });
  refused([](auto&, auto& t) { t[0].initial.covariance(0, 1) = 1.0; });
  EXPECT_TRUE(run_batch(kind(), {}).empty());
}

TEST(Batch, LendsNoCodeForNewProcessorsToTheRestOfTheProgram) {
  // A weak symbol of the file compiled for AVX2 might be the copy that the linker gives to everybody.
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "sanitizers bring weak symbols of their own";
#endif
  const auto archive =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "../filters/libbeamid_filters.a";
  if (!std::filesystem::exists(archive)) GTEST_SKIP() << "no archive at " << archive;
  FILE* listing = popen(("nm -C " + archive.string() + " 2>/dev/null").c_str(), "r");
  ASSERT_NE(listing, nullptr);
  std::array<char, 4096> line;
  bool inside = false, found = false;
  while (fgets(line.data(), static_cast<int>(line.size()), listing)) {
    const std::string text = line.data();
    if (text.find(".cpp.o:") != std::string::npos)
      inside = text.starts_with("batch_avx2.cpp.o:") || text.starts_with("normal_avx2.cpp.o:");
    if (!inside || text.size() < 19) continue;
    found = found || text.find("run_group_avx2") != std::string::npos;
    EXPECT_EQ(std::string("WVu").find(text[17]), std::string::npos) << text;
  }
  pclose(listing);
  if (!found) GTEST_SKIP() << "nm lists nothing";
}

}  // namespace
}  // namespace beamid::batch_test
