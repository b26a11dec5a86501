// Exact modal superposition against solutions of one oscillator, the matrix exponential, and the exact
// cantilever.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "fem/assembly.hpp"
#include "fem/complex_modes.hpp"
#include "fem/free_decay.hpp"
#include "fem/modes.hpp"
#include "fem/response/response.hpp"
#include "fem/stiffness_solver.hpp"
#include "tests/fem/five_beams.hpp"
#include "tests/fem/response/oscillator_system.hpp"

namespace beamid::modal_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using test::chain, test::one, test::oscillator, test::relative_error;
using Complex = std::complex<double>;

// x'' + 2 xi w x' + w^2 x = 0 from x0, v0, for every kind of damping.
struct FreeMotion {
  double w, xi, x0, v0;
  double operator()(double t) const {
    if (xi == 1.0) return std::exp(-w * t) * (x0 + (v0 + w * x0) * t);
    const Complex root = w * std::sqrt(Complex(xi * xi - 1.0)), fast = -xi * w - root, slow = -xi * w + root;
    return ((v0 - fast * x0) / (slow - fast) * std::exp(slow * t) +
            (slow * x0 - v0) / (slow - fast) * std::exp(fast * t))
        .real();
  }
};

TEST(ModalResponse, FreeMotionOfAnOscillatorIsExactAtAnyDampingRatio) {
  // Oracle: the roots of the characteristic equation. 5000 samples of 60 periods.
  const double w = 7.0;
  for (const double xi : {0.0, 0.002, 0.3, 1.0, 1.5, 20.0}) {
    const FreeMotion exact{w, xi, 0.01, 0.2};
    const auto response = respond(oscillator(2.0, 2.0 * w * w), fem::ModalDamping{{xi}},
                                  {one(0.01), one(0.2), {}}, {0.01, 5000});
    for (Index k = 0; k < 5000; ++k)
      ASSERT_NEAR(response.displacement(0, k), exact(0.01 * double(k)), 4e-14) << xi << " " << k;
  }
}

TEST(ModalResponse, IsExactForIntervalsOfManyPeriods) {
  // Oracle: as above; w dt = 700, where the exponent's own rounding is 1e-13 per sample.
  const FreeMotion exact{700.0, 1e-4, 1.0, 0.0};
  const auto response =
      respond(oscillator(1.0, 700.0 * 700.0), fem::ModalDamping{{1e-4}}, {one(1.0), {}, {}}, {1.0, 40});
  for (Index k = 0; k < 40; ++k) EXPECT_NEAR(response.displacement(0, k), exact(double(k)), 1e-11);
}

TEST(ModalResponse, StepAndRampAreExact) {
  // Oracle: x = 1/k (1 - e^(-xi w t) (cos wd t + xi w / wd sin wd t)) after a unit step, its integral after a
  // ramp.
  const double m = 3.0, w = 20.0, xi = 0.05, wd = w * std::sqrt(1 - xi * xi), dt = 0.013;
  const Index samples = 1000;
  fem::Loading step{{}, {}, MatrixXd::Zero(2, samples)}, ramp = step;
  step.inputs.row(0).setOnes();
  for (Index k = 0; k < samples; ++k) ramp.inputs(0, k) = dt * double(k);
  const auto system = oscillator(m, m * w * w);
  const auto stepped = respond(system, fem::ModalDamping{{xi}}, step, {dt, samples});
  const auto ramped = respond(system, fem::ModalDamping{{xi}}, ramp, {dt, samples});
  for (Index k = 0; k < samples; ++k) {
    const double t = dt * double(k), e = std::exp(-xi * w * t);
    const double unit = (1 - e * (std::cos(wd * t) + xi * w / wd * std::sin(wd * t))) / (m * w * w);
    ASSERT_NEAR(stepped.displacement(0, k), unit, 1e-12 / (m * w * w));
    ASSERT_NEAR(ramped.velocity(0, k), unit, 1e-12 / (m * w * w));
    ASSERT_NEAR(stepped.acceleration(0, k), e * (std::cos(wd * t) - xi * w / wd * std::sin(wd * t)) / m,
                1e-12 / m);
  }
}

TEST(ModalResponse, ImpulseIsAnInitialVelocity) {
  // Oracle: x = p / (m wd) e^(-xi w t) sin wd t.
  const double m = 2.0, w = 9.0, xi = 0.01, wd = w * std::sqrt(1 - xi * xi), momentum = 0.6;
  const auto response =
      respond(oscillator(m, m * w * w), fem::ModalDamping{{xi}}, {{}, one(momentum / m), {}}, {0.01, 3000});
  for (Index k = 0; k < 3000; ++k) {
    const double t = 0.01 * double(k);
    ASSERT_NEAR(response.displacement(0, k), momentum / (m * wd) * std::exp(-xi * w * t) * std::sin(wd * t),
                1e-13);
  }
}

// Steady state of an oscillator under sin(W t) that is sampled and linear in between: such an input is the
// sum of all aliases W + 2 pi j / dt with the factors (sin(W dt / 2) / ((W + 2 pi j / dt) dt / 2))^2, which
// all look alike at the samples. Each is answered by H.
template <class Receptance>
Complex sampled_harmonic(double frequency, double dt, const Receptance& h) {
  Complex sum = 0.0;
  for (int j = -4000; j <= 4000; ++j) {
    const double alias = frequency + 2.0 * std::numbers::pi * j / dt;
    sum += std::pow(std::sin(0.5 * frequency * dt) / (0.5 * alias * dt), 2) * h(alias);
  }
  return sum;
}

TEST(ModalResponse, HarmonicSteadyStateIsExact) {
  const double m = 2.0, w = 12.0, xi = 0.2, frequency = 9.0, dt = 0.05;
  const Index samples = 1000;  // e^(-xi w t) has fallen below 1e-50
  const auto h = [&](double at) { return 1.0 / (m * (w * w - at * at + Complex(0.0, 2.0 * xi * w * at))); };
  const Complex amplitude = sampled_harmonic(frequency, dt, h);
  fem::Loading loading{{}, {}, MatrixXd::Zero(2, samples)};
  for (Index k = 0; k < samples; ++k) loading.inputs(0, k) = std::sin(frequency * dt * double(k));
  const auto response = respond(oscillator(m, m * w * w), fem::ModalDamping{{xi}}, loading, {dt, samples});
  for (Index k = samples - 50; k < samples; ++k)
    ASSERT_NEAR(response.displacement(0, k) / std::abs(amplitude),
                (amplitude * std::polar(1.0, frequency * dt * double(k))).imag() / std::abs(amplitude),
                1e-12);
}

TEST(ModalResponse, BaseAccelerationMovesTheMassRelativeToTheBase) {
  // Oracle: z'' + 2 xi w z' + w^2 z = -a, whatever the mass.
  const double m = 5.0, w = 12.0, xi = 0.2, frequency = 15.0, dt = 0.02;
  const Index samples = 2000;
  const auto h = [&](double at) { return -1.0 / (w * w - at * at + Complex(0.0, 2.0 * xi * w * at)); };
  const Complex amplitude = sampled_harmonic(frequency, dt, h);
  fem::Loading loading{{}, {}, MatrixXd::Zero(2, samples)};
  for (Index k = 0; k < samples; ++k) loading.inputs(1, k) = std::sin(frequency * dt * double(k));
  const auto response = respond(oscillator(m, m * w * w), fem::ModalDamping{{xi}}, loading, {dt, samples});
  for (Index k = samples - 50; k < samples; ++k)
    ASSERT_NEAR(response.displacement(0, k) / std::abs(amplitude),
                (amplitude * std::polar(1.0, frequency * dt * double(k))).imag() / std::abs(amplitude),
                1e-12);
}

TEST(ModalResponse, DashpotsThatCoupleTheModesAreExactToo) {
  // Oracle: the exponential of the whole state matrix at every sample, from rest displaced, no modes
  // involved.
  const auto system = chain({1.0, 2.0, 0.5}, {300.0, 200.0, 400.0}, {0.0, 3.0, 0.5});
  MatrixXd a = MatrixXd::Zero(6, 6);
  a.topRightCorner(3, 3).setIdentity();
  a.bottomLeftCorner(3, 3) = -MatrixXd(system.mass).inverse() * MatrixXd(system.stiffness.assembled());
  a.bottomRightCorner(3, 3) = -MatrixXd(system.mass).inverse() * MatrixXd(system.damping);
  const VectorXd q0{{0.01, -0.02, 0.03}}, v0{{0.1, 0.0, -0.3}};
  VectorXd start(6);
  start << q0, v0;
  const auto response = respond(system, fem::Undamped{}, {q0, v0, {}}, {0.02, 300, {0, 7, 150, 299}});
  for (Index k = 0; k < 300; ++k) {
    const VectorXd state = (a * (0.02 * double(k))).exp() * start;
    ASSERT_NEAR(response.displacement(0, k), state[2], 1e-13);
    ASSERT_NEAR(response.velocity(0, k), state[5], 1e-12);
    ASSERT_NEAR(response.acceleration(0, k), (a * state)[5], 1e-10);
    for (Index frame = 0; frame < 4; ++frame)
      if (response.frames[frame] == k) {
        EXPECT_LT((response.field_displacement.col(frame) - state.head(3)).norm(), 1e-13);
        EXPECT_LT((response.field_velocity.col(frame) - state.tail(3)).norm(), 1e-12);
        EXPECT_LT((response.field_acceleration.col(frame) - (a * state).tail(3)).norm(), 1e-10);
      }
  }
}

TEST(ModalResponse, ForcedCoupledMotionSettlesAtTheStaticDeflection) {
  // Oracle: the static deflection of the springs in a row, f (1/k1 + 1/k2).
  const auto system = chain({1.0, 2.0}, {300.0, 200.0}, {5.0, 9.0});
  fem::Loading loading{{}, {}, MatrixXd::Zero(2, 5000)};
  loading.inputs.row(0).setConstant(6.0);
  const auto response = respond(system, fem::Undamped{}, loading, {0.01, 5000});
  EXPECT_NEAR(response.displacement(0, 4999), 6.0 / 300.0 + 6.0 / 200.0, 1e-14);
}

TEST(ModalResponse, DashpotsOfAModelAndTheSameModalRatiosGiveTheSameMotion) {
  // Two ways through the method: one mode by itself, and the coupled form, with a force on.
  fem::Loading loading{one(0.01), one(-0.1), MatrixXd::Zero(2, 777)};
  for (Index k = 0; k < 777; ++k) loading.inputs(0, k) = std::sin(0.01 * double(k * k));
  const auto by_law = respond(oscillator(2.0, 200.0), fem::ModalDamping{{0.1}}, loading, {0.03, 777});
  const auto by_dashpot = respond(oscillator(2.0, 200.0, 4.0), fem::Undamped{}, loading, {0.03, 777});
  EXPECT_LT(relative_error(by_dashpot.displacement, by_law.displacement), 1e-12);
  EXPECT_LT(relative_error(by_dashpot.acceleration, by_law.acceleration), 1e-12);
}

TEST(ModalResponse, DoesNotDependOnHowManySamplesAreAskedFor) {
  // Samples are worked off in blocks: every count must give the beginning of the longest.
  const auto system = chain({1.0, 2.0}, {300.0, 200.0}, {0.0, 0.0});
  fem::Loading loading{VectorXd{{0.01, 0.0}}, {}, MatrixXd::Zero(2, 4200)};
  for (Index k = 0; k < 4200; ++k) loading.inputs(0, k) = std::cos(0.37 * double(k));
  const auto whole = respond(system, fem::ModalDamping{{0.01}}, loading, {0.01, 4200});
  for (const Index samples : {1, 2, 31, 32, 33, 64, 65, 2047, 2048, 2049, 4100}) {
    fem::Loading part = loading;
    part.inputs = loading.inputs.leftCols(samples);
    const auto response = respond(system, fem::ModalDamping{{0.01}}, part, {0.01, samples, {samples - 1}});
    EXPECT_LT((response.displacement - whole.displacement.leftCols(samples)).cwiseAbs().maxCoeff(), 1e-15)
        << samples;
    EXPECT_LT((response.acceleration - whole.acceleration.leftCols(samples)).cwiseAbs().maxCoeff(), 1e-12)
        << samples;
    EXPECT_NEAR(response.field_displacement(1, 0), whole.displacement(0, samples - 1), 1e-15) << samples;
    EXPECT_NEAR(response.field_velocity(1, 0), whole.velocity(0, samples - 1), 1e-13) << samples;
    EXPECT_NEAR(response.field_acceleration(1, 0), whole.acceleration(0, samples - 1), 1e-11) << samples;
  }
}

TEST(ModalResponse, ReleaseOfACantileverIsTheSumOfItsFreeDecays) {
  // Oracle: free_decay, which evaluates e^(lambda t) anew. 25 s at 1000 samples/s.
  const auto system = assemble(test::steel_beam(0.36049), 60);
  const VectorXd released = 0.012 * static_shape(system);
  const auto modes = fem::modes(system, 12);
  const VectorXd time = VectorXd::LinSpaced(25000, 0.0, 24.999);
  const auto expected = fem::free_decay(modal_amplitudes(system, modes, released), modes.angular_frequency,
                                        VectorXd::Constant(12, 0.002), time);
  const auto response = respond(system, fem::ModalDamping{{0.002}}, {released, {}, {}}, {1e-3, 25000},
                                {"modal", {{"modes", 12}}});
  EXPECT_LT(relative_error(response.displacement.row(0).transpose(), expected.displacement), 1e-12);
  EXPECT_LT(relative_error(response.velocity.row(0).transpose(), expected.velocity), 1e-11);
  EXPECT_LT(relative_error(response.acceleration.row(0).transpose(), expected.acceleration), 2e-10);
  ASSERT_EQ(response.remarks.size(), 1u);
  EXPECT_EQ(response.remarks[0].rfind("modal: 12 of 120 modes", 0), 0u) << response.remarks[0];
}

TEST(ModalResponse, TipDashpotDecaysAsTheComplexModesSay) {
  // Oracle: the motion of one complex mode, Re(phi e^(lambda t)).
  fem::Beam beam = test::steel_beam(0.36049);
  beam.dashpots = {{beam.length(), 5.0, 0.0, 0.0}};
  const auto system = assemble(beam, 20);
  const auto modes = complex_modes(system, 2);
  const Complex lambda = modes.eigenvalue[1];
  const Eigen::VectorXcd phi = 0.01 * modes.shape.col(1);
  const auto response =
      respond(system, fem::Undamped{}, {phi.real(), (lambda * phi).real(), {}}, {1e-3, 2000});
  const Complex tip = (system.outputs.cast<Complex>() * phi)[0];
  for (Index k = 0; k < 2000; ++k)
    ASSERT_NEAR(response.displacement(0, k), (tip * std::exp(lambda * (1e-3 * double(k)))).real(),
                1e-11 * std::abs(tip));
}

TEST(ModalResponse, FreeBodyMovesByNewtonsLaw) {
  // Oracle: the centre of mass of a free beam under a constant tip force, 1/2 f t^2 / m; the beam at rest
  // relative to it at first moves with rotation as well: the mean of the momentum is what is compared.
  fem::Beam beam = test::steel_beam(0.0);
  beam.supports.clear();
  const auto system = assemble(beam, 10);
  fem::Loading loading{{}, {}, MatrixXd::Zero(2, 101)};
  loading.inputs.row(0).setConstant(2.0);
  const auto response = respond(system, fem::Undamped{}, loading, {0.01, 101, {100}});
  const VectorXd momentum = system.mass * response.field_velocity.col(0);
  double sum = 0.0;
  for (Index i = 0; i < system.size(); ++i)
    if (system.coordinates[i].kind == fem::Coordinate::Kind::deflection) sum += momentum[i];
  EXPECT_NEAR(sum, 2.0 * 1.0, 1e-10);
}

}  // namespace
}  // namespace beamid::modal_test
