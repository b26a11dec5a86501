// Is the claimed error of the mesh honest? Oracles: the exact modes of the continuum, and for sharp tips the
// roots of Bessel functions.
#include <gtest/gtest.h>

#include <boost/math/special_functions/bessel.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "experiments/studies/continuum/modal_summary.hpp"
#include "tests/fem/verification/oracle.hpp"

namespace beamid::experiments::mesh_error_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

ModalSummary summary_of(const fem::Beam& beam, int elements, Index modes) {
  Experiment experiment;
  experiment.structure = beam;
  experiment.elements = elements;
  return summarise_modes(experiment, modes, [](const std::string&) {});
}

/// The least claimed / true of the modes whose true error is above rounding.
double least_honesty(const ModalSummary& summary, const VectorXd& error) {
  double least = 1e300;
  for (Index i = summary.modes.rigid; i < summary.modes.size(); ++i)
    if (std::abs(error[i]) > 1e-10)
      least = std::min(least, summary.discretisation_error[i] / std::abs(error[i]));
  return least;
}

// Before: from half the elements, down to 1/1000 of the truth where the pieces could not be halved.
TEST(MeshError, IsNeverBelowHalfTheTruthOnRandomBeams) {
  std::mt19937_64 random(5);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  double least = 1e300;
  Index compared = 0;
  for (int k = 0; k < 150; ++k) {
    fem::Beam beam;
    const int segments = 1 + static_cast<int>(uniform(0, 8));
    for (int i = 0; i < segments; ++i)
      beam.segments.push_back(
          {uniform(0.1, 1.0), {std::exp(uniform(0, 3)), std::exp(uniform(0, 2)), 0.0, {}, {}, {}}});
    beam.supports = {{0.0, true, uniform(0, 1) < 0.7}};
    if (!beam.supports[0].rotation || uniform(0, 1) < 0.3)
      beam.supports.push_back({beam.length(), true, false});
    if (uniform(0, 1) < 0.3) beam.bodies.push_back({uniform(0.2, 0.8) * beam.length(), uniform(0, 2), 0, 0});
    const int elements = 2 + static_cast<int>(std::exp(uniform(0, 4)));
    const ModalSummary summary = summary_of(beam, elements, 4);
    const double honesty = least_honesty(summary, summary.exact_error());
    EXPECT_GT(honesty, 0.5) << k << ": " << segments << " segments, " << elements << " elements";
    least = std::min(least, honesty);
    compared += summary.modes.size();
  }
  EXPECT_GT(compared, 550);
  RecordProperty("least_claimed_over_true", std::to_string(least));
}

// 40 elements and 39 segments: one piece alone can be halved.
TEST(MeshError, IsHonestWithAsManySegmentsAsElements) {
  for (const int segments : {30, 39, 40}) {
    fem::Beam beam;
    for (int i = 0; i < segments; ++i)
      beam.segments.push_back({1.0 / segments, {1.0 + 0.5 * (i % 2), 1.0, 0.0, {}, {}, {}}});
    beam.supports = {{0.0, true, true}};
    const ModalSummary summary = summary_of(beam, 40, 6);
    EXPECT_GT(least_honesty(summary, summary.exact_error()), 0.5) << segments;
  }
}

TEST(MeshError, IsHonestInStrongTension) {
  for (const double tension : {1e2, 1e4, 1e6, 1e8}) {
    fem::Beam beam;
    beam.segments = {{1.0, {1.0, 1.0, 0.0, {}, {}, {}}}};
    beam.supports = {{0.0, true, true}, {1.0, true, true}};
    beam.axial_load = -tension;
    for (const int elements : {10, 40}) {
      const ModalSummary summary = summary_of(beam, elements, 4);
      EXPECT_GT(least_honesty(summary, summary.exact_error()), 0.5) << tension << ", " << elements;
    }
  }
}

// (z^(n+2) w'')'' = k^2 z^n w: J_n I_(n+1) + J_(n+1) I_n = 0 at q = 2 sqrt(k z) of the clamped root; n = 1 a
// wedge, n = 2 a cone [kirchhoff1879].
TEST(MeshError, IsHonestAtASharpTip) {
  using boost::math::cyl_bessel_i, boost::math::cyl_bessel_j;
  for (const int n : {1, 2}) {
    const auto depth = fem::Variation::linear(1.0, 0.0), square = depth * depth;
    fem::Beam beam;
    beam.segments = {
        {1.0, {n == 1 ? square * depth : square * square, n == 1 ? depth : square, 0.0, {}, {}, {}}}};
    beam.supports = {{0.0, true, true}};
    const auto q = test::roots(
        [n](double x) {
          return (cyl_bessel_j(n, x) * cyl_bessel_i(n + 1, x) + cyl_bessel_j(n + 1, x) * cyl_bessel_i(n, x)) /
                 std::exp(x);
        },
        4, 0.01, 1.0);
    for (const int elements : {10, 20, 40}) {
      const ModalSummary summary = summary_of(beam, elements, 4);
      VectorXd error(4);
      for (Index i = 0; i < 4; ++i)
        error[i] = summary.modes.angular_frequency[i] /
                       (0.25 * q[static_cast<std::size_t>(i)] * q[static_cast<std::size_t>(i)]) -
                   1.0;
      EXPECT_GT(least_honesty(summary, error), 0.5) << n << ", " << elements;
    }
  }
}

}  // namespace
}  // namespace beamid::experiments::mesh_error_test
