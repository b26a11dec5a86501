// Average acceleration in time: x'' = -omega^2 x is advanced exactly as if its frequency were
// (2 / dt) atan(omega dt / 2), and its amplitude is kept [hughes1987]: with z = omega dt / 2 the trapezoidal
// rule multiplies x + i x' / omega by (1 - i z) / (1 + i z) = e^(-2 i atan z) each step.
#include <cmath>

#include "fem/response/response.hpp"
#include "tests/fem/verification/oracle.hpp"

namespace beamid::newmark_test {
namespace {

TEST(Newmark, PeriodIsLongerByTheArcTangent) {
  fem::Beam beam = test::uniform_beam();
  beam.supports = {{0.0, true, true}};
  beam.bodies = {{test::length, 0.3, 0.0, 0.0}};
  const auto system = fem::assemble(beam, 20);
  const auto modes = fem::modes(system, 2);
  for (int mode = 0; mode < 2; ++mode) {
    const double omega = modes.angular_frequency[mode], dt = 0.4 / omega;
    const Eigen::VectorXd shape = modes.shape.col(mode) / (system.outputs * modes.shape.col(mode))[0];
    const fem::TimeGrid grid{dt, 2000, {}};
    const auto motion = fem::respond(system, {}, {shape, {}, {}}, grid, {"newmark", {}});
    const double angle = 2.0 * std::atan(0.5 * omega * dt);
    double worst = 0.0;
    for (Eigen::Index k = 0; k < grid.samples; ++k)
      worst = std::max(worst, std::abs(motion.displacement(0, k) - std::cos(angle * static_cast<double>(k))));
    test::record("newmark", worst);
    EXPECT_LT(worst, 1e-8) << "mode " << mode + 1;
  }
}

}  // namespace
}  // namespace beamid::newmark_test
