// A shear building under a moving base or forces, identified storey by storey. Oracles: the values that its
// record was simulated with, and the Cramer-Rao bound.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/record/record.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "experiments/signal/toolbox.hpp"
#include "tests/experiments/identify/ground_motion.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::chain_test {
namespace {

constexpr const char* building = R"toml(
[chain]
masses_kg = [1000, 1000, 800]
stiffnesses_n_per_m = [2.0e6, 1.6e6, 1.2e6]
dashpots_n_s_per_m = [2000, 1600, 1200]
heights_m = [3, 3, 3]
[excitation]
kind = "base"
file = "quake.csv"
[simulation]
duration_s = 20
sampling_rate_hz = 100
steps_per_sample = 4
[[sensors]]
quantity = "acceleration"
position_m = 3
noise_m_per_s2 = 0.01
[[sensors]]
quantity = "acceleration"
position_m = 9
noise_m_per_s2 = 0.01
[model]
name = "beam"
[reduction]
method = "modal_truncation"
modes = 3
)toml";

constexpr const char* asked = R"toml(
[[parameters]]
quantity = "storey_stiffness"
from_m = 0
to_m = 3
guess_n_per_m = 2.6e6
[[parameters]]
quantity = "storey_stiffness"
from_m = 3
to_m = 9
guess_n_per_m = 1.1e6
[[parameters]]
quantity = "storey_damping"
guess_n_s_per_m = 3000
)toml";

class MovingBase : public testing::Test {
 protected:
  MovingBase() { test::write_ground_motion(place_.path / "quake.csv", 2001); }

  Experiment experiment(const std::string& more, std::uint64_t seed = 1) const {
    Experiment e = read_experiment(TomlTable::parse(std::string(building) + more, "building.toml"));
    e.simulation.seed = seed;
    return e;
  }

  TemporaryFolder place_;
};

TEST_F(MovingBase, IsAChannelOfTheRecordAndOfItsFile) {
  const SimulatedTest test = simulate(experiment(""), place_.path, 0, unwatched);
  ASSERT_EQ(test.record.channels.size(), 3u);
  EXPECT_EQ(test.record.channels[2].quantity, Quantity::base_acceleration);
  EXPECT_TRUE(test.record.objections.empty());
  write_record(test.record, place_.path / "record.csv");
  const Record read = read_record(place_.path / "record.csv");
  EXPECT_EQ(read.channels[2].quantity, Quantity::base_acceleration);
  EXPECT_EQ(read.samples.row(2), test.record.samples.row(2));
}

// rms of (estimate - truth) / bound over seeds: 60 numbers, 1 +- 0.09.
TEST_F(MovingBase, LetsStoreysBeFoundToTheBound) {
  double sum = 0.0, own = 0.0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Experiment e = experiment(asked, seed);
    const ComparedRun run =
        identify_with_model(e, simulated_record(e, place_.path, unwatched), place_.path, unwatched)
            .runs.at(0);
    ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
    for (const ComparedParameter& p : run.parameters) {
      ASSERT_TRUE(p.truth && p.bound) << p.estimate.name;
      sum += std::pow((p.estimate.value - *p.truth) / *p.bound, 2);
      own += p.estimate.deviation / *p.bound;
      ++count;
    }
  }
  ASSERT_EQ(count, 60);
  EXPECT_NEAR(std::sqrt(sum / count), 1.0, 0.25);  // 2.7 of its standard errors
  EXPECT_NEAR(own / count, 1.0, 0.15);
}

constexpr double six_stiffnesses[] = {2.0e6, 2.0e6, 1.6e6, 1.6e6, 1.2e6, 1.2e6};

// Guesses alternately half as large again and half as large as the truth: no common factor mends them, and no
// filter follows six modes from there.
Experiment six_storeys(int passes) {
  std::string text =
      "[chain]\nmasses_kg = [1000, 1000, 1000, 1000, 1000, 1000]\n"
      "stiffnesses_n_per_m = [2.0e6, 2.0e6, 1.6e6, 1.6e6, 1.2e6, 1.2e6]\n"
      "[damping]\nratio = 0.02\n[excitation]\nkind = \"base\"\nfile = \"quake.csv\"\n"
      "[simulation]\nduration_s = 12\nsampling_rate_hz = 100\nsteps_per_sample = 4\n"
      "[model]\nname = \"beam\"\n[reduction]\nmethod = \"none\"\n[compare]\npasses = " +
      std::to_string(passes) + "\n";
  for (const int floor : {2, 3, 5, 6})
    text += "[[sensors]]\nposition_m = " + std::to_string(floor) + "\nnoise_m_per_s2 = 0.02\n";
  for (int i = 0; i < 6; ++i)
    text += "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = " + std::to_string(i) +
            "\nto_m = " + std::to_string(i + 1) + "\nrelative_deviation = 0.5\nguess_n_per_m = " +
            std::to_string((i % 2 == 0 ? 1.5 : 0.5) * six_stiffnesses[i]) + "\n";
  return read_experiment(TomlTable::parse(text, "six.toml"));
}

TEST_F(MovingBase, LetsStoreysBeFoundFromGuessesFiftyPercentOff) {
  const Experiment e = six_storeys(5);
  const ComparedRun run =
      identify_with_model(e, simulated_record(e, place_.path, unwatched), place_.path, unwatched).runs.at(0);
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  for (std::size_t i = 0; i < 6; ++i) {
    const Estimate& found = run.parameters[i].estimate;
    EXPECT_LE(std::abs(found.value - six_stiffnesses[i]), 4.0 * found.deviation) << found.name;
    EXPECT_LE(found.deviation, 0.01 * six_stiffnesses[i]) << found.name;
  }
}

// A scheme that damps makes no record's motion; output error, which takes the exact one, finds the building.
TEST_F(MovingBase, MendsAFilterThatHasSettledOnAWrongAnswer) {
  Experiment e = experiment(asked);
  e.discretisation = "forward_euler";
  const ComparedRecord record = simulated_record(e, place_.path, unwatched);
  const ComparedRun mended = identify_with_model(e, record, place_.path, unwatched).runs.at(0);
  e.reductions = {e.reduction};
  e.filters = {e.filter};
  e.discretisations = {e.discretisation};
  const ComparedRun shown = compare(e, record, place_.path, unwatched).runs.at(0);
  EXPECT_GT(shown.misfit_percent, 2.0);  // a comparison shows what the filter does
  EXPECT_EQ(mended.status, ComparedRun::Status::converged) << mended.reason;
  EXPECT_THAT(mended.remarks, testing::Contains(testing::HasSubstr("those of all samples at once")));
  EXPECT_LT(mended.misfit_percent, 1.0);
  for (const ComparedParameter& p : mended.parameters) {
    ASSERT_TRUE(p.truth && p.bound) << p.estimate.name;
    EXPECT_NEAR(p.estimate.value, *p.truth, 3.5 * p.estimate.deviation) << p.estimate.name;
    EXPECT_NEAR(p.estimate.deviation / *p.bound, 1.0, 0.05) << p.estimate.name;
  }
}

// Readings that are broadband while the base shakes are no loose contact. Oracle: the same readings without
// the base, which are called one.
TEST(Chain, UnderAMovingBaseDoesNotRattle) {
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(2001, 0.0, 20.0);
  const Eigen::ArrayXd size =
      (record.time.array() > 6.0 && record.time.array() < 11.0).select(1.0, 0.05 + 0.0 * record.time.array());
  const Eigen::ArrayXd shaking = size * standard_normal(2001, 1, 0).array(),
                       swing = size * (2.0 * std::numbers::pi * 1.6 * record.time.array()).cos();
  record.samples.resize(2, 2001);
  record.samples.row(0) =
      (8.0 * swing + 0.5 * shaking + 0.01 * standard_normal(2001, 1, 1).array()).transpose();
  record.samples.row(1) = shaking.transpose();
  record.channels = {{Quantity::acceleration, "tip"}, {Quantity::base_acceleration, "base"}};
  Record alone = record;
  alone.samples = record.samples.topRows(1).eval();
  alone.channels.pop_back();
  const std::vector<RecordDefect> of_contact = mark_defects(alone, "record.csv");
  ASSERT_EQ(of_contact.size(), 1u);
  EXPECT_THAT(of_contact[0].text, testing::HasSubstr("rattle"));
  EXPECT_TRUE(mark_defects(record, "record.csv").empty());
}

TEST_F(MovingBase, IsRefusedTwice) {
  Experiment e = experiment(asked);
  Record record = simulate(e, place_.path, 0, unwatched).record;
  record.channels[1] = record.channels[2];
  EXPECT_THROW(
      {
        try {
          identify_with_model(e, measured_record("", record), {}, unwatched);
        } catch (const InputError& error) {
          EXPECT_THAT(error.what(), testing::HasSubstr("several channels of base_acceleration"));
          throw;
        }
      },
      InputError);
}

TEST(Chain, RefusesWhatItsFileCannotHave) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      read_experiment(TomlTable::parse(text, "b.toml"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "read";
  };
  using testing::HasSubstr;
  const std::string two = "[chain]\nmasses_kg = [1, 1]\nstiffnesses_n_per_m = [1, 1]\n";
  EXPECT_EQ(message(two), "read");
  EXPECT_THAT(message("[chain]\nmasses_kg = [1, 1]\nstiffnesses_n_per_m = [1]\n"),
              HasSubstr("1 stiffnesses for 2 floors"));
  EXPECT_THAT(message("[chain]\nmasses_kg = [1]\n"), HasSubstr("stiffnesses_n_per_m"));
  EXPECT_THAT(message(two + "[beam]\nlength_m = 1\n"),
              HasSubstr("chain beside beam; expected one structure"));
  EXPECT_THAT(message(two + "[[sensors]]\nquantity = \"acceleration\"\nposition_m = 1.5\n"),
              HasSubstr("position_m is 1.5; expected the height of a floor: 1, 2"));
  EXPECT_THAT(message(two + "[[sensors]]\nquantity = \"strain\"\nposition_m = 1\ndistance_m = 0.1\n"),
              HasSubstr("a chain has no sections whose strain could be read"));
}

}  // namespace
}  // namespace beamid::experiments::chain_test
