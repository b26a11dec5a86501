// A span of a girder between two sections. Oracle: its exact modes without elements, random forces beyond the
// span in steady state; the values that the record was made with.
#include "experiments/identify/parts/parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>

#include "experiments/config/read_experiment.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments::span_test {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;
using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double length = 30.0, mass = 400.0, stiffness = 2.1e9, beta = 2e-4, rate = 125.0, highest = 37.5;
constexpr Index samples = 1000;

Experiment girder(double guess, const std::string& more = {}) {
  std::string text = fmt::format(
      "[beam]\nlength_m = {}\nmass_per_length_kg_per_m = {}\nbending_stiffness_n_m2 = {}\nsupport = "
      "\"pinned-pinned\"\nelements = 20\n",
      length, mass, stiffness);
  text += fmt::format(
      "[[parameters]]\nquantity = \"bending_stiffness\"\nform = \"logarithmic\"\nguess_n_m2 = {}\n"
      "relative_deviation = 0.5\n[[parameters]]\nquantity = \"stiffness_damping\"\nform = \"logarithmic\"\n"
      "guess_s = {}\nrelative_deviation = 1.0\n",
      guess * stiffness, guess * beta);
  text += fmt::format("[[substructures]]\nname = \"middle\"\nfrom_m = 8\nto_m = 22\nhighest_hz = {}\n{}",
                      highest, more);
  return read_experiment(TomlTable::parse(text, "girder.toml"));
}

// Of channel i for a unit force at `force`.
Complex response(const Channel& channel, double force, double omega) {
  Complex sum = 0.0;
  for (int n = 1; n <= 80; ++n) {
    const double wave = n * pi / length, own = wave * wave * std::sqrt(stiffness / mass), square = own * own;
    const double shape = is_angular(channel.quantity) ? wave * std::cos(wave * *channel.position)
                                                      : std::sin(wave * *channel.position);
    sum += 2.0 / (mass * length) * shape * std::sin(wave * force) * -omega * omega /
           Complex(square - omega * omega, omega * beta * square);
  }
  return sum;
}

std::vector<Channel> sensors(bool rotations) {
  std::vector<Channel> channels;
  for (const double x : {8.0, 11.5, 15.0, 18.5, 22.0})
    channels.push_back({Quantity::acceleration, fmt::format("a{}", x), x});
  for (const double x : {8.0, 22.0})
    if (rotations) channels.push_back({Quantity::angular_acceleration, fmt::format("r{}", x), x});
  return channels;
}

// Lines of a period of 2048 samples; 5 % of noise.
ComparedRecord record_of(std::uint64_t seed, bool rotations = true) {
  constexpr double period = 2048.0;
  ComparedRecord made;
  made.name = "girder";
  made.record.channels = sensors(rotations);
  const auto p = static_cast<Index>(made.record.channels.size());
  made.record.time = VectorXd::LinSpaced(samples, 0.0, (samples - 1) / rate);
  made.record.samples.setZero(p, samples);
  const auto first = static_cast<Index>(std::ceil(period / rate)),
             last = static_cast<Index>(highest * period / rate);
  const VectorXd drawn = standard_normal(4 * (last - first), seed, 1);
  for (Index line = first; line < last; ++line) {
    const double omega = 2.0 * pi * rate / period * static_cast<double>(line);
    Eigen::VectorXcd there = Eigen::VectorXcd::Zero(p);
    for (Index f = 0; f < 2; ++f) {
      const Index at = 4 * (line - first) + 2 * f;
      for (Index i = 0; i < p; ++i)
        there[i] += Complex(drawn[at], drawn[at + 1]) *
                    response(made.record.channels[static_cast<std::size_t>(i)], f == 0 ? 3.0 : 27.0, omega);
    }
    for (Index k = 0; k < samples; ++k)
      made.record.samples.col(k) += (there * std::exp(Complex(0.0, omega * made.record.time[k]))).real();
  }
  for (Index i = 0; i < p; ++i) {
    Channel& channel = made.record.channels[static_cast<std::size_t>(i)];
    channel.noise = 0.05 * made.record.samples.row(i).norm() / std::sqrt(static_cast<double>(samples));
    made.record.samples.row(i) +=
        channel.noise * standard_normal(samples, seed, 10 + static_cast<std::uint64_t>(i)).transpose();
  }
  return made;
}

const ComparedRun& noisy_run(const PartedIdentification& found) {
  return found.parts.front().run(Sections::noisy);
}

TEST(Span, HasTheStiffnessAndDampingOfItsBeamWithTheDeviationsItStates) {
  double squares = 0.0, exact_squares = 0.0;
  constexpr int seeds = 8;
  for (int seed = 1; seed <= seeds; ++seed) {
    const PartedIdentification found = identify_parts(
        girder(seed % 2 == 0 ? 0.5 : 1.5), record_of(static_cast<std::uint64_t>(seed)), {}, false, unwatched);
    const ComparedRun &run = noisy_run(found), &exact = found.parts.front().run(Sections::exact);
    ASSERT_EQ(run.status, ComparedRun::Status::converged) << seed << ": " << run.reason;
    const double truth[] = {stiffness, beta};
    for (std::size_t j = 0; j < 2; ++j) {
      const ComparedParameter& one = run.parameters[j];
      const double off = (one.estimate.value - truth[j]) / one.estimate.deviation;
      EXPECT_LT(std::abs(off), 4.0) << seed << " " << one.estimate.name;
      EXPECT_NEAR(one.estimate.deviation / *one.bound, 1.0, 0.1) << seed << " " << one.estimate.name;
      squares += off * off;
      exact_squares += std::pow(
          (exact.parameters[j].estimate.value - truth[j]) / exact.parameters[j].estimate.deviation, 2);
    }
  }
  // Chi-square of 16: 95 % of it between 6.9 and 28.8.
  EXPECT_GT(squares, 6.9);
  EXPECT_LT(squares, 28.8);
  EXPECT_GT(exact_squares, 28.8);  // whose sections are taken for exact
}

TEST(Span, OfARotationWithTheWrongSignIsContradicted) {
  ComparedRecord record = record_of(1);
  record.record.samples.bottomRows(1) *= -1.0;
  const PartedIdentification found = identify_parts(girder(1.2), record, {}, false, unwatched);
  EXPECT_NE(noisy_run(found).status, ComparedRun::Status::converged);
  EXPECT_FALSE(found.converged());
  EXPECT_TRUE(found.joined.empty());
}

TEST(Span, OfASensorOffItsPlaceIsContradicted) {
  ComparedRecord record = record_of(1);
  record.record.channels[1].position = 12.5;
  const PartedIdentification found = identify_parts(girder(1.2), record, {}, false, unwatched);
  EXPECT_EQ(noisy_run(found).status, ComparedRun::Status::contradicted);
  EXPECT_FALSE(found.converged());
}

TEST(Span, DoesWithoutRotationsAtTheCostOfDeviation) {
  const PartedIdentification with = identify_parts(girder(0.7), record_of(3), {}, false, unwatched),
                             without = identify_parts(girder(0.7), record_of(3, false), {}, false, unwatched);
  ASSERT_EQ(noisy_run(without).status, ComparedRun::Status::converged) << noisy_run(without).reason;
  const Estimate &known = noisy_run(with).parameters[0].estimate,
                 &blind = noisy_run(without).parameters[0].estimate;
  EXPECT_LT(std::abs(blind.value - stiffness), 4.0 * blind.deviation);
  EXPECT_GT(blind.deviation, 1.2 * known.deviation);
  EXPECT_LT(blind.deviation, 10.0 * known.deviation);
}

void expect_refused(const Experiment& experiment, const ComparedRecord& record, const std::string& words) {
  try {
    identify_parts(experiment, record, {}, false, unwatched);
    FAIL() << words;
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(words));
  }
}

TEST(Span, RefusesMoreMissingRotationsThanItHasSensorsFor) {
  ComparedRecord record = record_of(1, false);
  record.record.channels = {record.record.channels[0], record.record.channels[2], record.record.channels[4]};
  record.record.samples = MatrixXd(record.record.samples(std::vector<Index>{0, 2, 4}, Eigen::all));
  expect_refused(girder(1.0), record, "2 of the rotations at its sections are not measured");
}

TEST(Span, RefusesNoiseThatIsNotStated) {
  ComparedRecord record = record_of(1);
  record.record.channels[2].noise = 0.0;
  expect_refused(girder(1.0), record, "the noise of 'a15', inside a span, is not stated");
}

TEST(Span, RefusesAMovingBase) {
  ComparedRecord record = record_of(1);
  record.record.channels[2].quantity = Quantity::base_acceleration;
  expect_refused(girder(1.0), record, "base is at rest");
}

}  // namespace
}  // namespace beamid::experiments::span_test
