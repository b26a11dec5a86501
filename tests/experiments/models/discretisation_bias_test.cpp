// Oracles: g^-1 inverted by hand and evaluated with 40 digits (mpmath 1.2); series in the time step; where a
// filter ends, numbers of an independent program.
#include "experiments/models/discretisation_bias.hpp"

#include <gtest/gtest.h>

#include "beamid/testing/oscillator.hpp"
#include "filters/filter_run.hpp"

namespace beamid::experiments::discretisation_bias_test {
namespace {

constexpr double interval = 1e-3;

Oscillator paper_example() {
  return Oscillator::from_frequency(3.0, std::sqrt(515.8 / 3.0), 0.10);
}

struct Bias {
  double stiffness, damping;  // [%]
};

Bias bias_of(const std::string& scheme, const Oscillator& truth, double dt) {
  const Oscillator seen = seen_through(scheme, truth, dt);
  return {percent(seen.stiffness, truth.stiffness), percent(seen.damping, truth.damping)};
}

TEST(DiscretisationBias, IsThatOfThePapersExampleForEveryScheme) {
  // With z = lambda dt, y = lambda_f dt: y = e^z - 1; 1 - e^-z; 2 tanh(z/2); sqrt(2 e^z - 1) - 1; the root of
  // 1 + y + y^2/2 + y^3/6 + y^4/24 = e^z; z.
  const struct {
    const char* scheme;
    Bias expected;
  } cases[] = {{"forward_euler", {-0.132439696829, 6.41647580677}},
               {"backward_euler", {0.129803399263, -6.43343965909}},
               {"implicit_midpoint", {0.00280831034076, 0.00424114050869}},
               {"runge_kutta_2", {-0.0056323583899, -0.00822071215856}},
               {"runge_kutta_4", {4.56223838069e-8, 1.16053896885e-7}},
               {"exponential", {0.0, 0.0}}};
  for (const auto& [scheme, expected] : cases) {
    const Bias found = bias_of(scheme, paper_example(), interval);
    EXPECT_NEAR(found.stiffness, expected.stiffness, 2e-11) << scheme;
    EXPECT_NEAR(found.damping, expected.damping, 2e-11) << scheme;
  }
}

TEST(DiscretisationBias, OfForwardEulerFollowsItsExpansionInStiffness) {
  // Oracle: |1 + z/2 + z^2/6|^2 - 1 = -xi w dt - (w dt)^2/12 + (2/3) xi^2 (w dt)^2 + O((w dt)^3); halving the
  // step divides what is left by eight.
  for (const double ratio : {0.0015, 0.02, 0.1, 0.3}) {
    const Oscillator truth = Oscillator::from_frequency(3.0, 13.0, ratio);
    const auto rest = [&](double dt) {
      const double step = 13.0 * dt;
      return 0.01 * bias_of("forward_euler", truth, dt).stiffness + ratio * step +
             (1.0 / 12.0 - 2.0 / 3.0 * ratio * ratio) * step * step;
    };
    EXPECT_LT(std::abs(rest(4e-3)), std::pow(13.0 * 4e-3, 3)) << ratio;
    if (ratio < 0.01) continue;  // hardly any third order then, it is proportional to xi
    EXPECT_NEAR(rest(1e-3) / rest(5e-4), 8.0, 0.2) << ratio;
  }
}

TEST(DiscretisationBias, OfForwardEulerFollowsItsExpansionInDamping) {
  // Oracle: C_f - C = K dt (1 - 2 xi^2) + O(dt^2), the next term being -M Re(lambda^3) dt^2 / 3.
  for (const double ratio : {0.0015, 0.02, 0.1, 0.3}) {
    const Oscillator truth = Oscillator::from_frequency(3.0, 13.0, ratio);
    for (const double dt : {1e-4, 1e-3, 4e-3}) {
      const double rest = seen_through("forward_euler", truth, dt).damping - truth.damping -
                          truth.stiffness * dt * (1.0 - 2.0 * ratio * ratio);
      const double next = -truth.mass * std::pow(truth.eigenvalue(), 3).real() * dt * dt / 3.0;
      EXPECT_NEAR(rest, next, truth.mass * std::pow(13.0, 4) * std::pow(dt, 3) / 12.0 * 1.1) << ratio;
    }
  }
}

TEST(DiscretisationBias, OfTheLightestBeamNeedsTheSecondOrder) {
  // Oracle: K -0.0109 %, C +651.10 % for S(0.65), M = 0.739965 kg, f = 4.145511 Hz, xi = 0.2 %; the first
  // order alone would say -0.0052 %.
  const Oscillator light =
      Oscillator::from_frequency(0.739964642857132, 2.0 * std::numbers::pi * 4.145510989755273, 0.002);
  const Bias found = bias_of("forward_euler", light, interval);
  EXPECT_NEAR(found.stiffness, -0.0108625238414, 2e-11);
  EXPECT_NEAR(found.damping, 651.099400240762, 2e-8);
}

TEST(DiscretisationBias, HasTheOrderOfItsScheme) {
  // Oracle: a scheme of order p errs by O(dt^p), so that halving the step divides its bias by 2^p.
  const std::pair<const char*, int> orders[] = {{"forward_euler", 1},
                                                {"backward_euler", 1},
                                                {"implicit_midpoint", 2},
                                                {"runge_kutta_2", 2},
                                                {"runge_kutta_4", 4}};
  for (const auto& [scheme, order] : orders)
    EXPECT_NEAR(std::log2(bias_of(scheme, paper_example(), 2e-3).damping /
                          bias_of(scheme, paper_example(), 1e-3).damping),
                order, 0.05)
        << scheme;
}

TEST(DiscretisationBias, IsFoundAtEveryInterval) {
  // Oracle: what is seen, moved by the scheme, is the exact motion again: 1 / (1 - z) for backward Euler,
  // (2 + z) / (2 - z) for the midpoint rule.
  const Oscillator truth = paper_example();
  for (double dt = 1e-6; dt < 1e-2; dt *= 1.05) {
    const std::complex<double> moved = std::exp(truth.eigenvalue() * dt);
    const auto seen = [&](const char* scheme) { return seen_through(scheme, truth, dt).eigenvalue() * dt; };
    EXPECT_LT(std::abs(1.0 / (1.0 - seen("backward_euler")) - moved), 1e-15) << dt;
    const std::complex<double> midpoint = seen("implicit_midpoint");
    EXPECT_LT(std::abs((2.0 + midpoint) / (2.0 - midpoint) - moved), 1e-15) << dt;
    EXPECT_NO_THROW(seen("runge_kutta_2")) << dt;
    EXPECT_NO_THROW(seen("runge_kutta_4")) << dt;
  }
}

TEST(DiscretisationBias, OfForwardEulerObeysThePapersLaw) {
  // Oracle: [inverse2009] found the relative error of C inversely proportional to xi sqrt(M) at equal K; the
  // product of the two is sqrt(K) dt / 2 to first order.
  const double stiffness = 516.0;
  for (const double mass : {0.74, 1.08, 2.06, 3.05, 4.36})
    for (const double ratio : {0.0015, 0.0045}) {
      const Oscillator beam = Oscillator::from_frequency(mass, std::sqrt(stiffness / mass), ratio);
      const double product =
          0.01 * bias_of("forward_euler", beam, interval).damping * ratio * std::sqrt(mass);
      EXPECT_NEAR(product / (0.5 * std::sqrt(stiffness) * interval), 1.0, 1e-3);
    }
}

/// Where a forward-Euler EKF on displacement and velocity of the paper's oscillator ends, without noise in
/// them, from 12 mm, K = 300 N/m, C = 2 N s/m.
struct ObservedTwice {
  Eigen::Vector2d r{1e-5, 1e-5};  ///< R of x [m2] and v [m2/s2]
  double q = 0;                   ///< Q of x and of v, per step
  double parameters = 1e5;        ///< P0 of K and C

  Bias found() const {
    const Oscillator truth = paper_example();
    filters::Noise noise{{}, r.asDiagonal()};
    if (q > 0) noise.process = Eigen::Vector4d(q, q, 0, 0).asDiagonal();
    const auto filter =
        filters::filter_registry().make("ekf", {},
                                        filters::discretise(std::make_shared<test::Oscillator>(truth.mass, 2),
                                                            interval, "forward_euler", noise));
    constexpr Eigen::Index samples = 5000;
    filters::Measurements record;
    record.time = Eigen::VectorXd::LinSpaced(samples, 1, samples) * interval;
    record.outputs.resize(2, samples);
    const std::complex<double> pole = truth.eigenvalue(),
                               start = 0.012 * std::complex(1.0, pole.real() / pole.imag());
    for (Eigen::Index k = 0; k < samples; ++k) {
      const std::complex<double> x = start * std::exp(pole * record.time[k]);
      record.outputs.col(k) << x.real(), (pole * x).real();
    }
    const Eigen::Vector4d variance(1, 1, parameters, parameters);
    const filters::FilterRun run =
        filters::run(*filter, {Eigen::Vector4d(0.012, 0, 300, 2), variance.asDiagonal()}, record,
                     filters::Keep::last_estimate, filters::Start::one_interval_before);
    return {percent(run.last.mean[2], truth.stiffness), percent(run.last.mean[3], truth.damping)};
  }
};

// Oracle: an independent program, C off by the percentages below. docs/theory/discretisation_bias.md.
TEST(ForwardEulerOnTwoChannels, CompromisesByTheirNoise) {
  EXPECT_NEAR((ObservedTwice{.r = {1e-5, 1e-5}}.found().damping), 6.414, 5e-4);
  EXPECT_NEAR((ObservedTwice{.r = {1e-5, 1e-3}}.found().damping), 6.242, 5e-4);
  EXPECT_NEAR((ObservedTwice{.r = {1e-5, 1e-7}}.found().damping), 6.416, 1e-3);
  EXPECT_NEAR((ObservedTwice{.r = {1e-7, 1e-5}}.found().damping), 6.304, 5e-4);
  EXPECT_NEAR((ObservedTwice{.r = {1e-3, 1e-5}}.found().damping), 6.476, 5e-4);
}

// Oracle: the same program with Q; and without noise of readings the regression from one sample to the next,
// x'_k+1 = x'_k - dt (K x_k + C x'_k) / M, in which the exact transition Phi leaves C = (1 - Phi_22) M / dt,
// to first order C + K dt / 2: half the bias.
TEST(ForwardEulerOnTwoChannels, IsBiasedByHalfWhereProcessNoiseIsLarge) {
  EXPECT_NEAR((ObservedTwice{.q = 1e-12}.found().damping), 6.411, 1e-3);
  EXPECT_NEAR((ObservedTwice{.q = 1e-10}.found().damping), 6.185, 5e-4);
  EXPECT_NEAR((ObservedTwice{.q = 1e-8}.found().damping), 3.555, 5e-4);
  EXPECT_NEAR((ObservedTwice{.q = 1e-6}.found().damping), 2.951, 5e-4);
  const Oscillator truth = paper_example();
  const std::complex<double> pole = truth.eigenvalue(), moved = std::exp(pole * interval);
  const double phi_22 = moved.real() + moved.imag() * pole.real() / pole.imag();
  const double regression = percent((1 - phi_22) * truth.mass / interval, truth.damping);
  EXPECT_NEAR(regression, 3.14, 5e-3);
  EXPECT_NEAR((ObservedTwice{.r = {1e-12, 1e-12}, .q = 1e-8}.found().damping), regression, 2e-3);
}

// Oracle: the published 0.13 % and 6.41 %.
TEST(ForwardEulerOnTwoChannels, HasThePublishedDigitsUnderAnyInitialVarianceFromTenThousandOn) {
  for (const double variance : {1e4, 1e5, 1e6, 1e8}) {
    const Bias found = ObservedTwice{.parameters = variance}.found();
    EXPECT_EQ(std::round(100 * found.stiffness), -13) << variance;
    EXPECT_EQ(std::round(100 * found.damping), 641) << variance;
  }
  EXPECT_EQ(std::round(100 * ObservedTwice{.parameters = 1e3}.found().damping), 645);
}

TEST(DiscretisationBias, RefusesWhatDoesNotOscillate) {
  EXPECT_THROW(seen_through("forward_euler", {3.0, 515.8, 1e3}, interval), std::invalid_argument);
  EXPECT_THROW(seen_through("no_such_scheme", paper_example(), interval), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::discretisation_bias_test
