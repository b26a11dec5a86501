// Filters that were run on exact records of structures of many degrees of freedom, against the law.
#include "experiments/studies/atlas/many_degrees.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "experiments/studies/paper/numerical_validation.hpp"
#include "tests/docs/compare_numbers.hpp"

namespace beamid::experiments::many_degrees_test {
namespace {

class ManyDegreesUnder : public testing::TestWithParam<std::string> {};

// Where the unknowns hold whatever the law gives: six digits of the bias, or 1e-9 of what the filter may
// move.
TEST_P(ManyDegreesUnder, BiasesAFilterOfAllEntriesAsTheLawSays) {
  for (const UnknownFamily& family : {chain_family(3, 0.002, "all entries"), chain_family(3, 0.005, "modes"),
                                      chain_family(6, 0.002, "modes")}) {
    const DegreesCase one = degrees_case(family, GetParam());
    for (std::size_t j = 0; j < one.points.size(); ++j) {
      const UnknownFamily::Part& part = family.parts[j];
      const double bias = one.points[j].law - part.value;
      EXPECT_NEAR(one.points[j].found, one.points[j].law, 1e-6 * std::abs(bias) + 1e-9 * part.scale)
          << family.structure << ", " << part.name;
    }
  }
}

// Springs and dashpots alone: the law to the first order, dt K to 2 %.
TEST_P(ManyDegreesUnder, BiasesAFilterOfStoreysNearlyAsTheLawSays) {
  const DegreesCase one = degrees_case(chain_family(3, 0.0005, "storeys"), GetParam());
  if (GetParam() == "exponential") return;
  EXPECT_LT(one.apart_of_dt_k(), 2e-3);
  EXPECT_LT(one.apart(false), 2e-3);
}

INSTANTIATE_TEST_SUITE_P(All, ManyDegreesUnder, testing::ValuesIn(paper::compared_schemes()),
                         [](const auto& tested) { return tested.param; });

TEST(ManyDegrees, DifferFromTheProjectionByTheOrderOfTheStep) {
  const auto apart = [](double dt) {
    const DegreesCase one = degrees_case(chain_family(3, dt, "storeys"), "forward_euler");
    return std::pair{one.apart(true), one.apart(false)};
  };
  const auto coarse = apart(0.002), fine = apart(0.0005);  // four times
  EXPECT_GT(coarse.first / fine.first, 3.0);
  EXPECT_GT(coarse.second / fine.second, 3.0);
}

TEST(ManyDegrees, AddDtKToEveryDashpotOfForwardEuler) {
  for (const int storeys : {3, 6, 12}) {
    const DegreesCase one = degrees_case(chain_family(storeys, 0.0005, "storeys"), "forward_euler");
    for (std::size_t j = 0; j < one.points.size(); ++j) {
      if (!one.family.parts[j].damping) continue;
      const double k = one.family.parts[j - static_cast<std::size_t>(storeys)].value;
      EXPECT_NEAR(one.points[j].by_dt_k, k * 0.0005, 1e-6 * k * 0.0005);
      EXPECT_NEAR((one.points[j].found - one.family.parts[j].value) / one.points[j].by_dt_k, 1.0,
                  storeys == 12 ? 0.12 : 0.05)
          << storeys << ", " << one.family.parts[j].name;
    }
  }
}

TEST(ManyDegrees, AddHalfTheStepToRatiosOfModes) {
  for (const UnknownFamily& family : {frame_family(), beam_family()}) {
    const DegreesCase one = degrees_case(family, "forward_euler");
    for (std::size_t j = 0; j < one.points.size(); ++j) {
      if (!family.parts[j].damping) continue;
      const double half_step = 0.25 * family.parts[j].matrix.sum() * family.interval;  // w dt / 2
      EXPECT_NEAR(one.points[j].by_dt_k, half_step, 1e-6 * half_step);
      EXPECT_NEAR(one.points[j].found - family.parts[j].value, half_step, 0.01 * half_step)
          << family.structure;
    }
  }
}

// Of forward Euler, (found - truth) / (w^2 dt) of the modes' 2 xi w, and w_f^2 / w^2 - 1.
struct ModesFound {
  Eigen::VectorXd damping, stiffness;
};
ModesFound modes_found(const UnknownFamily& family, const std::string& scheme = "forward_euler") {
  const auto found = measured_unknowns(family, scheme);
  EXPECT_TRUE(found);
  const Eigen::Index n = family.truth.size();
  const Eigen::VectorXd truth = family.values(), change = found.value_or(truth) - truth;
  return {change.tail(n).cwiseQuotient(truth.head(n)) / family.interval,
          change.head(n).cwiseQuotient(truth.head(n))};
}

TEST(ManyDegrees, TwoChannelsWithProcessNoiseKeepHalfOfTheBias) {
  // Oracle: regression of the next velocities on displacements and velocities, C_f = M (I - Phi_22) / dt,
  // K_f = -M Phi_21 / dt of Phi = e^(A dt) = [.., ..; Phi_21, Phi_22].
  UnknownFamily family = chain_family(3, 0.002, "modes");
  family.samples = 2000;
  family.velocities = true;
  EXPECT_LT((modes_found(family).damping.array() - 1.0).abs().maxCoeff(), 0.02);
  family.motion_noise = 1e-5;
  const ModesFound found = modes_found(family);
  const filters::SecondOrder& truth = family.truth;
  const auto exact = filters::scheme_registry().make("exponential", {});
  const Eigen::MatrixXd step = filters::amplification(*exact, truth.motion_matrix() * family.interval);
  const Eigen::VectorXd law = nearest(
      family,
      {{truth.mass, truth.mass * (Eigen::MatrixXd::Identity(3, 3) - step.bottomRightCorner(3, 3)) / 0.002,
        -truth.mass * step.bottomLeftCorner(3, 3) / 0.002}});
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double w_squared = family.values()[k];
    EXPECT_NEAR(found.damping[k], (law[3 + k] - family.values()[3 + k]) / (w_squared * 0.002), 2e-3) << k;
    EXPECT_NEAR(found.damping[k], 0.5, 0.02) << k;
  }
}

TEST(ManyDegrees, OneChannelWithProcessNoiseKeepsAllOfTheBias) {
  UnknownFamily family = chain_family(3, 0.002, "modes");
  family.samples = 4000;
  const ModesFound without = modes_found(family);
  family.motion_noise = 1e-5;
  const ModesFound with = modes_found(family);
  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_NEAR(with.damping[k], without.damping[k], 0.01) << k;
}

// A held force, and a base that moves: dt K of damping, to the order of the step; of K no term in dt.
TEST(ManyDegrees, DrivenRecordsShowTheSameBias) {
  for (const bool base : {false, true}) {
    UnknownFamily family = chain_family(3, 0.001, "modes");
    family.samples = 4000;
    family.start *= 0.0;
    family.places = Eigen::VectorXd::Unit(3, 2);
    if (base) family.places = -family.truth.mass * Eigen::VectorXd::Ones(3);
    family.forces = Eigen::MatrixXd::Zero(1, family.samples);
    for (Eigen::Index i = 0; i < family.samples; ++i)
      for (int line = 0; line < 40; ++line)
        family.forces(0, i) += std::sin((5.0 + 2.1 * line) * 0.001 * static_cast<double>(i) + line * line);
    for (const auto& [scheme, times] : {std::pair{"forward_euler", 1.0},
                                        {"backward_euler", -1.0},
                                        {"implicit_midpoint", 0.0},
                                        {"exponential", 0.0}}) {
      const ModesFound found = modes_found(family, scheme);
      EXPECT_LT((found.damping.array() - times).abs().maxCoeff(), times == 0.0 ? 2e-3 : 0.03)
          << scheme << ", " << base;
    }
  }
}

TEST(NearestUnknowns, GiveBackWhatAFamilyHolds) {
  for (const char* unknowns : {"all entries", "modes", "storeys", "Rayleigh", "one ratio"}) {
    const UnknownFamily family = chain_family(3, 0.002, unknowns);
    Eigen::VectorXd moved = family.values();
    for (Eigen::Index j = 0; j < moved.size(); ++j)
      moved[j] += 0.3 * family.parts[static_cast<std::size_t>(j)].scale * std::cos(static_cast<double>(j));
    const Eigen::VectorXd found = nearest(family, {family.at(moved)});
    for (Eigen::Index j = 0; j < moved.size(); ++j)
      EXPECT_NEAR(found[j], moved[j], 1e-7 * family.parts[static_cast<std::size_t>(j)].scale) << unknowns;
  }
}

TEST(NearestUnknowns, AreRefusedWhereAChainDoesNotHaveThem) {
  EXPECT_THROW(chain_family(3, 0.002, "colours"), std::invalid_argument);
}

// Lines of the page that stand between ``` and ```.
std::vector<std::string> printed_lines(const std::filesystem::path& page) {
  std::vector<std::string> lines;
  std::ifstream file(page);
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("```", 0) == 0)
      inside = !inside;
    else if (inside && line != "..." && !line.empty())
      lines.push_back(line);
  }
  return lines;
}

const DegreesPage& whole_page() {
  static const DegreesPage page = make_degrees_page(unwatched);
  return page;
}

// Oracle: the Cramer-Rao bound for the scatter over seeds, 1 +- 0.16 of twenty; the law for the mean error.
TEST(ManyDegrees, AreBiasedByManyBoundsInNoise) {
  const DegreesPage& page = whole_page();
  ASSERT_EQ(page.noisy.size(), 12u);
  for (const DegreesNoise& one : page.noisy) {
    EXPECT_NEAR(one.scatter, 1.0, 0.5) << one.filter << ", " << one.scheme << ", " << one.unknown;
    EXPECT_NEAR(one.bias_bound, one.law * one.bias_bound / one.bias,
                3.0 / std::sqrt(20.0) + 0.03 * std::abs(one.bias_bound))
        << one.filter << ", " << one.scheme << ", " << one.unknown;
  }
}

// Sigma points in place of the linearisation: the same limit.
TEST_P(ManyDegreesUnder, TheUnscentedFilterFindsTheSame) {
  const UnknownFamily family = chain_family(3, 0.002, "modes");
  const Eigen::VectorXd law =
      nearest(family, {filters::seen_through(*filters::scheme_registry().make(GetParam(), {}), family.truth,
                                             family.interval)});
  const auto found = measured_unknowns(family, GetParam(), {"ukf"});
  ASSERT_TRUE(found);
  for (std::size_t j = 0; j < family.parts.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    EXPECT_NEAR((*found)[at], law[at],
                1e-4 * std::abs(law[at] - family.parts[j].value) + 1e-7 * family.parts[j].scale)
        << family.parts[j].name;
  }
}

TEST(ManyDegrees, HavePagesThatHoldWhatTheCommandPrints) {
  Results results;
  add_degrees_page(whole_page(), results);
  std::ostringstream printed;
  print(printed, results);
  const std::vector<std::string> output = docs::lines_of(printed.str()),
                                 page = printed_lines(std::filesystem::path(BEAMID_SOURCE_DIR) /
                                                      "docs/theory/many_degrees_of_freedom.md");
  EXPECT_GT(page.size(), 40u);
  for (const std::string& line : page)
    EXPECT_TRUE(std::any_of(output.begin(), output.end(), [&](const std::string& one) {
      return docs::same_line(line, one, 1.0, {1e-3, 1e-6});
    })) << line;
}

}  // namespace
}  // namespace beamid::experiments::many_degrees_test
