// Uniform Euler-Bernoulli beams: w = A cos y + B sin y + C cosh y + D sinh y, y = b x / L, omega = b^2 / L^2
// sqrt(EI / rho A). Each frequency equation is the determinant of the four end conditions: w = w' = 0
// clamped, w = w'' = 0 pinned, w' = w''' = 0 guided, w'' = w''' = 0 free.
#include <numbers>
#include <random>

#include "tests/fem/verification/oracle.hpp"

namespace beamid::supports_test {
namespace {

using std::cos, std::sin, std::tan, std::tanh;
using test::angular_frequency, test::length;

constexpr fem::Support clamped_root{0.0, true, true}, clamped_tip{length, true, true};
constexpr fem::Support pinned_root{0.0, true, false}, pinned_tip{length, true, false};
constexpr fem::Support guided_root{0.0, false, true}, guided_tip{length, false, true};

std::vector<double> frequencies(std::vector<double> b, int rigid = 0) {
  for (double& root : b) root = angular_frequency(root);
  b.insert(b.begin(), rigid, 0.0);
  return b;
}

// Each is divided by cosh b.
const auto free_free = [](double b) { return cos(b) - 1.0 / std::cosh(b); };     // cos b cosh b = 1
const auto clamped_free = [](double b) { return cos(b) + 1.0 / std::cosh(b); };  // cos b cosh b = -1
const auto clamped_pinned = [](double b) { return sin(b) - cos(b) * tanh(b); };  // tan b = tanh b
const auto clamped_guided = [](double b) { return sin(b) + cos(b) * tanh(b); };  // tan b = -tanh b

TEST(Supports, ClampedFree) {
  test::expect_frequencies(test::uniform_beam({clamped_root}), frequencies(test::roots(clamped_free, 5)));
}

TEST(Supports, ClampedClamped) {
  test::expect_frequencies(test::uniform_beam({clamped_root, clamped_tip}),
                           frequencies(test::roots(free_free, 5, 0.01, 1.0)));
}

TEST(Supports, ClampedPinned) {
  const auto known = frequencies(test::roots(clamped_pinned, 5, 0.01, 1.0));
  test::expect_frequencies(test::uniform_beam({clamped_root, pinned_tip}), known);
  test::expect_frequencies(test::uniform_beam({pinned_root, clamped_tip}), known);
}

TEST(Supports, ClampedGuided) {
  test::expect_frequencies(test::uniform_beam({clamped_root, guided_tip}),
                           frequencies(test::roots(clamped_guided, 5)));
}

TEST(Supports, PinnedPinned) {  // sin b = 0
  std::vector<double> b;
  for (int n = 1; n <= 5; ++n) b.push_back(n * std::numbers::pi);
  test::expect_frequencies(test::uniform_beam({pinned_root, pinned_tip}), frequencies(b));
}

TEST(Supports, GuidedPinned) {  // cos b = 0
  std::vector<double> b;
  for (int n = 1; n <= 5; ++n) b.push_back((n - 0.5) * std::numbers::pi);
  test::expect_frequencies(test::uniform_beam({guided_root, pinned_tip}), frequencies(b));
}

TEST(Supports, FreeFreeHasTwoRigidModesOfFrequencyZero) {
  test::expect_frequencies(test::uniform_beam({}), frequencies(test::roots(free_free, 4, 0.01, 1.0), 2));
}

TEST(Supports, PinnedFreeHasOneRigidMode) {
  test::expect_frequencies(test::uniform_beam({pinned_root}),
                           frequencies(test::roots(clamped_pinned, 4, 0.01, 1.0), 1));
}

TEST(Supports, GuidedFreeHasOneRigidMode) {
  test::expect_frequencies(test::uniform_beam({guided_root}), frequencies(test::roots(clamped_guided, 4), 1));
}

TEST(Supports, GuidedGuidedHasOneRigidMode) {  // sin b = 0
  std::vector<double> b;
  for (int n = 1; n <= 4; ++n) b.push_back(n * std::numbers::pi);
  test::expect_frequencies(test::uniform_beam({guided_root, guided_tip}), frequencies(b, 1));
}

TEST(Supports, TwoEqualSpansVibrateAsPinnedPinnedAndAsClampedPinned) {
  // Oracle: about the middle support, antisymmetric modes have no moment there and symmetric ones no
  // rotation; each span is then pinned-pinned or clamped-pinned, of half the length.
  const auto clamped = test::roots(clamped_pinned, 2, 0.01, 1.0);
  std::vector<double> b;
  for (int n = 1; n <= 2; ++n) b.insert(b.end(), {2 * n * std::numbers::pi, 2 * clamped[n - 1]});
  test::expect_frequencies(test::uniform_beam({pinned_root, {0.5 * length, true, false}, pinned_tip}),
                           frequencies(b));
}

// Counts of roots err where two pivots round differently, within some 1e-15 of a frequency; no search for the
// next root and no shape may trust one there. Oracle: tan b = tanh b (clamped-pinned, whose frequencies a
// pinned-free beam has, too) and tan b = -tanh b (guided-free), solved here; every beam has them after
// scaling.
TEST(Supports, FrequenciesAndShapesOfAnyUniformBeamAreThoseOfItsKind) {
  const auto root = [](int n, double sign) {
    double b = n * std::numbers::pi;
    for (int k = 0; k < 50; ++k) b = n * std::numbers::pi + sign * std::atan(std::tanh(b));
    return b;
  };
  struct Kind {
    std::vector<double> b;
    std::vector<double> at;  // supports over the length
    bool pinned;
  };
  const std::vector<Kind> kinds{
      {{0.0, root(1, 1), root(2, 1), root(3, 1), root(4, 1), root(5, 1)}, {0.0}, true},
      {{0.0, root(1, -1), root(2, -1), root(3, -1), root(4, -1), root(5, -1)}, {0.0}, false},
      {{2 * std::numbers::pi, 2 * root(1, 1), 4 * std::numbers::pi, 2 * root(2, 1), 6 * std::numbers::pi,
        2 * root(3, 1)},
       {0.0, 0.5, 1.0},
       true}};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(0.1, 10.0);
  for (int beams = 0; beams < 200; ++beams)
    for (const Kind& kind : kinds) {
      fem::Beam beam;
      const double span = any(random), stiffness = any(random), mass = any(random);
      beam.segments = {{span, {stiffness, mass, 0.0, {}, {}, {}}}};
      for (const double at : kind.at) beam.supports.push_back({at * span, kind.pinned, !kind.pinned});
      const auto modes = fem::exact_modes(beam, 6, Eigen::VectorXd::LinSpaced(41, 0.0, span));
      for (int i = 0; i < 6; ++i) {
        const double b = kind.b[static_cast<std::size_t>(i)],
                     expected = b * b * std::sqrt(stiffness / mass) / (span * span);
        ASSERT_NEAR(modes->angular_frequency[i], expected, 1e-13 * expected)
            << span << " " << stiffness << " " << mass;
        ASSERT_GT(modes->deflection.col(i).cwiseAbs().maxCoeff(), 0.5)
            << span << " " << stiffness << " " << mass;
      }
    }
}

TEST(Supports, SpansOnTheTwoSidesOfAClampShareTheirFrequencies) {
  // Oracle: clamped-clamped spans of half the length, each frequency twice.
  std::vector<double> b;
  for (const double root : test::roots(free_free, 2, 0.01, 1.0)) b.insert(b.end(), {2 * root, 2 * root});
  test::expect_frequencies(test::uniform_beam({clamped_root, {0.5 * length, true, true}, clamped_tip}),
                           frequencies(b));
}

TEST(Supports, TheHundredthModeIsExactWithoutAMesh) {
  // Oracle: for high modes cos b cosh b = -1 has the root (n - 1/2) pi to rounding.
  const auto modes = fem::exact_modes(test::uniform_beam({clamped_root}), 100,
                                      Eigen::VectorXd::LinSpaced(2001, 0.0, length));
  EXPECT_NEAR(modes->angular_frequency[99] / angular_frequency(99.5 * std::numbers::pi), 1.0, 1e-13);
  // Oracle: far from its ends the shape is a sine of the same wave number, its amplitude 1/2 of that at the
  // free tip.
  EXPECT_NEAR(modes->deflection(2000, 99), 1.0, 1e-12);
  EXPECT_NEAR(modes->deflection.col(99).segment(500, 1000).cwiseAbs().maxCoeff(), std::sqrt(0.5), 1e-3);
}

}  // namespace
}  // namespace beamid::supports_test
