// Hammer tests of a structure whose modes and modal masses are known.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/modal/hammer_response.hpp"
#include "experiments/modal/study/hammer_study.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments::hammer_test {
namespace {

constexpr double pi = std::numbers::pi, interval = 5e-4;

struct TrueMode {
  double frequency_hz, ratio, mass;
};
const std::vector<TrueMode> truth{{12, 0.03, 1.6}, {75, 0.008, 0.5}, {390, 0.01, 0.3}};

/// Acceleration and force at the driving point after two half-sine hits of 6 ms, 3 s apart; each mode by the
/// classical Runge-Kutta method at a tenth of the interval.
Record struck(std::uint64_t seed, double noise) {
  constexpr int steps = 10;
  const Eigen::Index count = 12000;
  const auto force = [](double t) {
    double sum = 0;
    for (const double at : {0.02, 3.02})
      if (t > at && t < at + 0.006) sum += (at < 1 ? 100 : 80) * std::sin(pi * (t - at) / 0.006);
    return sum;
  };
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(count, 0, interval * static_cast<double>(count - 1));
  record.samples = Eigen::MatrixXd::Zero(2, count);
  record.channels = {{Quantity::acceleration, "tip"}, {Quantity::force, "hammer"}};
  for (const TrueMode& mode : truth) {
    const double w = 2 * pi * mode.frequency_hz, h = interval / steps;
    const auto acceleration = [&](double t, double x, double v) {
      return force(t) / mode.mass - 2 * mode.ratio * w * v - w * w * x;
    };
    double x = 0, v = 0;
    for (Eigen::Index k = 0; k < count; ++k) {
      record.samples(0, k) += acceleration(record.time[k], x, v);
      for (int i = 0; i < steps; ++i) {
        const double t = record.time[k] + h * i, a1 = acceleration(t, x, v), v2 = v + h / 2 * a1,
                     a2 = acceleration(t + h / 2, x + h / 2 * v, v2), v3 = v + h / 2 * a2,
                     a3 = acceleration(t + h / 2, x + h / 2 * v2, v3), v4 = v + h * a3,
                     a4 = acceleration(t + h, x + h * v3, v4);
        x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
        v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      }
    }
  }
  const Eigen::VectorXd random = standard_normal(2 * count, seed, 1);
  for (Eigen::Index k = 0; k < count; ++k) {
    record.samples(0, k) += noise * random[2 * k];
    record.samples(1, k) = force(record.time[k]) + 0.1 * noise * random[2 * k + 1];
  }
  return record;
}

// Oracle: the modes that were simulated. The third lies above the band and is left to the residual terms.
TEST(Hammer, FindsModesAndModalMasses) {
  ModalStudySettings settings;
  settings.method = {"frf_lscf", {}};
  settings.band_hz = {4, 150};
  settings.largest_order = 16;
  const HammerStudy study = study_hits({"one", "two"}, {struck(1, 0.05), struck(2, 0.05)}, settings);
  EXPECT_EQ(study.responses.averages, 4);
  ASSERT_EQ(study.modes.size(), 2u);
  for (std::size_t m = 0; m < 2; ++m) {
    const HammerMode& mode = study.modes[m];
    EXPECT_NEAR(mode.pole.frequency_hz(), truth[m].frequency_hz, 1e-3 * truth[m].frequency_hz);
    EXPECT_NEAR(mode.pole.damping_ratio(), truth[m].ratio, 0.02 * truth[m].ratio);
    EXPECT_NEAR(mode.mass[0], truth[m].mass, 0.01 * truth[m].mass);
    EXPECT_NEAR(mode.phase[0], 0, 0.03);
    EXPECT_LT(mode.deviation[0], 0.01 * mode.mass[0]);
  }
  EXPECT_TRUE(study.responses.objections.empty());  // both hits meet a structure at rest
  EXPECT_GT(study.responses.coherence(0, static_cast<Eigen::Index>(12 * study.responses.duration)), 0.99);
}

// Oracle: the mass that was simulated; the hit has one pulse and the impulse 2 / pi of 100 N times 6 ms.
TEST(Hammer, WeighsAModeByItsVelocityStep) {
  const double w = 2 * pi * truth[0].frequency_hz, other = 2 * pi * truth[1].frequency_hz;
  std::string reason;
  const auto found = hammer_mass(struck(3, 0.05), {{-truth[0].ratio * w, w}, {}},
                                 {{-truth[0].ratio * w, w}, {-1, other}}, reason);
  ASSERT_TRUE(found.has_value()) << reason;
  EXPECT_NEAR(found->mass, truth[0].mass, std::max(0.01 * truth[0].mass, 4 * found->deviation));
  EXPECT_LT(found->deviation, 0.05 * truth[0].mass);
  EXPECT_NEAR(found->impulse, 100 * 0.006 * 2 / pi, 0.005);
  EXPECT_EQ(found->pulses_s.size(), 1u);
}

// Oracle: a response that is late by t turns a residue by 360 f t degrees: at 2.5 ms 11 and 68 degrees.
TEST(Hammer, WarnsOfAMassWhoseResidueIsOutOfPhase) {
  ModalStudySettings settings;
  settings.method = {"frf_lscf", {}};
  settings.band_hz = {4, 150};
  settings.largest_order = 16;
  Record record = struck(1, 0.05);
  const Eigen::Index count = record.size() - 5;
  record.samples.row(0).tail(count) = record.samples.row(0).head(count).eval();
  const HammerStudy study = study_hits({"one"}, {record}, settings);
  ASSERT_EQ(study.modes.size(), 2u);
  EXPECT_NEAR(std::abs(study.modes[1].phase[0]), 2 * pi * truth[1].frequency_hz * 2.5e-3, 0.1);
  EXPECT_FALSE(study.modes[0].complex);
  EXPECT_TRUE(study.modes[1].complex);
  EXPECT_NE(study.objections.back().text.find("is not to be trusted"), std::string::npos);
}

TEST(Hammer, WarnsOfASecondPulseAndRefusesMissingReadings) {
  Record record = struck(1, 0.05);
  for (int k = 0; k < 12; ++k) record.samples(1, 80 + k) += 30 * std::sin(pi * k / 12);
  EXPECT_EQ(hammer_responses({record}, 0.01).objections.size(), 1u);
  record.samples(0, 100) = std::nan("");
  EXPECT_THROW(hammer_responses({record}, 0.01), std::invalid_argument);
}

// Oracle: the modes that were simulated, from the lines around their peaks alone.
TEST(Hammer, FindsModesPeakByPeakAsWell) {
  ModalStudySettings settings;
  settings.method = {"frf_half_power", {}};
  settings.band_hz = {4, 150};
  const HammerStudy study = study_hits({"one"}, {struck(1, 0.05)}, settings);
  ASSERT_EQ(study.modes.size(), 2u);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_NEAR(study.modes[m].pole.frequency_hz(), truth[m].frequency_hz, 2e-3 * truth[m].frequency_hz);
    EXPECT_NEAR(study.modes[m].pole.damping_ratio(), truth[m].ratio, 0.1 * truth[m].ratio);
    EXPECT_TRUE(std::isnan(study.modes[m].pole.frequency_deviation_hz));
  }
  EXPECT_LT(study.misfit, 0.1);
}

/// Receptances with these poles and residues at s = i 2 pi f + shift.
Eigen::MatrixXcd responses_of(const std::vector<std::complex<double>>& poles, const Eigen::MatrixXd& residues,
                              const Eigen::VectorXd& f, double shift) {
  Eigen::MatrixXcd h = Eigen::MatrixXcd::Zero(residues.rows(), f.size());
  for (Eigen::Index k = 0; k < f.size(); ++k)
    for (std::size_t m = 0; m < poles.size(); ++m) {
      const std::complex<double> s(shift, 2 * pi * f[k]), r(0, -1);
      h.col(k) += residues.col(static_cast<Eigen::Index>(m)) *
                  (r / (s - poles[m]) + std::conj(r) / (s - std::conj(poles[m])));
    }
  return h;
}

// Oracle: the poles put in. One mode alone is found but for the bend of its conjugate; two that overlap, half
// a width apart from their sum's peaks, within some per cent.
TEST(ResponsePeaks, FindsNearModesOfResponsesWithNoise) {
  const auto pole = [](double f, double ratio) {
    return 2 * pi * f * std::complex<double>(-ratio, std::sqrt(1 - ratio * ratio));
  };
  const Eigen::VectorXd f = Eigen::VectorXd::LinSpaced(125, 10, 60);
  const std::vector<std::complex<double>> poles{pole(22, 0.04), pole(26.5, 0.03)};
  const Eigen::MatrixXd residues = (Eigen::MatrixXd(2, 2) << 1, 0.8, 0.7, -0.9).finished();
  Eigen::MatrixXcd h = responses_of(poles, residues, f, 1.85);
  const Eigen::VectorXd random = standard_normal(2 * h.size(), 5, 1);
  for (Eigen::Index k = 0; k < h.size(); ++k)
    h.data()[k] += 1e-3 * std::complex<double>(random[2 * k], random[2 * k + 1]);
  const std::vector<Pole> found = poles_at_peaks(f, h, 1.85, 0, 0.3);
  ASSERT_EQ(found.size(), 2u);
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_NEAR(found[m].rate.imag() / poles[m].imag(), 1, 0.01);
    EXPECT_NEAR(found[m].rate.real() / poles[m].real(), 1, 0.15);
  }
  const auto alone =
      poles_at_peaks(f, responses_of({poles[0]}, Eigen::MatrixXd::Ones(1, 1), f, 1.85), 1.85, 0, 0.3);
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_NEAR(std::abs(alone[0].rate - poles[0]), 0, 1e-3 * std::abs(poles[0]));
  EXPECT_TRUE(poles_at_peaks(f, Eigen::MatrixXcd::Ones(1, 125), 1.85, 0, 0.3).empty());
}

}  // namespace
}  // namespace beamid::experiments::hammer_test
