// Oracles: the matrix exponential, differences, the modal sum of fem::free_decay, and consistency of a filter
// that knows every mode.
#include "experiments/studies/noise/noise_study.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <unsupported/Eigen/MatrixFunctions>

#include "experiments/studies/paper/monte_carlo.hpp"

namespace beamid::experiments::higher_mode_noise_test {
namespace {

NoiseSettings small_study() {
  NoiseSettings settings;
  settings.beams = {{"S(0.65)", paper::steel_beam(paper::test_beams[0]), 0.65,
                     Eigen::Vector2d(paper::test_beams[0].first_damping_ratio, 0.005)}};
  settings.elements = 10;
  settings.modes = 2;
  settings.trials = 6;
  settings.duration = 5.0;
  settings.factors = {1e2};
  return settings;
}

TEST(OscillatorBank, MovesAsTheMatrixExponentialWithItsJacobian) {
  const auto bank = oscillator_bank({{700.0, 0.4, true, 0.0}, {26000.0, 2.0, false, 1e-3}},
                                    Quantity::acceleration, 0.002, 1e-4);
  Eigen::VectorXd state(6), next, up, down;
  state << 0.012, 0.1, -0.001, 0.2, 690.0, 0.5;
  Eigen::MatrixXd jacobian;
  bank->linearised_transition(state, {}, next, jacobian);
  Eigen::Matrix2d first, second;
  first << 0.0, 1.0, -690.0, -0.5;
  second << 0.0, 1.0, -26000.0, -2.0;
  EXPECT_LT((next.head<2>() - (first * 0.002).exp() * state.head<2>()).norm(), 1e-14);
  EXPECT_LT((next.segment<2>(2) - (second * 0.002).exp() * state.segment<2>(2)).norm(), 1e-14);
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double step = 1e-4 * std::abs(state[j]);
    Eigen::VectorXd moved = state;
    moved[j] += step;
    bank->transition(moved, {}, up);
    moved[j] -= 2.0 * step;
    bank->transition(moved, {}, down);
    EXPECT_LT((jacobian.col(j) - (up - down) / (2.0 * step)).norm(), 1e-7 * (1.0 + jacobian.col(j).norm()))
        << j;
  }
}

// A shaping filter driven by its own process noise keeps the variance that it was made for.
TEST(OscillatorBank, ShapesNoiseOfTheVarianceAskedFor) {
  const auto bank = oscillator_bank({{900.0, 2.0, false, 0.5}}, Quantity::displacement, 0.01, 1.0);
  Eigen::VectorXd next;
  Eigen::MatrixXd jacobian, covariance = Eigen::Matrix2d::Zero();
  for (int k = 0; k < 3000; ++k) {
    bank->linearised_transition(Eigen::Vector2d::Zero(), {}, next, jacobian);
    covariance = jacobian * covariance * jacobian.transpose() + bank->process_noise();
  }
  EXPECT_NEAR(covariance(0, 0), 0.25, 1e-9);
  EXPECT_NEAR(covariance(1, 1), 0.25 * 900.0, 1e-6);
}

TEST(OscillatorBank, RefusesWhatDoesNotOscillate) {
  EXPECT_THROW(oscillator_bank({{1.0, 3.0, true, 0.0}}, Quantity::displacement, 0.01, 1.0),
               std::invalid_argument);
}

TEST(ModalRecord, OfAReleaseIsThatOfTheVirtualRig) {
  const Release rig = paper::release_of(paper::test_beams[1]);
  const ReleasedBeam released = release(rig);
  Eigen::VectorXd ratios = Eigen::VectorXd::Constant(rig.modes, rig.higher_damping_ratio);
  ratios[0] = rig.first_damping_ratio;
  const ModalMotion motion =
      modal_motion(rig.beam, rig.elements, ratios, Blow::release, released.modal_amplitudes[0], 0.0);
  for (const Eigen::Index k : {0, 7, 1234}) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < rig.modes; ++i)
      sum += (motion.amplitude[i] * motion.rate[i] * motion.rate[i] *
              std::exp(motion.rate[i] * released.time[k]))
                 .real();
    EXPECT_NEAR(sum, released.tip.acceleration[k], 1e-6 * released.tip.acceleration.cwiseAbs().maxCoeff());
  }
}

// One mode in the record: nothing to treat, and the filter is honest. Band: chi-square of 6 at 99.9 %.
TEST(HigherModes, AbsentLeaveAnHonestFilter) {
  const NoiseSettings settings = small_study();
  const NoiseCase alone = examine(settings, 0, Blow::release, Quantity::acceleration, 1);
  const NoiseStatistics& s = alone.by(Treatment::sensor);
  EXPECT_EQ(s.failed, 0);
  EXPECT_NEAR(s.normalised_square, 1.0, 0.05);
  EXPECT_GT(s.damping_ratio, 0.25);
  EXPECT_LT(s.damping_ratio, 1.95);
  EXPECT_EQ(alone.share, 0.0);
}

TEST(HigherModes, ModelledLeaveAnHonestFilterAndIgnoredDoNot) {
  const NoiseSettings settings = small_study();
  const NoiseCase both = examine(settings, 0, Blow::release, Quantity::acceleration, 2);
  const NoiseStatistics &modelled = both.by(Treatment::modelled), &ignored = both.by(Treatment::sensor);
  EXPECT_TRUE(harmless(modelled));
  EXPECT_NEAR(modelled.normalised_square, 1.0, 0.05);
  EXPECT_GT(ignored.normalised_square, 10.0);
  EXPECT_FALSE(harmless(ignored));
  EXPECT_TRUE(harmless(both.by(Treatment::filtered)));
}

// The numbers of docs/theory/higher_modes.md, of S(0.65) as `beamid noise` sets it up.
TEST(HigherModes, OfTheDocumentedBeamCostAsDocumented) {
  NoiseSettings settings;
  settings.beams = {{"S(0.65)", paper::steel_beam(paper::test_beams[0]), 0.65,
                     Eigen::Vector3d(paper::test_beams[0].first_damping_ratio, 0.005, 0.005)}};
  settings.factors = {};
  const auto error = [](const NoiseCase& c, Treatment treatment) {
    return c.by(treatment).damping_rms_percent;
  };
  const NoiseCase seen = examine(settings, 0, Blow::release, Quantity::displacement, 3);
  EXPECT_NEAR(seen.share, 0.0245, 5e-5);
  EXPECT_NEAR(error(seen, Treatment::sensor), 0.0455, 5e-4);
  EXPECT_NEAR(error(seen, Treatment::white), 0.0482, 5e-4);
  EXPECT_TRUE(harmless(seen.by(Treatment::sensor)));
  const NoiseCase felt = examine(settings, 0, Blow::release, Quantity::acceleration, 3);
  EXPECT_NEAR(felt.share, 1.33, 0.005);
  EXPECT_NEAR(error(felt, Treatment::white), 2.36, 0.02);
  EXPECT_NEAR(error(felt, Treatment::filtered), 0.0282, 5e-4);
  EXPECT_NEAR(error(felt, Treatment::modelled), 0.0298, 5e-4);
  EXPECT_FALSE(harmless(felt.by(Treatment::white)));
}

/// The cells of the row of docs/theory/higher_modes.md that begins so.
std::vector<std::string> documented_row(const std::string& begin) {
  std::ifstream document(BEAMID_SOURCE_DIR "/docs/theory/higher_modes.md");
  std::vector<std::string> cells;
  for (std::string line; std::getline(document, line);) {
    if (!line.starts_with(begin)) continue;
    std::istringstream rest(line.substr(begin.size()));
    for (std::string cell; std::getline(rest, cell, '|');)
      if (cell.size() > 2) cells.push_back(cell.substr(1, cell.size() - 2));
    break;
  }
  return cells;
}

std::string three_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

class DocumentedRow : public testing::TestWithParam<std::pair<Blow, Quantity>> {};

// Oracle: the study itself, digit by digit. "lost" stands for trials that were.
TEST_P(DocumentedRow, IsWhatTheStudyFinds) {
  const auto [blow, observed] = GetParam();
  NoiseSettings settings;
  settings.beams = {{"S(0.65)", paper::steel_beam(paper::test_beams[0]), 0.65,
                     Eigen::Vector3d(paper::test_beams[0].first_damping_ratio, 0.005, 0.005)}};
  settings.factors = {};
  const NoiseCase found = examine(settings, 0, blow, observed, 3);
  const auto cells = documented_row(std::string(blow == Blow::release ? "| release | " : "| hammer | ") +
                                    to_string(observed) + " |");
  ASSERT_EQ(cells.size(), 6u);
  EXPECT_EQ(three_digits(found.share), cells[0]);
  constexpr std::array order{Treatment::sensor, Treatment::white, Treatment::coloured, Treatment::filtered,
                             Treatment::modelled};
  for (std::size_t i = 0; i < order.size(); ++i) {
    const NoiseStatistics& s = found.by(order[i]);
    const bool lost = s.failed > 0;
    EXPECT_EQ(lost ? "lost" : three_digits(s.damping_rms_percent), cells[i + 1]) << "treatment " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(HigherModes, DocumentedRow,
                         testing::Values(std::pair{Blow::release, Quantity::velocity},
                                         std::pair{Blow::hammer, Quantity::displacement},
                                         std::pair{Blow::hammer, Quantity::velocity},
                                         std::pair{Blow::hammer, Quantity::acceleration}));

TEST(HigherModes, RefuseMoreModesThanTheBeamHasRatios) {
  NoiseSettings settings = small_study();
  settings.modes = 3;
  EXPECT_THROW(study_higher_modes(settings, [](const std::string&) {}), std::invalid_argument);
}

}  // namespace
}  // namespace beamid::experiments::higher_mode_noise_test
