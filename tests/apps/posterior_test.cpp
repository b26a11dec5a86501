// beamid posterior, end to end: what a user gets.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::posterior_test {
namespace {

using nlohmann::json, testing::HasSubstr;

class PosteriorCommand : public testing::Test {
 protected:
  PosteriorCommand() {
    const fs::path tutorial = source("docs/tutorials/22_posterior");
    for (const char* file : {"frame.toml", "bounded.toml", "modes.toml"})
      fs::copy(tutorial / file, place_.folder() / file);
  }
  Workplace place_;
};

// Oracle: the published posterior of the building (SCIENCE.md, section 9).
TEST_F(PosteriorCommand, GivesThePublishedBuildingUnderItsAuthorsPrior) {
  const json found = json_of(place_.run("posterior modes.toml --config bounded.toml --model-error 0 --json"));
  EXPECT_EQ(found["converged"], true);
  EXPECT_NEAR(found["humps"][0]["parameters"][0]["mean"].get<double>(), 52508, 300);
  EXPECT_NEAR(found["humps"][0]["parameters"][2]["standard_deviation"].get<double>(), 2501, 200);
  EXPECT_EQ(found["parameters"][0]["prior_assumed"], false);
}

TEST_F(PosteriorCommand, SaysInItsFirstLineThatThereAreTwoHumps) {
  const Outcome outcome = place_.run("posterior modes.toml --config frame.toml --model-error 0 --out drawn");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Converged: 4000 draws"));
  EXPECT_THAT(outcome.out, HasSubstr("2 separate humps"));
  EXPECT_THAT(outcome.out, HasSubstr("assumed"));
  for (const char* file :
       {"results.json", "report.html", "posterior.csv", "humps.csv", "modes.csv", "corner.png"})
    EXPECT_TRUE(fs::exists(place_.folder() / "drawn" / file)) << file;
  EXPECT_EQ(contents(place_.folder() / "drawn" / "draws.h5").substr(1, 3), "HDF");
}

TEST_F(PosteriorCommand, RepeatsItselfToTheBit) {
  for (const char* out : {"one", "two"})
    ASSERT_EQ(place_
                  .run(std::string(
                           "posterior modes.toml --config bounded.toml --draws 200 --particles 200 --out ") +
                       out)
                  .code,
              0);
  EXPECT_EQ(contents(place_.folder() / "one" / "draws.h5"), contents(place_.folder() / "two" / "draws.h5"));
}

// Six storeys and five frequencies, each known to 0.02 Hz: a thin sheet, which a hundred particles do not
// find twice.
TEST_F(PosteriorCommand, EndsWithThreeWhereItsTwoTemperingsDisagree) {
  place_.write("six.toml",
               "[chain]\nmasses_kg = [1000, 1000, 1000, 1000, 1000, 800]\n"
               "stiffnesses_n_per_m = [2.0e6, 2.0e6, 1.6e6, 1.6e6, 1.2e6, 1.2e6]\n");
  std::string five;
  for (const char* const hz : {"1.6165", "4.5", "7.2", "9.0", "11.0"})
    five += std::string("[[modes]]\nfrequency_hz = ") + hz + "\nfrequency_standard_deviation_hz = 0.02\n";
  place_.write("five.toml", five);
  const Outcome outcome =
      place_.run("posterior five.toml --config six.toml --model-error 0 --draws 100 --particles 100");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_THAT(outcome.out, testing::StartsWith("Not converged: chains differ"));
  EXPECT_THAT(outcome.out, HasSubstr("temperings differ by"));
}

// One storey of 1000 N/m, its frequency known to 2 %. Oracle: k = (2 pi f)^2 m is 1000 +- 40 N/m, 2.5
// deviations below the bound, and 13 prior deviations below 3000 +- 150.
class PriorOfOneStorey : public PosteriorCommand {
 protected:
  Outcome with(const std::string& prior) {
    place_.write("one.toml",
                 "[chain]\nmasses_kg = [1]\nstiffnesses_n_per_m = [1500]\nheights_m = [1]\n[[parameters]]\n"
                 "quantity = \"storey_stiffness\"\nfrom_m = 0\nto_m = 1\n" +
                     prior);
    place_.write("one_mode.toml",
                 "[[modes]]\nfrequency_hz = 5.0329\nfrequency_standard_deviation_hz = 0.1007\n");
    return place_.run("posterior one_mode.toml --config one.toml --model-error 0");
  }
};

TEST_F(PriorOfOneStorey, IsNamedWhereItsBoundDecides) {
  EXPECT_THAT(with("lower_n_per_m = 1100\nupper_n_per_m = 3000\n").out,
              HasSubstr("draws pile up at its stated bound of 1100 N/m"));
}

TEST_F(PriorOfOneStorey, IsNamedWhereTheMeasurementContradictsIt) {
  EXPECT_THAT(with("guess_n_per_m = 3000\ndeviation_n_per_m = 150\n").out,
              HasSubstr("prior and measurement contradict each other"));
}

TEST_F(PriorOfOneStorey, IsNotNamedWhereItHoldsWhatWasMeasured) {
  for (const char* prior :
       {"lower_n_per_m = 800\nupper_n_per_m = 3000\n", "guess_n_per_m = 1100\ndeviation_n_per_m = 150\n"}) {
    const Outcome outcome = with(prior);
    EXPECT_THAT(outcome.out, testing::StartsWith("Converged"));
    EXPECT_THAT(outcome.out, testing::Not(HasSubstr("pile up")));
    EXPECT_THAT(outcome.out, testing::Not(HasSubstr("contradict")));
  }
}

TEST_F(PosteriorCommand, RefusesAFrequencyWithoutAnyStandardDeviation) {
  place_.write("bare.toml", "[[modes]]\nfrequency_hz = 7.2\n");
  const Outcome outcome = place_.run("posterior bare.toml --config frame.toml --model-error 0");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--model-error is 0"));
}

}  // namespace
}  // namespace beamid::apps::posterior_test
