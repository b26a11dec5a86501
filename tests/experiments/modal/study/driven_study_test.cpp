// Modes of driven records. Oracles: an exact building (shaken_building.hpp); a force on an oscillator, in
// closed form; a laboratory frame, as an independent fit and its transfer functions have it
// (../shared/data/README.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "experiments/modal/study/driven_study.hpp"
#include "experiments/modal/study/record_kind.hpp"
#include "experiments/signal/toolbox.hpp"
#include "tests/experiments/shaken_building.hpp"

namespace beamid::experiments::driven_study_test {
namespace {

using Eigen::Index, Eigen::VectorXd;

DrivenStudy studied(const Record& record) {
  ModalStudySettings settings;
  settings.method = {"output_error", {}};
  return study_driven("record", record, settings);
}

TEST(DrivenStudy, FindsTheModesOfAnExactBuilding) {
  const DrivenStudy found = studied(test::ShakenBuilding{0.0, 0.0}.record(6000));
  ASSERT_EQ(found.modes.size(), 3U);
  for (Index m = 0; m < 3; ++m) {
    const DrivenMode& mode = found.modes[static_cast<std::size_t>(m)];
    EXPECT_NEAR(mode.pole.frequency_hz() / test::ShakenBuilding::frequency_hz()[m], 1.0, 2e-4);
    EXPECT_NEAR(mode.pole.damping_ratio() / test::ShakenBuilding::ratio()[m], 1.0, 0.02);
    EXPECT_GT(phase_collinearity(mode.pole.shape), 0.999);
  }
  // Gamma phi of all modes sums to 1 at every floor.
  for (Index floor = 0; floor < 3; ++floor) {
    std::complex<double> sum = 0.0;
    for (const DrivenMode& mode : found.modes) sum += mode.participation[floor];
    EXPECT_NEAR(sum.real(), 1.0, 0.01);
    EXPECT_NEAR(sum.imag(), 0.0, 0.02);
  }
  EXPECT_GT(found.explained(), 0.98);
}

TEST(DrivenStudy, DeviationsHoldTheTruth) {
  int inside = 0, asked = 0;
  double squares = 0.0;
  for (std::uint64_t seed = 10; seed < 30; ++seed) {
    const DrivenStudy found = studied(test::ShakenBuilding{1.0, 0.0, seed}.record(4000));
    ASSERT_EQ(found.modes.size(), 3U) << "seed " << seed;
    for (Index m = 0; m < 3; ++m) {
      const Pole& pole = found.modes[static_cast<std::size_t>(m)].pole;
      for (const double z :
           {(pole.frequency_hz() - test::ShakenBuilding::frequency_hz()[m]) / pole.frequency_deviation_hz,
            (pole.damping_ratio() - test::ShakenBuilding::ratio()[m]) / pole.damping_ratio_deviation}) {
        inside += std::abs(z) < 1.96;
        squares += z * z;
        ++asked;
        EXPECT_LT(std::abs(z), 4.5) << "seed " << seed << ", mode " << m + 1;
      }
    }
  }
  EXPECT_GT(inside, 0.89 * asked);  // 120 of them: 95 % less three of its deviations
  EXPECT_LT(std::sqrt(squares / asked), 1.25);
}

// Two storeys of 1 kg, the lower one 3 % stiffer at 0.03 m of drift (Duffing), under a base of 600 sines
// with a strong one; Runge-Kutta at 2 kHz. Its harmonics are no modes.
Record stiffening() {
  constexpr Index samples = 12000;
  constexpr int finer = 20;
  constexpr double interval = 0.01, k1 = 900.0, k2 = 1300.0, c = 0.25, cubic = 0.03 * k1 / (0.03 * 0.03);
  const auto base = [](double t) {
    double sum = 4.0 * std::sin(2.0 * std::numbers::pi * 2.2 * t);
    for (int i = 1; i <= 600; ++i)
      sum += 0.08 * std::sin(2.0 * std::numbers::pi * 0.0203 * i * t + 1.7 * i * i);
    return sum;
  };
  using State = Eigen::Vector4d;  // drifts and their rates relative to the base
  const auto rate = [&](double t, const State& x) {
    const double drift = x[1] - x[0], lower = k1 * x[0] + cubic * x[0] * x[0] * x[0] + c * x[2],
                 upper = k2 * drift + c * (x[3] - x[2]), ground = base(t);
    return State(x[2], x[3], upper - lower - ground, -upper - ground);
  };
  Record record;
  record.time = VectorXd::LinSpaced(samples, 0.0, interval * (samples - 1));
  record.samples.resize(3, samples);
  record.channels = {{Quantity::base_acceleration, "base"},
                     {Quantity::acceleration, "lower"},
                     {Quantity::acceleration, "upper"}};
  State x = State::Zero();
  for (Index k = 0; k < samples; ++k) {
    const double t = record.time[k], h = interval / finer;
    const State now = rate(t, x);
    record.samples.col(k) << base(t), now[2] + base(t), now[3] + base(t);
    for (int i = 0; i < finer; ++i) {
      const double from = t + h * i;
      const State a = rate(from, x), b = rate(from + 0.5 * h, x + 0.5 * h * a),
                  d = rate(from + 0.5 * h, x + 0.5 * h * b), e = rate(from + h, x + h * d);
      x += h / 6.0 * (a + 2.0 * b + 2.0 * d + e);
    }
  }
  return record;
}

TEST(DrivenStudy, HarmonicsOfAStiffeningStoreyAreNoModes) {
  const DrivenStudy found = studied(stiffening());
  std::string rejected;
  for (const PoleCluster& one : found.stabilisation.rejected)
    rejected += std::to_string(one.pole.frequency_hz()) + " Hz: " + one.objection + "\n";
  ASSERT_EQ(found.modes.size(), 2U) << rejected;
  EXPECT_NEAR(found.modes[0].pole.frequency_hz(), 3.15, 0.15);
  EXPECT_NEAR(found.modes[1].pole.frequency_hz(), 8.95, 0.15);
}

TEST(DrivenStudy, AStiffnessThatChangesIsNoSecondMode) {
  const DrivenStudy found = studied(test::ShakenBuilding{0.05, 0.02}.record(8000));
  ASSERT_EQ(found.modes.size(), 3U);
  for (Index m = 0; m < 3; ++m)
    EXPECT_NEAR(found.modes[static_cast<std::size_t>(m)].pole.frequency_hz() /
                    test::ShakenBuilding::frequency_hz()[m],
                0.995, 0.01);
}

TEST(DrivenStudy, NoiseHasNoMode) {
  Record record = test::ShakenBuilding{0.0, 0.0}.record(4000);
  for (Index row = 1; row < 4; ++row)
    record.samples.row(row) = standard_normal(4000, 77, static_cast<std::uint64_t>(row)).transpose();
  EXPECT_TRUE(studied(record).modes.empty());
}

// x'' + 2 zeta w x' + w^2 x = f / m under sines that have gone on for ever: participation 1 / m.
TEST(DrivenStudy, AForceGivesTheModalMass) {
  constexpr double w = 2.0 * std::numbers::pi * 4.0, ratio = 0.01, mass = 2.5, rate = 100.0;
  constexpr Index samples = 6000;
  Record record;
  record.time = VectorXd::LinSpaced(samples, 0.0, (samples - 1) / rate);
  record.samples.setZero(2, samples);
  record.channels = {{Quantity::displacement, "x"}, {Quantity::force, "shaker"}};
  const VectorXd amplitude = standard_normal(200, 3, 1), phase = 7.0 * standard_normal(200, 3, 2);
  for (Index i = 0; i < 200; ++i) {
    const double omega = 2.0 * std::numbers::pi * (0.3 + 0.05 * static_cast<double>(i) + 0.013);
    const std::complex<double> h =
        1.0 / mass / std::complex<double>(w * w - omega * omega, 2.0 * ratio * w * omega);
    for (Index n = 0; n < samples; ++n) {
      const auto turn = std::polar(amplitude[i], omega * record.time[n] + phase[i]);
      record.samples(1, n) += turn.real();
      record.samples(0, n) += (h * turn).real();
    }
  }
  EXPECT_TRUE(is_driven(record));
  EXPECT_FALSE(is_struck(record));
  const DrivenStudy found = studied(record);
  ASSERT_EQ(found.modes.size(), 1U);
  EXPECT_NEAR(found.modes[0].pole.frequency_hz(), 4.0, 4e-4);
  EXPECT_NEAR(found.modes[0].pole.damping_ratio(), ratio, 1e-4);
  EXPECT_NEAR(std::abs(found.modes[0].participation[0]) * mass, 1.0, 0.01);
}

TEST(DrivenStudy, RefusesARecordWithoutInput) {
  Record record = test::ShakenBuilding{0.0, 0.0}.record(1000);
  record.channels[0].quantity = Quantity::acceleration;
  EXPECT_THROW(studied(record), std::invalid_argument);
}

TEST(RecordKind, HitsAreNotAShaker) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Record record;
    constexpr Index samples = 5000;
    record.time = VectorXd::LinSpaced(samples, 0.0, 4.999);
    record.channels = {{Quantity::acceleration, "a"}, {Quantity::force, "f"}};
    record.samples.resize(2, samples);
    record.samples.row(0) = standard_normal(samples, seed, 1).transpose();
    record.samples.row(1) = standard_normal(samples, seed, 2).transpose();
    EXPECT_TRUE(is_driven(record));
    EXPECT_FALSE(is_struck(record));
    record.samples.row(1) *= 0.2;
    const VectorXd draws = standard_normal(10, seed, 3);
    for (Index hit = 0; hit < 5; ++hit)
      for (Index n = 0; n < 8; ++n)
        record.samples(1, 500 + 900 * hit + n) +=
            (60.0 + 10.0 * std::abs(draws[hit])) *
            std::sin(std::numbers::pi * (static_cast<double>(n) + 0.5) / 8.0);
    EXPECT_TRUE(is_struck(record)) << seed;
    EXPECT_FALSE(is_driven(record)) << seed;
  }
}

// One file a floor: the table is floor 0, shaking along X, gravity left out by the transforms.
TEST(DrivenStudy, AgreesWithAnIndependentFitOfALaboratoryFrame) {
  const std::filesystem::path folder = BEAMID_SOURCE_DIR "/../shared/data/shake-table";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the measured records are not here";
  for (const std::string event : {"northridge", "sine_2_0"}) {
    std::vector<std::vector<double>> rows;
    for (int floor = 0; floor < 4; ++floor) {
      std::ifstream file(folder / (event + "_floor" + std::to_string(floor) + ".csv"));
      rows.emplace_back();
      bool numbers = false;
      for (std::string line; std::getline(file, line);) {
        if (numbers) {
          std::istringstream fields(line);
          std::string field;
          for (int i = 0; i <= 5; ++i) std::getline(fields, field, ',');
          if (!field.empty()) rows.back().push_back(std::stod(field));
        }
        numbers = numbers || line.starts_with("PacketCounter");
      }
      rows.back().erase(rows.back().begin());  // zeros
    }
    std::size_t count = rows[0].size();
    for (const auto& row : rows) count = std::min(count, row.size());
    const auto samples = static_cast<Index>(count);
    Record record = test::ShakenBuilding{}.record(16);
    record.time = VectorXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1) / 120.005);
    record.samples.resize(4, samples);
    for (Index i = 0; i < 4; ++i)
      record.samples.row(i) =
          Eigen::Map<const Eigen::RowVectorXd>(rows[static_cast<std::size_t>(i)].data(), samples);
    const DrivenStudy found = studied(record);
    ASSERT_EQ(found.modes.size(), 3U) << event;
    const std::array<double, 3> peaks{event == "northridge" ? 3.679 : 3.740,
                                      event == "northridge" ? 11.12 : 11.21, 16.63};
    for (std::size_t m = 0; m < 3; ++m)
      EXPECT_NEAR(found.modes[m].pole.frequency_hz() / peaks[m], 1.0, 0.005) << event;
  }
}

}  // namespace
}  // namespace beamid::experiments::driven_study_test
