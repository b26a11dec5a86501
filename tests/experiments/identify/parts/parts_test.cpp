// A building identified part by part. Oracles: the values it was simulated with; the bounds that were worked
// out independently for the twelve-storey building (Koh, See, Balendra), in percent.
#include "experiments/identify/parts/parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

#include "experiments/config/experiment.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "filters/innovation_likelihood.hpp"
#include "filters/latent_inputs.hpp"

namespace beamid::experiments::parts_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double proportion = 0.006 / (2.0 * 3.14159265358979 * 0.8387);  // c = beta k

double stiffness(int storey) {
  return storey <= 4 ? 2.0e6 : storey <= 8 ? 1.6e6 : 1.2e6;
}

// Floors of 1000 kg, forces at floors 6 and 12, an accelerometer on every floor.
std::string building(int floors, const std::vector<double>& noise, double duration, double guess) {
  std::string masses, stiffnesses, dashpots, text;
  for (int i = 1; i <= floors; ++i) {
    masses += i > 1 ? ", 1000" : "1000";
    stiffnesses += fmt::format("{}{}", i > 1 ? ", " : "", stiffness(i));
    dashpots += fmt::format("{}{}", i > 1 ? ", " : "", proportion * stiffness(i));
  }
  text = fmt::format("[chain]\nmasses_kg = [{}]\nstiffnesses_n_per_m = [{}]\ndashpots_n_s_per_m = [{}]\n",
                     masses, stiffnesses, dashpots);
  for (const int floor : {floors / 2, floors})
    text += fmt::format(
        "[[excitations]]\nkind = \"random\"\namplitude_n = 500\nfrequency_hz = 100\nposition_m = {}\n",
        floor);
  text +=
      fmt::format("[simulation]\nduration_s = {}\nsampling_rate_hz = 200\nsteps_per_sample = 1\n", duration);
  for (int i = 1; i <= floors; ++i)
    text += fmt::format("[[sensors]]\nquantity = \"acceleration\"\nposition_m = {}\nnoise_m_per_s2 = {}\n", i,
                        noise[static_cast<std::size_t>(i - 1)]);
  for (int i = 1; i <= floors; ++i) {
    text += fmt::format(
        "[[parameters]]\nquantity = \"storey_stiffness\"\nname = \"k{}\"\nfrom_m = {}\nto_m = {}\n"
        "form = \"logarithmic\"\nguess_n_per_m = {}\nrelative_deviation = 0.5\n",
        i, i - 1, i, guess * stiffness(i));
    text += fmt::format(
        "[[parameters]]\nquantity = \"storey_damping\"\nname = \"c{}\"\nfrom_m = {}\nto_m = {}\n"
        "form = \"logarithmic\"\nguess_n_s_per_m = {}\nrelative_deviation = 1.0\n",
        i, i - 1, i, guess * proportion * stiffness(i));
  }
  return text;
}

Experiment read(const std::string& text) {
  return read_experiment(TomlTable::parse(text, "building.toml"));
}

// The accelerations' noise, 5 % of each root mean square.
std::vector<double> five_percent(int floors, double duration) {
  const SimulatedTest clean = simulate(
      read(building(floors, std::vector<double>(static_cast<std::size_t>(floors), 0.0), duration, 1.0)), {},
      0, unwatched);
  std::vector<double> noise;
  for (int i = 0; i < floors; ++i)
    noise.push_back(0.05 * std::sqrt(clean.record.samples.row(i).squaredNorm() /
                                     static_cast<double>(clean.record.size())));
  return noise;
}

// With every channel's noise stated.
ComparedRecord recorded(const Experiment& experiment) {
  ComparedRecord record = simulated_record(experiment, {}, unwatched);
  for (std::size_t i = 0; i < record.record.channels.size(); ++i)
    record.record.channels[i].noise = record.sensor_noise[static_cast<Index>(i)];
  record.record = with_places(record.record, experiment);
  return record;
}

// Of the unknowns of a part at the truth, in percent (q).
VectorXd bounds_percent(const Experiment& experiment, const PartOfStructure& part) {
  const ComparedRecord own = record_of_part(experiment, recorded(experiment), part, Sections::noisy);
  const Experiment asked = experiment_of_part(experiment, own, part);
  const ModelSetting setting = model_setting(asked, own.record, asked.reduction);
  const auto model = model_registry().make("beam", asked.model.options, setting);
  const filters::Measurements record = measurements(own.record);
  const std::vector<Index> outputs = output_channels(own.record), inputs = input_channels(own.record);
  VectorXd r(static_cast<Index>(outputs.size())), u(static_cast<Index>(inputs.size()));
  for (Index i = 0; i < r.size(); ++i) r[i] = own.record.channels[static_cast<std::size_t>(outputs[i])].noise;
  for (Index i = 0; i < u.size(); ++i) u[i] = own.record.channels[static_cast<std::size_t>(inputs[i])].noise;
  filters::NoisyInputs noisy(filters::discretise(model->motion, own.record.interval(), "exponential",
                                                 {{}, MatrixXd(r.cwiseAbs2().asDiagonal())}),
                             u);
  const filters::Gaussian start = initial_estimate(
      *model,
      start_directions(*model, setting.observations,
                       start_scale(*model, setting.observations, record.outputs, record.time.maxCoeff())));
  const filters::InnovationProblem problem =
      filters::held_problem(noisy, record, model->unknown_places, noisy.with_errors(start));
  const VectorXd truth = start.mean(model->unknown_places);  // the guesses are the truth here
  const MatrixXd inverse = filters::innovation_information(problem, truth).inverse();
  return 100.0 * inverse.diagonal().cwiseSqrt();  // of logarithms: relative
}

TEST(Substructure, OfTwelveStoreysHasTheBoundsWorkedOutForIt) {
  // Oracle: bounds of k5 to k9 with 5 % noise at the interfaces too, and of c, to the digits given.
  const Experiment experiment = read(building(12, five_percent(12, 20.0), 20.0, 1.0));
  PartOfStructure part{"floors 5 to 8", 4.0, 9.0, {}, {}, {}};
  const VectorXd bounds = bounds_percent(experiment, part);
  ASSERT_EQ(bounds.size(), 10);
  const double published[] = {0.099, 0.060, 0.052, 0.058, 0.102};
  for (Index j = 0; j < 5; ++j) {
    EXPECT_NEAR(bounds[2 * j], published[j], 0.12 * published[j]) << "k" << j + 5;
    EXPECT_GT(bounds[2 * j + 1], 0.63) << "c" << j + 5;
    EXPECT_LT(bounds[2 * j + 1], 2.0) << "c" << j + 5;
  }
}

TEST(Substructure, IsFoundFromGuessesFarOffWithTheDeviationItStates) {
  const Experiment experiment = read(building(6, five_percent(6, 6.0), 6.0, 1.5) +
                                     "[[substructures]]\nname = \"floors 3 and 4\"\nfrom_m = 2\nto_m = 5\n");
  const PartedIdentification found = identify_parts(experiment, recorded(experiment), {}, false, unwatched);
  const ComparedRun& run = found.parts.front().run(Sections::noisy);
  ASSERT_TRUE(run.has_estimate()) << run.reason;
  ASSERT_EQ(run.parameters.size(), 6u);
  for (const ComparedParameter& one : run.parameters) {
    ASSERT_TRUE(one.truth && one.bound) << one.estimate.name;
    EXPECT_LT(std::abs(one.estimate.value - *one.truth), 4.0 * one.estimate.deviation) << one.estimate.name;
    EXPECT_NEAR(one.estimate.deviation / *one.bound, 1.0, 0.05) << one.estimate.name;
  }
}

TEST(Substructures, JoinWhatTheyShare) {
  const Experiment experiment = read(building(6, five_percent(6, 4.0), 4.0, 1.0) +
                                     "[[substructures]]\nname = \"lower\"\nto_m = 4\n"
                                     "[[substructures]]\nname = \"upper\"\nfrom_m = 3\n");
  const PartedIdentification found = identify_parts(experiment, recorded(experiment), {}, false, unwatched);
  ASSERT_EQ(found.joined.size(), 12u);
  for (const JoinedParameter& one : found.joined) {
    const bool shared = one.name == "k4" || one.name == "c4";
    EXPECT_EQ(one.parts, shared ? 2 : 1) << one.name;
    EXPECT_LT(one.disagreement, 4.0) << one.name;
    EXPECT_LT(std::abs(one.value - *one.truth), 4.0 * one.deviation) << one.name;
  }
}

TEST(Substructure, OfSensorsExchangedIsNotConverged) {
  // Oracle: the floors' accelerations 4 and 5, one a section and one inside, in each other's channel.
  const Experiment experiment =
      read(building(6, five_percent(6, 4.0), 4.0, 1.0) + "[[substructures]]\nname = \"lower\"\nto_m = 5\n");
  ComparedRecord record = recorded(experiment);
  record.record.samples.row(3).swap(record.record.samples.row(4));
  const PartedIdentification found = identify_parts(experiment, record, {}, false, unwatched);
  EXPECT_NE(found.parts.front().run(Sections::noisy).status, ComparedRun::Status::converged);
  EXPECT_TRUE(found.joined.empty());
  EXPECT_FALSE(found.converged());
}

// Oracle: the values simulated with. Noise of 20 % at a section, stated as it is, moves the storeys inside by
// as much as a fifth of their motion: that is left, and is what was stated. Before, the part was
// contradicted.
TEST(Substructure, OfNoisySectionsIsNotContradictedByTheirNoise) {
  std::vector<double> noise = five_percent(6, 6.0);
  for (double& one : noise) one *= 4.0;
  const Experiment experiment =
      read(building(6, noise, 6.0, 1.2) + "[[substructures]]\nname = \"upper\"\nfrom_m = 3\n");
  const PartedIdentification found = identify_parts(experiment, recorded(experiment), {}, false, unwatched);
  const ComparedRun& run = found.parts.front().run(Sections::noisy);
  EXPECT_GT(run.misfit_percent, 10.0);
  EXPECT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  for (const ComparedParameter& one : run.parameters)
    EXPECT_LT(std::abs(one.estimate.value - *one.truth), 4.0 * one.estimate.deviation) << one.estimate.name;
}

// Oracle: with all noise a tenth of what it is the weights are the same, and so is the true spread: estimates
// and deviations of the run with the noise stated well.
TEST(Substructure, OfNoiseStatedTooSmallHasDeviationsAsWideAsThatOfTheNoiseThereIs) {
  const Experiment experiment = read(building(6, five_percent(6, 6.0), 6.0, 1.2) +
                                     "[[substructures]]\nname = \"floors 3 and 4\"\nfrom_m = 2\nto_m = 5\n");
  ComparedRecord record = recorded(experiment);
  const PartedIdentification well = identify_parts(experiment, record, {}, false, unwatched);
  for (Channel& channel : record.record.channels) channel.noise *= 0.1;
  record.sensor_noise *= 0.1;
  const PartedIdentification tenth = identify_parts(experiment, record, {}, false, unwatched);
  const ComparedRun &right = well.parts.front().run(Sections::noisy),
                    &wrong = tenth.parts.front().run(Sections::noisy);
  ASSERT_TRUE(right.has_estimate() && wrong.has_estimate());
  ASSERT_FALSE(wrong.objections.empty());
  EXPECT_THAT(wrong.objections.front().text, testing::HasSubstr("deviations are widened"));
  for (std::size_t j = 0; j < right.parameters.size(); ++j)
    EXPECT_NEAR(wrong.parameters[j].estimate.deviation / right.parameters[j].estimate.deviation, 1.0, 0.15)
        << right.parameters[j].estimate.name;
}

TEST(Substructure, OfASystemIsBoundedByPlacesByName) {
  // Oracle: what lies inside, by hand: of a chain of five unknowns the three between the first and the last.
  Experiment experiment;
  fem::MatrixSystem chain;
  MatrixXd k = MatrixXd::Zero(5, 5);
  for (Index i = 0; i < 5; ++i) {
    k(i, i) = i < 4 ? 2.0 : 1.0;
    if (i > 0) k(i, i - 1) = k(i - 1, i) = -1.0;
  }
  chain.stiffness = (1e6 * k).sparseView();
  chain.mass = MatrixXd(1000.0 * MatrixXd::Identity(5, 5)).sparseView();
  chain.labels = {"u1", "u2", "u3", "u4", "u5"};
  experiment.structure = chain;
  ComparedRecord record;
  record.record.time = VectorXd::LinSpaced(20, 0.0, 0.19);
  record.record.samples = MatrixXd::Random(5, 20);
  for (const char* const place : {"u1", "u2", "u3", "u4", "u5"}) {
    Channel channel{Quantity::acceleration, place, {}, 0.0, place, 0.01};
    record.record.channels.push_back(channel);
  }
  record.sensor_noise = VectorXd::Zero(5);
  const PartOfStructure part{"middle", {}, {}, {"u1", "u4"}, "u2", {}};
  const ComparedRecord own = record_of_part(experiment, record, part, Sections::noisy);
  std::string found;
  for (const Channel& channel : own.record.channels)
    found += fmt::format("{} {}, ", channel.name, to_string(channel.quantity));
  EXPECT_EQ(found, "u1 support_acceleration, u2 acceleration, u3 acceleration, u4 support_acceleration, ");
}

void expect_refused(const std::string& more, const std::string& words) {
  const Experiment experiment = read(building(6, five_percent(6, 1.0), 1.0, 1.0) + more);
  try {
    identify_parts(experiment, recorded(experiment), {}, false, unwatched);
    FAIL() << more;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(words));
  }
}

TEST(Substructures, OfAChainTakeItsPartAlone) {
  // Oracle: the same part of the chain uncut, whose parameter of all storeys keeps it from being cut.
  const Experiment experiment = read(building(9, five_percent(9, 3.0), 3.0, 1.2) +
                                     "[[substructures]]\nname = \"middle\"\nfrom_m = 3\nto_m = 7\n");
  const ComparedRecord record = recorded(experiment);
  const PartOfStructure& part = experiment.parts.front();
  const CutChain cut = cut_chain(experiment, record_of_part(experiment, record, part, Sections::noisy), part);
  EXPECT_EQ(cut.experiment.structure.beam().segments.size(), 5u);
  EXPECT_EQ(cut.experiment.parameters.size(), 10u);
  const Experiment asked = experiment_of_part(cut.experiment, cut.record, cut.part);
  const ComparedRun alone = compare(asked, cut.record, {}, unwatched).runs.front();
  const ComparedRecord own = record_of_part(experiment, record, part, Sections::noisy);
  const ComparedRun uncut =
      compare(experiment_of_part(experiment, own, part), own, {}, unwatched).runs.front();
  ASSERT_EQ(alone.parameters.size(), uncut.parameters.size());
  for (std::size_t j = 0; j < alone.parameters.size(); ++j) {
    EXPECT_EQ(alone.parameters[j].estimate.name, uncut.parameters[j].estimate.name);
    EXPECT_NEAR(alone.parameters[j].estimate.value / uncut.parameters[j].estimate.value, 1.0, 1e-7);
    EXPECT_NEAR(alone.parameters[j].estimate.deviation / uncut.parameters[j].estimate.deviation, 1.0, 1e-5);
    EXPECT_EQ(*alone.parameters[j].truth, *uncut.parameters[j].truth);
  }
}

TEST(Substructures, RefuseASectionWithoutASensor) {
  expect_refused("[[substructures]]\nname = \"one\"\nfrom_m = 2.5\nto_m = 5\n",
                 "1 of its 2 sections has an accelerometer");
}

TEST(Substructures, RefuseAPartWithoutASensorInside) {
  expect_refused("[[substructures]]\nname = \"one\"\nfrom_m = 4\nto_m = 5\n", "no sensor sits inside it");
}

TEST(Substructures, RefuseLinesOfTheSpectrumOfAPartThatIsNoSpan) {
  expect_refused("[[substructures]]\nname = \"one\"\nfrom_m = 2\nto_m = 5\nhighest_hz = 20\n",
                 "highest_hz is of spans of a beam");
}

TEST(Substructures, RefuseADampingRatioOfTheWhole) {
  expect_refused(
      "[[parameters]]\nquantity = \"damping_ratio\"\n[[substructures]]\nname = \"one\"\nfrom_m = 2\n"
      "to_m = 5\n",
      "of the whole structure's modes");
}

}  // namespace
}  // namespace beamid::experiments::parts_test
