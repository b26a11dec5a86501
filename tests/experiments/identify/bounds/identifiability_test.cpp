// Whole tests of the study's beam.
#include "experiments/identify/bounds/identifiability.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/studies/bounds/report.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments::identifiability_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr const char* beam_text = R"toml([beam]
length_m = 1.10
width_m = 0.060
height_m = 0.006
youngs_modulus_pa = 2.12e11
mass_kg = 3.055
tip_mass_kg = 3.644615
elements = 20

[damping]
ratio = 0.0015

[simulation]
duration_s = 10
sampling_rate_hz = 500

[[sensors]]
noise_m_per_s2 = 0.05

[identifiability]
places = 20
more_sensors = 2
)toml";

Identifiability found(const std::string& more, const std::string& model, const std::string& reduction) {
  Experiment experiment = read_experiment(TomlTable::parse(std::string(beam_text) + more, "test"));
  experiment.model = {model, model_registry().completed(model, {}), {"test"}};
  experiment.reduction = parse_reduction(reduction, "test");
  return find_identifiability(experiment, ".", [](const std::string&) {});
}

constexpr const char* stiffness_and_tip_mass = R"toml(
[[parameters]]
quantity = "bending_stiffness"
[[parameters]]
quantity = "tip_mass"
[[parameters]]
quantity = "damping_ratio"
)toml";

TEST(Identifiability, OfTheHeaviestTestBeamIsThatOfOneDegreeOfFreedom) {
  // Oracle: y = A e^(-xi w t) cos(w t) in white noise, amplitude and phase unknown, A = 1.417 m/s2 of mode 1
  // after a release from 12 mm; for short records of slight damping the closed form of a line's slope,
  // sigma_d = sqrt(24 / (N T^2)) sigma / A.
  const Identifiability one = found("", "sdof", "rayleigh");
  ASSERT_EQ(one.parameters.size(), 2u);
  const double omega = 2 * M_PI * 1.7299, d = 0.0015 * omega, factor = std::exp(d * 10.0 / 2.0);
  const double deviation = std::sqrt(24.0 / 5000.0) / 10.0 * 0.05 / 1.417 * factor;
  EXPECT_NEAR(one.parameters[1].bound_percent() / (100.0 * deviation / d), 1.0, 0.05);
  EXPECT_NEAR(one.parameters[1].bound_percent() / one.parameters[0].bound_percent() * 2 * 0.0015, 1.0, 0.05);
  EXPECT_TRUE(one.places.empty());
}

TEST(Identifiability, NeedsASecondModeToTellAMassFromAStiffness) {
  // One mode has one frequency and one damping ratio: of three unknowns two combinations. The frequency is
  // the same where the changes of EI and of the tip mass hold each other in balance: d ln w / d ln EI = 1/2
  // and, by Rayleigh, d ln w / d ln m_t = -m_t / (2 m_modal), m_modal = 4.371662 kg.
  const Identifiability one = found(stiffness_and_tip_mass, "beam", "modal_truncation:modes=1");
  EXPECT_EQ(one.report.rank, 2);
  EXPECT_EQ(one.parameters[0].verdict, ParameterBound::Verdict::combination);
  EXPECT_EQ(one.parameters[1].verdict, ParameterBound::Verdict::combination);
  EXPECT_EQ(one.parameters[2].verdict, ParameterBound::Verdict::determined);
  const MatrixXd silent = silent_combinations(one.report);
  ASSERT_EQ(silent.cols(), 1);
  EXPECT_NEAR(silent(0, 0) / silent(1, 0), 3.644615 / 4.371662, 1e-4);
  EXPECT_NEAR(silent(2, 0), 0.0, 1e-6);

  const Identifiability two = found(stiffness_and_tip_mass, "beam", "modal_truncation:modes=2");
  EXPECT_EQ(two.report.rank, 3);
  for (const ParameterBound& bound : two.parameters)
    EXPECT_EQ(bound.verdict, ParameterBound::Verdict::determined) << bound.name;
}

TEST(Identifiability, OfAModeEndsWhereTheModeHasItsNode) {
  // The second mode of a cantilever without a tip mass has its node at 0.78344 of the length.
  std::string text = beam_text;
  text.erase(text.find("tip_mass_kg = 3.644615\n"), 23);
  Experiment experiment = read_experiment(TomlTable::parse(text, "test"));
  experiment.model = {"modal", model_registry().completed("modal", {}), {"test"}};
  experiment.reduction = parse_reduction("modal_truncation:modes=2", "test");
  const Identifiability modal = find_identifiability(experiment, ".", [](const std::string&) {});
  ASSERT_EQ(modal.parameters[3].name, "damping_ratio_2");
  const VectorXd bound = modal.places.percent.col(3);
  const Index half = bound.size() / 2;  // near the clamp nothing moves
  Index worst = 0, best = 0;
  EXPECT_GT(bound.tail(half).maxCoeff(&worst), 5.0 * bound[half]);
  EXPECT_NEAR(modal.places.at[bound.size() - half + worst], 0.78344 * 1.10, 0.5 * 1.10 / 20);
  modal.places.percent.col(1).minCoeff(&best);
  EXPECT_DOUBLE_EQ(modal.places.at[best], 1.10);
}

TEST(Identifiability, GrowsWithRecordSensorsAndRate) {
  const Identifiability test = found("", "beam", "modal_truncation:modes=2");
  for (Index j = 0; j < 2; ++j) {
    for (Index i = 1; i < test.lengths.at.size(); ++i)
      EXPECT_LE(test.lengths.percent(i, j), test.lengths.percent(i - 1, j) * (1 + 1e-9));
    for (Index i = 1; i < test.numbers.at.size(); ++i)
      EXPECT_LT(test.numbers.percent(i, j), test.numbers.percent(i - 1, j));
    EXPECT_NEAR(test.rates.percent(1, j) / test.rates.percent(0, j), std::sqrt(2.0), 0.02);
    EXPECT_DOUBLE_EQ(test.lengths.percent(test.described_length, j),
                     test.parameters[static_cast<std::size_t>(j)].bound_percent());
    // Another pass of another model, with twenty more sensors that are not read.
    EXPECT_NEAR(test.numbers.percent(0, j) / test.parameters[static_cast<std::size_t>(j)].bound_percent(),
                1.0, 0.01);
  }
  EXPECT_DOUBLE_EQ(test.lengths.at[test.described_length], 10.0);
}

TEST(Identifiability, AssumesNoiseAndDampingWhereNoneIsDescribedAndSaysSo) {
  Experiment experiment;
  experiment.structure = read_experiment(TomlTable::parse(beam_text, "test")).structure.beam();
  experiment.elements = 10;
  experiment.simulation.duration = 2.0;
  experiment.model = {"modal", model_registry().completed("modal", {}), {"test"}};
  experiment.reduction = parse_reduction("modal_truncation:modes=1", "test");
  const Identifiability test = find_identifiability(experiment, ".", [](const std::string&) {});
  ASSERT_EQ(test.sensors.size(), 1u);
  EXPECT_TRUE(test.sensors[0].assumed);
  EXPECT_EQ(test.notes.size(), 3u);
  EXPECT_DOUBLE_EQ(test.parameters[1].value, 0.005);
}

TEST(Identifiability, OfAForceNotMeasuredBeginsWhenItHasEnded) {
  constexpr const char* blow = R"toml(
[excitation]
kind = "impulse"
position_m = 0.55
momentum_n_s = 0.1
duration_s = 0.02
)toml";
  const Identifiability with = found(blow, "beam", "modal_truncation:modes=2");
  EXPECT_TRUE(with.force_measured);
  EXPECT_DOUBLE_EQ(with.begin, 0.0);
  Experiment experiment = read_experiment(TomlTable::parse(std::string(beam_text) + blow, "test"));
  experiment.model = {"beam", model_registry().completed("beam", {}), {"test"}};
  experiment.reduction = parse_reduction("modal_truncation:modes=2", "test");
  experiment.identifiability.force_measured = false;
  const Identifiability without = find_identifiability(experiment, ".", [](const std::string&) {});
  EXPECT_FALSE(without.force_measured);
  EXPECT_NEAR(without.begin, 0.02, 0.003);
  for (std::size_t j = 0; j < 2; ++j)
    EXPECT_GE(without.parameters[j].bound, 0.999 * with.parameters[j].bound);
}

// [[excitations]], one after the other.
std::string excitations(const std::vector<std::string>& all) {
  std::string text;
  for (const std::string& one : all) text += "[[excitations]]\n" + one;
  return text;
}

const std::string random_force = "kind = \"random\"\nposition_m = 0.55\namplitude_n = 2\nfrequency_hz = 40\n";
const std::string base_motion = "kind = \"base\"\namplitude_m_per_s2 = 0.5\nfrequency_hz = 7\n";

std::string sine_of(double amplitude) {
  return "kind = \"harmonic\"\nposition_m = 1.1\nfrequency_hz = 11\namplitude_n = " +
         std::to_string(amplitude) + "\n";
}

TEST(Identifiability, OfAListOfOneExcitationIsThatOfTheExcitation) {
  const Identifiability one = found("[excitation]\n" + random_force, "beam", "modal_truncation:modes=2"),
                        list = found(excitations({random_force}), "beam", "modal_truncation:modes=2");
  EXPECT_TRUE(list.force_measured);
  for (const auto sweep : {&Identifiability::lengths, &Identifiability::rates, &Identifiability::places,
                           &Identifiability::numbers})
    EXPECT_EQ((one.*sweep).percent, (list.*sweep).percent);
}

// 1 / bound^2 of the only unknown.
double information_of_stiffness(const std::vector<std::string>& all) {
  const Identifiability one = found("[[parameters]]\nquantity = \"bending_stiffness\"\n" + excitations(all),
                                    "beam", "modal_truncation:modes=2");
  return 1.0 / (one.parameters.at(0).bound * one.parameters.at(0).bound);
}

// Oracle: the motion, and with it the sensitivity to the stiffness, is linear in the forces; what the unknown
// start takes off is a projection that does not depend on them. So the information is a square of the forces:
// I(a + b) + I(a - b) = 2 I(a) + 2 I(b).
TEST(Identifiability, OfSeveralExcitationsObeysTheParallelogramLaw) {
  const double plus = information_of_stiffness({random_force, sine_of(0.5), base_motion}),
               minus = information_of_stiffness({random_force, sine_of(-0.5), base_motion}),
               without = information_of_stiffness({random_force, base_motion}),
               alone = information_of_stiffness({sine_of(0.5)});
  EXPECT_NEAR((plus + minus) / (2 * without + 2 * alone), 1.0, 1e-9);
  EXPECT_GT(std::abs(plus - minus), 1e-3 * plus);  // they are not simply added
}

// The same law; the start is that of the model nearest to the continuum's.
TEST(Identifiability, OfAStartWithForcesObeysTheParallelogramLaw) {
  const std::string release = "kind = \"release\"\nposition_m = 0.55\ndeflection_m = 0.002\n";
  const double plus = information_of_stiffness({release, sine_of(3.0)}),
               minus = information_of_stiffness({release, sine_of(-3.0)}),
               released = information_of_stiffness({release}),
               driven = information_of_stiffness({sine_of(3.0)});
  EXPECT_NEAR((plus + minus) / (2 * released + 2 * driven), 1.0, 1e-3);
}

// Oracle: the Cramer-Rao bound that compare works out from the record simulated with the same excitations,
// at what it estimates.
TEST(Identifiability, OfSeveralExcitationsIsTheBoundOfTheirRecord) {
  Experiment experiment = read_experiment(TomlTable::parse(
      std::string(beam_text) + excitations({random_force, sine_of(0.5), base_motion}), "test"));
  experiment.model = {"beam", model_registry().completed("beam", {}), {"test"}};
  experiment.reduction = parse_reduction("modal_truncation:modes=2", "test");
  experiment.reductions = {experiment.reduction};
  experiment.filters = {experiment.filter};
  experiment.discretisations = {experiment.discretisation};
  experiment.format.input = InputPath::linear;
  experiment.simulation.method.options["modes"] = 2.0;
  const auto silent = [](const std::string&) {};
  const Comparison compared = compare(experiment, simulated_record(experiment, ".", silent), ".", silent);
  const ComparedRun& run = compared.runs.at(0);
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  const Identifiability test = find_identifiability(experiment, ".", silent);
  ASSERT_EQ(test.parameters.size(), run.parameters.size());
  for (std::size_t j = 0; j < test.parameters.size(); ++j)
    EXPECT_NEAR(test.parameters[j].bound / run.parameters[j].bound.value(), 1.0, 0.03)
        << test.parameters[j].name;
}

TEST(Identifiability, OfForcesNotMeasuredBeginsWhenTheLastHasEnded) {
  const std::string blow = "kind = \"impulse\"\nposition_m = 0.55\nmomentum_n_s = 0.1\nduration_s = ";
  Experiment experiment = read_experiment(
      TomlTable::parse(std::string(beam_text) + excitations({blow + "0.1\n", blow + "0.02\n"}), "test"));
  experiment.further_excitations[0].position = 0.8;
  experiment.model = {"beam", model_registry().completed("beam", {}), {"test"}};
  experiment.reduction = parse_reduction("modal_truncation:modes=2", "test");
  experiment.identifiability.force_measured = false;
  const Identifiability test = find_identifiability(experiment, ".", [](const std::string&) {});
  EXPECT_FALSE(test.force_measured);
  EXPECT_NEAR(test.begin, 0.1, 0.003);
}

TEST(Identifiability, RefusesSensorsThatShowNothing) {
  // Mode 2 of a beam pinned at both ends has its node at midspan.
  std::string text = beam_text;
  text.erase(text.find("tip_mass_kg = 3.644615\n"), 23);
  text.insert(text.find("elements"), "support = \"pinned-pinned\"\n");
  text.insert(text.find("noise_m_per_s2"), "position_m = 0.55\n");
  Experiment experiment = read_experiment(TomlTable::parse(text + "[excitation]\nkind = \"none\"\nmode = 2\n"
                                                                  "deflection_m = 0.01\nposition_m = 0.275\n",
                                                           "test"));
  experiment.model = {"beam", model_registry().completed("beam", {}), {"test"}};
  experiment.reduction = parse_reduction("modal_truncation:modes=2", "test");
  EXPECT_THROW(find_identifiability(experiment, ".", [](const std::string&) {}), std::invalid_argument);
}

TEST(SilentCombinations, HaveAsManyZerosAsCanBe) {
  // Null space spanned by (1, 1, 0, 0) and (0, 0, 2, 1), turned by 30 degrees.
  filters::InformationFactor factor(4);
  MatrixXd rows(2, 4);
  rows << 1, -1, 0, 0, 0, 0, 1, -2;
  factor.add(rows);
  const MatrixXd silent = silent_combinations(filters::determined_combinations(factor, VectorXd::Ones(4)));
  ASSERT_EQ(silent.cols(), 2);
  for (Index k = 0; k < 2; ++k) {
    EXPECT_EQ((silent.col(k).array() == 0.0).count(), 2);
    EXPECT_DOUBLE_EQ(silent.col(k).maxCoeff(), 1.0);
    EXPECT_NEAR((rows * silent.col(k)).norm(), 0.0, 1e-12);
  }
}

TEST(IdentifiabilityReport, SaysInWordsWhatIsKnownOnlyInCombination) {
  const std::vector<std::string> text =
      words(found(stiffness_and_tip_mass, "beam", "modal_truncation:modes=1"));
  const auto said = [&](const char* what) {
    return std::any_of(text.begin(), text.end(),
                       [&](const std::string& one) { return one.find(what) != std::string::npos; });
  };
  EXPECT_TRUE(said("Only in combination: bending_stiffness and tip_mass."));
  EXPECT_TRUE(said("Determined: damping_ratio to"));
}

TEST(IdentifiabilityReport, CallsNothingDeterminedThatIsKnownRoughly) {
  Identifiability one = found(stiffness_and_tip_mass, "beam", "modal_truncation:modes=1");
  for (ParameterBound& p : one.parameters) {
    p.verdict = ParameterBound::Verdict::determined;
    p.bound = (p.name == "damping_ratio" ? 0.45 : 0.03) * p.size;
  }
  EXPECT_THAT(words(one), testing::Contains(testing::HasSubstr("Only roughly: damping_ratio to 45 %.")));
}

}  // namespace
}  // namespace beamid::experiments::identifiability_test
