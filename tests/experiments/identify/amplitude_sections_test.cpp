// One value of damping where it depends on amplitude: how much of the decay its interval holds. Oracle: the
// damping ratio that the simulation had at each instant.
#include "experiments/identify/verdict/amplitude_sections.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "experiments/models/estimates.hpp"
#include "experiments/studies/identify/report.hpp"
#include "tests/experiments/identify/simulated_record.hpp"

namespace beamid::experiments::amplitude_sections_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

const test::SimulatedBeam simulated;

/// A decay whose amplitude and phase follow A' = -xi(A) w(A) A, phi' = w(A) by small steps: what friction
/// that grows with amplitude, and a spring that softens, do to one mode (averaging, exact for weak damping).
struct Varying {
  Record record;
  VectorXd damping_ratio, frequency_hz;  // at every sample
};

struct Law {
  double ratio_at_rest, ratio_more;  // xi(A) = at rest + more (A / A0)^power
  double power, softening;           // w(A) = w0 (1 - softening (A / A0)^power)
};

Varying varying(const Law& law, double periods, double noise, std::uint64_t seed) {
  constexpr double per_period = 24;
  constexpr int fine = 20;
  const double w0 = simulated.mode.angular_frequency(), dt = 2 * std::numbers::pi / (w0 * per_period);
  const auto count = static_cast<Index>(periods * per_period);
  Varying result{{}, VectorXd(count), VectorXd(count)};
  result.record.time = VectorXd::LinSpaced(count, 0, dt * static_cast<double>(count - 1));
  result.record.channels = {{Quantity::acceleration, "tip"}};
  result.record.samples = noise * standard_normal(count, seed, 0).transpose();
  double log_amplitude = 0, phase = 0.3;
  for (Index k = 0; k < count; ++k) {
    const auto share = [&] { return std::pow(std::exp(log_amplitude), law.power); };
    result.damping_ratio[k] = law.ratio_at_rest + law.ratio_more * share();
    result.frequency_hz[k] = w0 * (1 - law.softening * share()) / (2 * std::numbers::pi);
    result.record.samples(0, k) += std::exp(log_amplitude) * std::cos(phase);
    for (int i = 0; i < fine; ++i) {
      const double w = w0 * (1 - law.softening * share());
      log_amplitude -= (law.ratio_at_rest + law.ratio_more * share()) * w * dt / fine;
      phase += w * dt / fine;
    }
  }
  return result;
}

// Interval of the parameters, its half width over that of a constant, and how much of the decay it holds.
struct Held {
  double damping = 0, frequency = 0, damping_factor = 1, frequency_factor = 1;
};

Held held(const Varying& decay) {
  const RecordIdentification r = identify_record(simulated.experiment(), decay.record);
  const Identification& found = r.identification;
  const auto inside = [](const VectorXd& values, double estimate, double half) {
    return static_cast<double>(((values.array() - estimate).abs() < half).count()) /
           static_cast<double>(values.size());
  };
  // |s| of s = w (-xi + i), as frequency and damping are defined
  const VectorXd frequency = decay.frequency_hz.array() * (1 + decay.damping_ratio.array().square()).sqrt();
  return {inside(decay.damping_ratio, found.found.damping_ratio(),
                 quantile_95 * r.damping_factor() * found.damping_ratio_deviation),
          inside(frequency, found.found.frequency_hz(),
                 quantile_95 * r.frequency_factor() * found.frequency_deviation_hz),
          r.damping_factor() / r.interval_factor, r.frequency_factor() / r.interval_factor};
}

struct Uniform {
  std::mt19937_64 generator;
  double operator()(double from, double to) {
    return from + (to - from) * static_cast<double>(generator() >> 11) * 0x1p-53;
  }
};

// The rig's kind: from 0.7 down to 0.2 %, or less, with a frequency that falls by up to 0.5 %. Of all
// instants of all decays 93 to 97 % lie in the interval of their decay, whether a test finds the variation or
// not.
TEST(AmplitudeSections, MakeIntervalsThatHoldWhatTheDampingIsAlongTheDecay) {
  constexpr int decays = 150;
  Uniform between{std::mt19937_64(11)};
  double damping = 0, frequency = 0;
  for (int i = 0; i < decays; ++i) {
    const double at_rest = between(0.002, 0.004), more = between(0.0005, 0.005), power = between(0.5, 2.0),
                 softening = between(0.0, 0.005), periods = between(25, 90),
                 noise = std::exp(between(std::log(0.001), std::log(0.02)));
    const Held one = held(varying({at_rest, more, power, softening}, periods, noise, 100 + i));
    damping += one.damping;
    frequency += one.frequency;
  }
  EXPECT_NEAR(damping / decays, 0.95, 0.02);
  EXPECT_NEAR(frequency / decays, 0.95, 0.02);
}

// What cannot be excluded costs the intervals of constant decays little: half of them 5 % at most.
TEST(AmplitudeSections, HardlyWidenIntervalsOfConstantDecays) {
  constexpr int decays = 100;
  Uniform between{std::mt19937_64(12)};
  std::vector<double> damping, frequency;
  for (int i = 0; i < decays; ++i) {
    const double ratio = between(0.002, 0.008), periods = between(25, 90),
                 noise = std::exp(between(std::log(0.001), std::log(0.02)));
    const Held one = held(varying({ratio, 0, 1, 0}, periods, noise, 5000 + i));
    damping.push_back(one.damping_factor);
    frequency.push_back(one.frequency_factor);
  }
  for (std::vector<double>* factors : {&damping, &frequency}) {
    std::nth_element(factors->begin(), factors->begin() + decays / 2, factors->end());
    EXPECT_LT((*factors)[decays / 2], 1.05);
    EXPECT_GE((*factors)[decays / 2], 1.0);
  }
}

TEST(AmplitudeSections, SayWhatVariesAndByHowMuch) {
  const Varying decay = varying({0.002, 0.005, 1.0, 0.003}, 60, 0.005, 3);
  const RecordIdentification r = identify_record(simulated.experiment(), decay.record);
  ASSERT_TRUE(r.sections.damping.varies());
  ASSERT_TRUE(r.sections.frequency.varies());
  const Index last = decay.damping_ratio.size() - 1;
  EXPECT_NEAR(r.sections.damping.values[0], decay.damping_ratio[0], 0.0005);
  EXPECT_NEAR(r.sections.damping.values[r.sections.damping.values.size() - 1], decay.damping_ratio[last],
              0.0005);
  EXPECT_GT(r.damping_factor(), 2.0);
  std::ostringstream text;
  print(text, report(simulated.experiment(), decay.record, "varying.csv", r));
  EXPECT_NE(text.str().find("With the amplitude the damping ratio goes"), std::string::npos) << text.str();
}

// Of constant damping 1 % are taken for varying by each of two tests of two quantities, the best of three
// lines each: not above 12 of 100 decays.
TEST(AmplitudeSections, FindNoVariationWhereNoneIs) {
  int varies = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Record record = simulated.record({Quantity::acceleration}, 0.02, seed);
    ModalAnalysisSettings settings;
    settings.expected_frequency_hz = 3.5;
    const VectorXd signal = record.samples.row(0).transpose();
    const AmplitudeSections found =
        amplitude_sections(signal, record.interval(), dominant_mode(signal, record.interval(), settings));
    EXPECT_GE(found.sections.size(), 3u);
    varies += found.damping.varies() || found.frequency.varies();
  }
  EXPECT_LE(varies, 12);
}

// z ~ N(0, 1): 1.96; values spread evenly over +-1 with hardly any noise: 0.95; half of the probability on a
// constant known exactly, and half on that spread: 0.9 of the spread.
TEST(SectionHalfWidth, HoldsNineteenOfTwenty) {
  EXPECT_NEAR(section_half_width({}, 5.0, 0.1, 0.1), 0.196, 1e-4);
  SectionTrend trend;
  trend.constant = 0;
  trend.possible = VectorXd::LinSpaced(1000, -1, 1);
  trend.weight = VectorXd::Ones(1);
  EXPECT_NEAR(section_half_width(trend, 0.0, 1e-3, 1e-3), 0.95, 0.002);
  trend.constant = 0.5;
  trend.weight[0] = 0.5;
  EXPECT_NEAR(section_half_width(trend, 0.0, 1e-3, 1e-3), 0.9, 0.002);
  trend.constant = 0;
  trend.weight[0] = 1;
  trend.possible = VectorXd::Zero(1);
  trend.scatter = 0.3;
  EXPECT_NEAR(section_half_width(trend, 0.0, 0.4, 0.4), 1.96 * 0.5, 0.001);
}

// The law that a decay was simulated with: its slopes, and how sure they are (rms of 60 of them over their
// deviation is 1 +- 0.09).
TEST(AmplitudeLaw, IsThatOfTheDecay) {
  constexpr int decays = 60;
  const Law law{0.002, 0.004, 1.0, 0.003};
  const double w0 = simulated.mode.angular_frequency(), f0 = w0 / (2 * std::numbers::pi);
  double frequency = 0, damping = 0;
  for (int i = 0; i < decays; ++i) {
    const Varying decay = varying(law, 40, 0.01, 300 + i);
    const Record& record = decay.record;
    const AmplitudeLaw found =
        fit_amplitude_law(record.samples.row(0).transpose(), record.time[1], {1.0, 0.0},
                          {0.999 * f0, 0, 0.004, 0, 0.1}, VectorXd::LinSpaced(3, 0.0, 4.0));
    const LawLine &f = found.frequency_hz, &d = found.damping_ratio;
    frequency += std::pow((f.slope + law.softening * f0) / f.slope_deviation, 2) / decays;
    // the damping rate xi(A) w(A), per unit of A and of w: to first order and, at the pivot, to second
    const double slope = law.ratio_more - law.softening * (law.ratio_at_rest + 2 * law.ratio_more * d.pivot);
    damping += std::pow((d.slope - slope) / d.slope_deviation, 2) / decays;
    EXPECT_NEAR(found.shape[0], 1.0, 0.01);
  }
  EXPECT_NEAR(std::sqrt(frequency), 1, 0.25);
  EXPECT_NEAR(std::sqrt(damping), 1, 0.25);
}

}  // namespace
}  // namespace beamid::experiments::amplitude_sections_test
