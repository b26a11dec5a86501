// The laws of what free vibration can tell, against closed forms of a damped sine.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "tests/experiments/identify/bounds/oscillator.hpp"

namespace beamid::experiments::analytic_laws_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using test::bounds_of, test::oscillating;

constexpr double rate = 1000.0, noise = 0.05;

// Integrals of t^n e^(-2 d t) from 0 to T, n = 0, 1, 2.
struct DecayMoments {
  DecayMoments(double d, double duration) {
    const double a = 2.0 * d, x = a * duration, e = std::exp(-x);
    zeroth = (1.0 - e) / a;
    first = (1.0 - (1.0 + x) * e) / (a * a);
    second = (2.0 - (2.0 + 2.0 * x + x * x) * e) / (a * a * a);
  }
  double zeroth, first, second;

  // Of t about its mean: what is left of it when an amplitude is unknown too.
  double left() const { return second - first * first / zeroth; }
};

// y = A e^(-d t) cos(w t + phase) in white noise: d and w are known to the same absolute deviation, amplitude
// and phase unknown, apart from terms of 1 / (w T) [kay1993, ch. 3].
double deviation_of_decay(double amplitude, double d, double duration) {
  return std::sqrt(2.0 / rate / DecayMoments(d, duration).left()) * noise / amplitude;
}

struct Beam {
  const char* name;
  double mass, frequency_hz, ratio;
};

// True modal masses, first frequencies and assumed damping ratios of the study's beams.
constexpr Beam beams[] = {{"S(0.65)", 0.782414, 4.145510989755, 0.0020},
                          {"S(11.8)", 1.109401, 3.455527194845, 0.0045},
                          {"S(43.8)", 2.073088, 2.515654977346, 0.0028},
                          {"S(76.3)", 3.061047, 2.068201252526, 0.0022},
                          {"S(119.3)", 4.371662, 1.729901652424, 0.0015}};

TEST(FreeDecay, KnowsDampingToOneOverTwiceTheRatioTimesStiffness) {
  // K = M w^2 and C = 2 M d: dK/K = 2 dw/w, dC/C = dd/d = dd/(xi w), so (dC/C) / (dK/K) = 1 / (2 xi). The
  // frequency alone is known twice as well as the stiffness: its ratio to C would be 1 / xi.
  for (const Beam& beam : beams) {
    const auto motion = oscillating(beam.mass, beam.frequency_hz, beam.ratio, 0.012, 1.0 / rate, 2);
    const VectorXd bound = bounds_of(motion, 25001, noise);
    EXPECT_NEAR(bound[1] / bound[0] * 2.0 * beam.ratio, 1.0, 0.01) << beam.name;
  }
}

TEST(FreeDecay, GivesTheClosedFormBounds) {
  for (const Beam& beam : beams) {
    const double omega = 2.0 * M_PI * beam.frequency_hz, d = beam.ratio * omega;
    const auto motion = oscillating(beam.mass, beam.frequency_hz, beam.ratio, 0.012, 1.0 / rate, 2);
    const VectorXd bound = bounds_of(motion, 25001, noise);
    const double deviation = deviation_of_decay(0.012 * omega * omega, d, 25.0);
    EXPECT_NEAR(bound[0] / (2.0 * deviation / omega), 1.0, 0.01) << beam.name;
    EXPECT_NEAR(bound[1] / (deviation / d), 1.0, 0.01) << beam.name;
  }
}

TEST(FreeDecay, OfTheHeaviestTestBeamTellsItsDampingToAThirdOfAPerCent) {
  // Acceleration observed as it is, noise 0.05 m/s2, 25 s at 1 kHz: 0.33 %, found by an independent program.
  const Beam& beam = beams[4];
  const auto motion = oscillating(beam.mass, beam.frequency_hz, beam.ratio, 0.01199, 1.0 / rate, 2);
  EXPECT_NEAR(100.0 * bounds_of(motion, 25001, noise)[1], 0.33, 0.005);
}

TEST(FreeDecay, HasToldAllOfItsDampingAfterAFewTimeConstants) {
  // Information on d over that of an endless record: 24 % by 1 / (xi w), 91 % by three, 98 % by four.
  const double ratio = 0.01, frequency = 5.0, constant = 1.0 / (ratio * 2.0 * M_PI * frequency);
  const auto motion = oscillating(3.0, frequency, ratio, 0.012, 1.0 / rate, 2);
  std::vector<Reading> readings;
  for (const double multiple : {1.0, 3.0, 4.0, 14.0})
    readings.push_back({static_cast<Index>(std::llround(multiple * constant * rate)), 1});
  const auto records = channel_information(motion, readings);
  VectorXd information(4);
  for (Index i = 0; i < 4; ++i)
    information[i] =
        1.0 / relative_bounds(information_about_unknowns(motion, records[i], {{0, noise}})).cwiseAbs2()[1];
  const double expected[] = {0.24, 0.91, 0.98}, multiples[] = {1.0, 3.0, 4.0};
  for (Index i = 0; i < 3; ++i) {
    const double found = information[i] / information[3];
    EXPECT_NEAR(found, expected[i], 0.005);
    const double d = 1.0 / constant;
    EXPECT_NEAR(found, DecayMoments(d, multiples[i] * constant).left() * 8.0 * d * d * d, 0.003);
  }
}

TEST(SamplingRate, LowersBoundsByItsSquareRoot) {
  const auto motion = oscillating(4.371662, 1.7299, 0.0015, 0.012, 1.0 / rate, 2);
  const auto records =
      channel_information(motion, {{20000, 1}, {20000, 2}, {20000, 5}, {20000, 10}, {20000, 100}});
  std::vector<VectorXd> bounds;
  for (const ChannelInformation& record : records)
    bounds.push_back(relative_bounds(information_about_unknowns(motion, record, {{0, noise}})));
  const double strides[] = {1, 2, 5, 10, 100};
  for (std::size_t i = 0; i < 5; ++i)
    for (Index j = 0; j < 2; ++j)
      EXPECT_NEAR(bounds[i][j] / bounds[0][j] / std::sqrt(strides[i]), 1.0, 0.01) << strides[i];
}

filters::InformationReport report_of(const ObservedMotion& motion, Index samples) {
  const ChannelInformation record = channel_information(motion, {{samples, 1}}).front();
  return filters::determined_combinations(information_about_unknowns(motion, record, {{0, noise}}),
                                          VectorXd::Ones(3));
}

TEST(FreeDecay, TellsStiffnessDampingAndMassInCombinationOnly) {
  // K, C and M in proportion give the same motion: K/M and C/M are all there is.
  const auto motion = oscillating(3.0, 2.0869, 0.01, 0.012, 1.0 / rate, 3);
  const auto report = report_of(motion, 5000);
  EXPECT_EQ(report.rank, 2);
  for (Index i = 0; i < 3; ++i) EXPECT_FALSE(report.determined(i));
  const VectorXd silent = report.undetermined().col(0);
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(std::abs(silent[i]), 1.0 / std::sqrt(3.0), 1e-6);
  for (const ParameterBound& bound : parameter_bounds(motion, report)) {
    EXPECT_EQ(bound.verdict, ParameterBound::Verdict::combination);
    EXPECT_TRUE(std::isinf(bound.bound));
    EXPECT_TRUE(std::isfinite(bound.conditional_bound));
  }
}

// The acceleration that the step-wise constant force f causes, from the start x, v.
VectorXd response(double x, double v, double stiffness, double damping, double mass, const VectorXd& f) {
  using Complex = std::complex<double>;
  const double d = damping / (2.0 * mass), omega = std::sqrt(stiffness / mass - d * d);
  const Complex lambda(-d, omega), step = std::exp(lambda / rate);
  VectorXd acceleration(f.size());
  for (Index k = 0; k < f.size(); ++k) {
    acceleration[k] = (f[k] - stiffness * x - damping * v) / mass;
    const double rest = f[k] / stiffness, u = x - rest;
    const Complex moved = Complex(u, -(v + d * u) / omega) * step;  // u = Re(c e^(lambda t))
    x = moved.real() + rest;
    v = (lambda * moved).real();
  }
  return acceleration;
}

TEST(AKnownForce, MakesTheMassIdentifiableToo) {
  // Oracle: the response in closed form, differentiated by differences, and the information inverted.
  auto motion = oscillating(3.0, 2.0869, 0.01, 0.0, 1.0 / rate, 3, true);
  VectorXd force = VectorXd::Zero(5000);
  for (Index k = 0; k < 20; ++k) force[k] = 100.0 * std::sin(M_PI * static_cast<double>(k) / 20.0);
  motion.inputs = force.transpose();
  const auto report = report_of(motion, 5000);
  EXPECT_EQ(report.rank, 3);

  const VectorXd at = motion.initial_state;
  MatrixXd slopes(5000, 5);
  const double steps[] = {1e-3, 1e-2, 1e-4 * at[2], 1e-4 * at[3], 1e-4 * at[4]};
  for (Index j = 0; j < 5; ++j) {
    VectorXd up = at, down = at;
    up[j] += steps[j];
    down[j] -= steps[j];
    slopes.col(j) = (response(up[0], up[1], up[2], up[3], up[4], force) -
                     response(down[0], down[1], down[2], down[3], down[4], force)) /
                    (2.0 * noise) * (j < 2 ? 1.0 / steps[j] : 1e4);
  }
  const VectorXd expected = (slopes.transpose() * slopes).inverse().diagonal().cwiseSqrt().tail(3);
  for (Index j = 0; j < 3; ++j) {
    EXPECT_TRUE(report.determined(j));
    EXPECT_NEAR(report.bounds[j] / expected[j], 1.0, 1e-5) << j;
  }
}

TEST(AMassKnownToTwoPerCent, MakesTheStiffnessKnownToTwoPerCent) {
  auto motion = oscillating(3.0, 2.0869, 0.01, 0.012, 1.0 / rate, 3);
  motion.model.unknowns[2].nuisance = true;
  motion.model.unknowns[2].deviation = 0.02 * 3.0;
  motion.directions = start_directions(motion.model, {{Quantity::acceleration}}, {0.012, 1.0});
  const auto report = report_of(motion, 5000);
  const auto free = bounds_of(oscillating(3.0, 2.0869, 0.01, 0.012, 1.0 / rate, 2), 5000, noise);
  // K = (K/M) M: the variances of two independent factors add.
  EXPECT_NEAR(report.bounds[0], std::hypot(0.02, free[0]), 1e-6);
  EXPECT_NEAR(report.bounds[1], std::hypot(0.02, free[1]), 1e-6);
  EXPECT_NEAR(report.bounds[2], 0.02, 1e-9);
  EXPECT_NEAR(report.correlations(0, 2), 1.0, 1e-3);
}

}  // namespace
}  // namespace beamid::experiments::analytic_laws_test
