// Oracle: the oscillators that made the motion, and what was done to the records.
#include "experiments/modal/channel_fault.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

namespace beamid::experiments::channel_fault_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr double interval = 0.01;

struct Pair {
  VectorXd base, response;
};

// A base that shakes at random and the oscillators {f, xi, Gamma} on it, exact between the samples of the
// base; noise of 1 % of the response.
Pair event(const std::vector<std::array<double, 3>>& modes, unsigned seed, Index samples = 4000) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Pair pair{VectorXd(samples), {}};
  double smooth = 0.0;
  for (Index k = 0; k < samples; ++k) {
    smooth = 0.7 * smooth + normal(generator);
    pair.base[k] =
        smooth *
        std::pow(std::sin(std::numbers::pi * static_cast<double>(k) / static_cast<double>(samples)), 2);
  }
  pair.response = pair.base;
  for (const auto& [frequency, ratio, participation] : modes) {
    const double w = 2.0 * std::numbers::pi * frequency, damped = w * std::sqrt(1.0 - ratio * ratio);
    const std::complex<double> rate(-ratio * w, damped), e = std::exp(rate * interval);
    const std::complex<double> first = (e - 1.0) / rate, second = (first - interval) / (rate * interval);
    std::complex<double> s = 0.0;
    for (Index k = 0; k < samples; ++k) {
      const double displacement = s.imag() / damped, velocity = (rate * s).imag() / damped;
      pair.response[k] += participation * (-pair.base[k] - 2.0 * ratio * w * velocity - w * w * displacement);
      const double further = k + 1 < samples ? pair.base[k + 1] : 0.0;
      s = e * s - first * pair.base[k] - second * (further - pair.base[k]);
    }
  }
  const double size = 0.01 * std::sqrt(pair.response.squaredNorm() / static_cast<double>(samples));
  for (Index k = 0; k < samples; ++k) pair.response[k] += size * normal(generator);
  return pair;
}

ChannelFault fault_of(const VectorXd& base, const VectorXd& response) {
  return channel_fault(base, response, interval);
}

VectorXd later(const VectorXd& signal, Index samples) {
  VectorXd result = VectorXd::Zero(signal.size());
  result.tail(signal.size() - samples) = signal.head(signal.size() - samples);
  return result;
}

const std::vector<std::array<double, 3>> one_mode{{2.5, 0.05, 1.0}},
    column{{2.5, 0.05, 1.25}, {5.6, 0.11, -0.35}, {8.3, 0.17, 0.1}},
    four_floors{{2.5, 0.05, 1.24}, {7.2, 0.05, -0.33}, {11.03, 0.05, 0.12}, {13.53, 0.05, -0.03}};

TEST(ChannelFault, HasNoneOfHealthyEvents) {
  for (const auto& modes : {one_mode, column, four_floors})
    for (unsigned seed = 0; seed < 4; ++seed)
      for (const Index samples : {Index{800}, Index{4000}}) {
        const Pair pair = event(modes, seed, samples);
        EXPECT_FALSE(fault_of(pair.base, pair.response).surely()) << modes.size() << " modes, seed " << seed;
      }
}

TEST(ChannelFault, HasNoneOfAnIsolatedStructure) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Pair isolated = event({{0.5, 0.1, 1.0}}, seed, 8000);
    EXPECT_FALSE(fault_of(isolated.base, isolated.response).surely()) << seed;
  }
}

TEST(ChannelFault, TellsASignThatIsTurned) {
  for (const auto& modes : {one_mode, column, four_floors})
    for (unsigned seed = 0; seed < 2; ++seed) {
      const Pair pair = event(modes, seed);
      const ChannelFault fault = fault_of(pair.base, -pair.response);
      EXPECT_EQ(fault.kind, ChannelFault::Kind::reversed) << modes.size() << " modes, seed " << seed;
      EXPECT_NEAR(fault.instead.damping_ratio, 0.05, 0.006);
    }
}

TEST(ChannelFault, TellsHowLateTheResponseIs) {
  for (const auto& modes : {one_mode, column, four_floors})
    for (unsigned seed = 0; seed < 2; ++seed) {
      const Pair pair = event(modes, seed);
      const ChannelFault late = fault_of(pair.base, later(pair.response, 5)),
                         early = fault_of(later(pair.base, 5), pair.response);
      EXPECT_EQ(late.kind, ChannelFault::Kind::late);
      EXPECT_NEAR(late.samples, 5, 1) << modes.size() << " modes, seed " << seed;
      EXPECT_EQ(early.kind, ChannelFault::Kind::late);
      EXPECT_NEAR(early.samples, -5, 1) << modes.size() << " modes, seed " << seed;
    }
}

TEST(ChannelFault, TellsBaseAndResponseExchanged) {
  for (const auto& modes : {one_mode, column, four_floors})
    for (unsigned seed = 0; seed < 2; ++seed) {
      const Pair pair = event(modes, seed);
      EXPECT_EQ(fault_of(pair.response, pair.base).kind, ChannelFault::Kind::exchanged)
          << modes.size() << " modes, seed " << seed;
    }
}

}  // namespace
}  // namespace beamid::experiments::channel_fault_test
