// Several answers of one record. Oracle: two storeys of equal masses by hand. k1 + 2 k2 and k1 k2 are all
// that the frequencies know, so that (2 k2, k1 / 2) has those of (k1, k2).
#include "experiments/identify/twins/record_twins.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "experiments/config/read_experiment.hpp"
#include "experiments/studies/twins/record_report.hpp"
#include "tests/experiments/identify/ground_motion.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::record_twins_test {
namespace {

using testing::HasSubstr, testing::IsEmpty, testing::SizeIs;

constexpr double k1 = 2.0e6, k2 = 1.4e6;

const std::string release = "kind = \"release\"\nposition_m = 2\ndeflection_m = 0.01\n",
                  push = "kind = \"random\"\nposition_m = 2\namplitude_n = 800\nfrequency_hz = 25\n";

std::string sensor(int floor) {
  return "[[sensors]]\nposition_m = " + std::to_string(floor) + "\nnoise_m_per_s2 = 0.02\n";
}

std::string storey(int number, double guess, const std::string& also) {
  return "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = " + std::to_string(number - 1) +
         "\nto_m = " + std::to_string(number) + "\nguess_n_per_m = " + std::to_string(guess) + "\n" + also;
}

/// @param beforehand of every parameter, as a line of [[parameters]]
Experiment storeys(const std::string& excitation, const std::string& sensors,
                   const std::string& beforehand = "relative_deviation = 0.3\n") {
  return read_experiment(TomlTable::parse(
      "[chain]\nmasses_kg = [1000, 1000]\nstiffnesses_n_per_m = [2.0e6, 1.4e6]\n[damping]\nratio = 0.02\n"
      "[excitation]\n" +
          excitation + "[simulation]\nduration_s = 10\nsampling_rate_hz = 100\nsteps_per_sample = 4\n" +
          "[model]\nname = \"beam\"\nsensor_bias = false\n[reduction]\nmethod = \"none\"\n" + sensors +
          storey(1, 1.03 * k1, beforehand) + storey(2, 0.98 * k2, beforehand),
      "storeys.toml"));
}

class TwinsOfARecord : public testing::Test {
 protected:
  Comparison found(const Experiment& e) const {
    return identify_with_model(e, simulated_record(e, place_.path, unwatched), place_.path, unwatched);
  }
  LikeliestSet answered(const Experiment& e) const {
    return likeliest_set(e, place_.path, [&](const Experiment& started) { return found(started); });
  }
  TemporaryFolder place_;
};

TEST_F(TwinsOfARecord, AreThoseOfItsFrequenciesWhereOneSensorSeesADecay) {
  const Experiment e = storeys(release, sensor(2));
  Comparison comparison = found(e);
  const ComparedRun& run = comparison.runs.at(0);
  ASSERT_TRUE(run.has_estimate()) << run.reason;
  const RecordTwins twins = record_twins(e, comparison, place_.path);
  ASSERT_THAT(twins.sets, SizeIs(1));
  // Either may be found; each is the other's twin.
  const double first = run.parameters[0].estimate.value, second = run.parameters[1].estimate.value;
  EXPECT_NEAR(twins.sets[0].values[0] / (2.0 * second), 1.0, 0.01);
  EXPECT_NEAR(twins.sets[0].values[1] / (0.5 * first), 1.0, 0.01);
  EXPECT_NEAR(twins.sets[0].chi_square, 0.0, 1.0);
  EXPECT_FALSE(twins.deciding.empty());
  const LikeliestSet answer = answered(e);
  const ComparedRun& judged = answer.found.runs.at(0);
  EXPECT_EQ(judged.status, ComparedRun::Status::not_unique);
  EXPECT_FALSE(judged.answers());
  EXPECT_THAT(judged.objections.front().text,
              HasSubstr("NOT UNIQUE: at least 1 other set of parameters explains"));
  EXPECT_THAT(judged.objections.front().text, HasSubstr("6 would decide"));
}

TEST_F(TwinsOfARecord, AreRuledOutByASecondSensorOrAMeasuredForce) {
  for (const Experiment& e :
       {storeys(release, sensor(1) + sensor(2)), storeys(push, sensor(2)), storeys(push, sensor(1))}) {
    Comparison comparison = found(e);
    const ComparedRun& run = comparison.runs.at(0);
    ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
    EXPECT_NEAR(run.parameters[0].estimate.value / k1, 1.0, 0.02);
    const RecordTwins twins = record_twins(e, comparison, place_.path);
    EXPECT_EQ(twins.tried, 1u);
    EXPECT_THAT(twins.sets, IsEmpty());
    EXPECT_EQ(answered(e).found.runs.at(0).status, ComparedRun::Status::converged);
  }
}

// The roof's answer to the ground is k1 k2 / (m^2 s^4 + m (k1 + 2 k2) s^2 + k1 k2), the first floor's is not.
TEST_F(TwinsOfARecord, UnderAMovingBaseAreSeenByTheFirstFloorAndNotByTheRoof) {
  test::write_ground_motion(place_.path / "quake.csv", 1201);
  const std::string base = "kind = \"base\"\nfile = \"quake.csv\"\n";
  for (const int floor : {1, 2}) {
    const Experiment e = storeys(base, sensor(floor));
    const RecordTwins twins = record_twins(e, found(e), place_.path);
    EXPECT_EQ(twins.tried, 1u);
    EXPECT_THAT(twins.sets, SizeIs(floor - 1));
  }
}

TEST_F(TwinsOfARecord, AreDecidedBeforehandWhereMuchIsKnown) {
  const LikeliestSet answer = answered(storeys(release, sensor(2), "relative_deviation = 0.05\n"));
  EXPECT_NEAR(answer.found.runs.at(0).parameters[0].estimate.value / k1, 1.0, 0.02);
  EXPECT_EQ(answer.found.runs.at(0).status, ComparedRun::Status::converged);
  ASSERT_THAT(answer.twins.sets, SizeIs(1));
  EXPECT_GT(answer.twins.sets[0].more(), deciding_chi_square);
}

// The search begins at the twin, which the description's own prior excludes.
TEST_F(TwinsOfARecord, GiveTheLikelierSetWhicheverTheSearchFinds) {
  Experiment e = storeys(release, sensor(2), "relative_deviation = 0.05\n");
  int searches = 0;
  const LikeliestSet answer = likeliest_set(e, place_.path, [&](const Experiment& started) {
    Comparison comparison = found(started);
    if (searches++ == 0) {  // as if the filter had ended in the twin
      Experiment elsewhere = e;
      elsewhere.parameters[0].guess = 2.0 * k2, elsewhere.parameters[1].guess = 0.5 * k1;
      comparison =
          identify_with_model(elsewhere, simulated_record(e, place_.path, unwatched), place_.path, unwatched);
      for (std::size_t j = 0; j < 2; ++j) comparison.runs[0].unknowns[j].guess = *e.parameters[j].guess;
    }
    return comparison;
  });
  EXPECT_EQ(searches, 2);
  EXPECT_NEAR(answer.found.runs.at(0).parameters[0].estimate.value / k1, 1.0, 0.02);
  EXPECT_THAT(answer.exchanged, HasSubstr("the likelier set"));
}

}  // namespace
}  // namespace beamid::experiments::record_twins_test
