#include "fem/response/frequency_response.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "fem/assembly.hpp"
#include "fem/exact/exact_cantilever.hpp"
#include "tests/fem/five_beams.hpp"
#include "tests/fem/response/oscillator_system.hpp"

namespace beamid::frequency_response_test {
namespace {

using Eigen::Index, Eigen::VectorXcd, Eigen::VectorXd;
using test::chain, test::oscillator;
using Complex = std::complex<double>;
constexpr double turn = 2.0 * std::numbers::pi;

// Deflection at x per unit of a harmonic force on the tip of a bare cantilever: W = A (cosh y - cos y - s
// (sinh y - sin y)), y = b x / L, b^4 = m w^2 L^4 / EI*, EI* = EI (1 + i eta). No moment at the tip: s =
// (cosh b + cos b) / (sinh b + sin b). Shear force: EI* (b/L)^3 A (sinh b - sin b - s (cosh b + cos b)) = -1.
Complex exact_receptance(const fem::Cantilever& beam, double eta, double frequency_hz, double x) {
  const Complex stiffness = beam.bending_stiffness * Complex(1.0, eta);
  const double w = turn * frequency_hz, l = beam.length;
  const Complex b = std::pow(beam.mass_per_length * w * w / stiffness, 0.25) * l, y = b * x / l;
  const Complex s = (std::cosh(b) + std::cos(b)) / (std::sinh(b) + std::sin(b));
  const Complex a = -1.0 / (stiffness * std::pow(b / l, 3) *
                            (std::sinh(b) - std::sin(b) - s * (std::cosh(b) + std::cos(b))));
  return a * (std::cosh(y) - std::cos(y) - s * (std::sinh(y) - std::sin(y)));
}

struct CantileverWithTwoPoints {
  fem::Cantilever beam = test::steel_beam(0.0);
  fem::StructuralSystem system;
  explicit CantileverWithTwoPoints(int elements)
      : system(fem::assemble(beam, elements, {{"tip", beam.length}, {"middle", 0.4 * beam.length}})) {}
};

TEST(FrequencyResponse, DirectReceptanceIsThatOfTheContinuum) {
  // Oracle: the closed form above with complex EI, from far below mode 1 to beyond mode 5, resonances
  // included. The mesh errs by (b h / L)^4 / 1440 in frequency, which a resonance of loss factor 0.02
  // magnifies by 1 / eta.
  const CantileverWithTwoPoints cantilever(250);
  VectorXd frequency(41);
  for (Index k = 0; k < 40; ++k) frequency[k] = 0.1 * std::pow(4000.0, double(k) / 39.0);
  frequency[40] = fem::ExactMode(cantilever.beam, 2).frequency_hz();
  const double eta = 0.02;
  const fem::ExactMode first(cantilever.beam, 1);
  const VectorXcd tip = receptance(cantilever.system, fem::StructuralDamping{eta}, frequency, 0, 0);
  const VectorXcd middle = receptance(cantilever.system, fem::StructuralDamping{eta}, frequency, 0, 1);
  for (Index k = 0; k < frequency.size(); ++k) {
    const Complex at_tip = exact_receptance(cantilever.beam, eta, frequency[k], cantilever.beam.length);
    const Complex at_middle =
        exact_receptance(cantilever.beam, eta, frequency[k], 0.4 * cantilever.beam.length);
    const double b = std::sqrt(frequency[k] / first.frequency_hz()) * first.root();
    const double tolerance = 1e-10 + 3.0 * std::pow(b / 250, 4) / 1440 / eta;
    EXPECT_LT(std::abs(tip[k] - at_tip) / std::abs(at_tip), tolerance) << frequency[k];
    EXPECT_LT(std::abs(middle[k] - at_middle) / std::abs(at_middle), tolerance) << frequency[k];
  }
}

// Where a real function changes sign between two frequencies, by bisection.
template <class Function>
double sign_change(const Function& f, double low, double high) {
  const bool rises = f(low) < 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) < 0.0) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

TEST(FrequencyResponse, AntiResonancesOfTheTipAreThoseOfAProppedBeam) {
  // Oracle: the tip rests where a support there would let the beam vibrate: roots of tan b = tanh
  // b, 3.9266023120479190 and 7.0685827456287320. 200 elements err by (b/200)^4 / 1440.
  const CantileverWithTwoPoints cantilever(200);
  const double first = fem::ExactMode(cantilever.beam, 1).frequency_hz(),
               b1 = fem::ExactMode(cantilever.beam, 1).root();
  for (const double b : {3.9266023120479190, 7.0685827456287320}) {
    const double expected = first * (b / b1) * (b / b1);
    const auto tip = [&](double frequency) {
      return receptance(cantilever.system, fem::Undamped{}, VectorXd::Constant(1, frequency), 0, 0)[0].real();
    };
    EXPECT_NEAR(sign_change(tip, 0.97 * expected, 1.03 * expected) / expected, 1.0,
                std::pow(b / 200, 4) / 1000 + 1e-10);
  }
}

TEST(FrequencyResponse, IsReciprocal) {
  // Oracle: Maxwell and Betti. A dashpot, a tip body and Rayleigh damping do not change it.
  fem::Beam beam = test::steel_beam(0.36049);
  beam.dashpots = {{0.7, 2.0, 0.01, 0.0}};
  const auto system = fem::assemble(beam, 50, {{"tip", 1.10}, {"middle", 0.5}});
  const VectorXd frequency = VectorXd::LinSpaced(50, 0.5, 200.0);
  const auto both =
      receptances(system, fem::RayleighDamping{{3.0, 0.01}, {50.0, 0.02}}, frequency, {{0, 1}, {1, 0}});
  EXPECT_LT(test::relative_error((both.col(0) - both.col(1)).cwiseAbs(), both.col(0).cwiseAbs()), 2.0);
  EXPECT_LT((both.col(0) - both.col(1)).cwiseAbs().cwiseQuotient(both.col(0).cwiseAbs()).maxCoeff(), 1e-11);
}

TEST(FrequencyResponse, OscillatorHasItsClosedForm) {
  // Oracle: 1 / (k - m w^2 + i w c) per force, -m times that per acceleration of the base.
  const double m = 2.0, k = 800.0, c = 5.0;
  const VectorXd frequency = VectorXd::LinSpaced(30, 0.0, 9.0);
  for (const char* method : {"direct", "modal"}) {
    const auto both =
        receptances(oscillator(m, k, c), fem::Undamped{}, frequency, {{0, 0}, {1, 0}}, {method});
    for (Index i = 0; i < 30; ++i) {
      const double w = turn * frequency[i];
      const Complex exact = 1.0 / Complex(k - m * w * w, w * c);
      EXPECT_LT(std::abs(both(i, 0) - exact) / std::abs(exact), 1e-13) << method;
      EXPECT_LT(std::abs(both(i, 1) + m * exact) / std::abs(m * exact), 1e-13) << method;
    }
  }
}

TEST(FrequencyResponse, ModalSumOfAllModesIsTheDirectOne) {
  // Two methods, with a dashpot that couples the modes and Rayleigh damping beside it.
  fem::Beam beam = test::steel_beam(0.36049);
  beam.dashpots = {{0.7, 2.0, 0.01, 0.0}};
  const auto system = assemble(beam, 20);
  const fem::RayleighDamping law{{3.0, 0.01}, {50.0, 0.02}};
  const VectorXd frequency = VectorXd::LinSpaced(60, 0.0, 120.0);
  const VectorXcd direct = receptance(system, law, frequency, 0, 0),
                  modal = receptance(system, law, frequency, 0, 0, {"modal"});
  EXPECT_LT((direct - modal).cwiseAbs().cwiseQuotient(direct.cwiseAbs()).maxCoeff(), 1e-9);
}

TEST(FrequencyResponse, StaticDeflectionOfTheModesLeftOutBringsTheSumClose) {
  // Oracle: the direct form. What remains of a mode left out falls by (f / f_i)^2 with the correction.
  const auto system = assemble(test::steel_beam(0.36049), 60);
  const fem::StructuralDamping law{0.01};
  const VectorXd frequency = VectorXd::LinSpaced(80, 0.0, 60.0);  // three resonances and two anti-resonances
  const VectorXcd direct = receptance(system, law, frequency, 0, 0);
  const auto error = [&](Index modes, bool residual) {
    const VectorXcd sum = receptance(system, law, frequency, 0, 0, {"modal", modes, residual});
    return (sum - direct).cwiseAbs().cwiseQuotient(direct.cwiseAbs()).maxCoeff();
  };
  EXPECT_LT(error(10, true), 1e-4);
  EXPECT_LT(error(40, true), 1e-6);
  EXPECT_GT(error(10, false), 100 * error(10, true));
}

TEST(FrequencyResponse, FreeBeamIsFiniteButAtRest) {
  // Two methods; at 0 Hz a force moves a free beam without end.
  fem::Beam beam = test::steel_beam(0.36049);
  beam.supports.clear();
  const auto system = assemble(beam, 20);
  const VectorXd frequency = VectorXd::LinSpaced(30, 1.0, 200.0), rest = VectorXd::Zero(1);
  const fem::StructuralDamping law{0.01};
  const VectorXcd direct = receptance(system, law, frequency, 0, 0),
                  modal = receptance(system, law, frequency, 0, 0, {"modal", 12});
  EXPECT_LT((direct - modal).cwiseAbs().cwiseQuotient(direct.cwiseAbs()).maxCoeff(), 1e-3);
  EXPECT_THROW(receptance(system, law, rest, 0, 0, {"modal"}), std::runtime_error);
}

TEST(FrequencyResponse, MobilityAndAcceleranceAreItsDerivatives) {
  const VectorXd frequency{{0.0, 2.0}};
  const VectorXcd h{{Complex(1.0, 2.0), Complex(3.0, -1.0)}};
  const double w = turn * 2.0;
  EXPECT_EQ(fem::mobility(frequency, h)[0], Complex(0.0));
  EXPECT_LT(std::abs(fem::mobility(frequency, h)[1] - Complex(0.0, w) * h[1]), 1e-13);
  EXPECT_LT(std::abs(fem::accelerance(frequency, h)[1] + w * w * h[1]), 1e-11);
}

TEST(FrequencyResponse, SaysWhatItCannotDo) {
  const auto system = oscillator(1.0, 1.0);
  const VectorXd one = VectorXd::Ones(1);
  const auto message = [&](const fem::DampingLaw& law, const VectorXd& frequency, Index input,
                           const char* method) -> std::string {
    try {
      receptance(system, law, frequency, input, 0, {method});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message(fem::ModalDamping{{0.01}}, one, 0, "direct"),
              testing::HasSubstr("modal damping has a full damping matrix"));
  EXPECT_EQ(message(fem::ModalDamping{{0.01}}, one, 0, "modal"), "");
  EXPECT_EQ(message(fem::Undamped{}, one, 2, "direct"), "frequency response: input 2; expected 0 to 1");
  EXPECT_EQ(message(fem::Undamped{}, -one, 0, "direct"),
            "frequency response: -1 Hz; expected a finite frequency of at least 0");
  EXPECT_EQ(message(fem::Undamped{}, one, 0, "modl"),
            "unknown frequency response method 'modl'; known: direct, modal");
}

}  // namespace
}  // namespace beamid::frequency_response_test
