// Commands on a chain whose storeys follow laws: who takes it, who says what it shows, who refuses it.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::storey_laws_test {
namespace {

using nlohmann::json, testing::HasSubstr;

constexpr const char* yielding = R"toml(
[chain]
masses_kg = [1000, 1000]
stiffnesses_n_per_m = [4.0e5, 3.2e5]
dashpots_n_s_per_m = [800, 640]
[[chain.storeys]]
storey = 1
law = "bouc_wen"
post_yield_ratio = 0.3
hysteresis_beta_per_m = 60
hysteresis_gamma_per_m = 40
[excitation]
kind = "base"
amplitude_m_per_s2 = 1.5
frequency_hz = 1.7
[simulation]
duration_s = 4
sampling_rate_hz = 100
[[sensors]]
position_m = 1
noise_m_per_s2 = 0.01
[[sensors]]
position_m = 2
noise_m_per_s2 = 0.01
)toml";

class StoreyLaws : public testing::Test {
 protected:
  StoreyLaws() {
    place_.write("yielding.toml", yielding);
    std::string linear = yielding;
    const auto from = linear.find("[[chain.storeys]]"), to = linear.find("[excitation]");
    place_.write("linear.toml", linear.erase(from, to - from));
  }
  Workplace place_;
};

// Oracle: the linear chain's own numbers.
TEST_F(StoreyLaws, ModesAndResponsesAreThoseOfSmallMotionAndSayIt) {
  for (const std::string command : {"modes", "frf"}) {
    const Outcome laws = place_.run(command + " --config yielding.toml");
    ASSERT_EQ(laws.code, 0) << laws.err;
    EXPECT_THAT(laws.out, HasSubstr("small motion about rest")) << command;
    EXPECT_THAT(laws.out, HasSubstr("storey 1 bouc_wen")) << command;
    EXPECT_THAT(place_.run(command + " --config linear.toml").out, testing::Not(HasSubstr("small motion")));
  }
  const json with = json_of(place_.run("modes --config yielding.toml --json")),
             without = json_of(place_.run("modes --config linear.toml --json"));
  EXPECT_EQ(with["modes"], without["modes"]);
  EXPECT_EQ(with["configuration"]["experiment"]["chain"]["storeys"][0]["law"], "bouc_wen");
}

TEST_F(StoreyLaws, SimulateSaysWhoMovedThem) {
  const Outcome made = place_.run("simulate --config yielding.toml --out made");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("of storeys: storey 1 bouc_wen."));
  EXPECT_THAT(made.out, HasSubstr("Method cvode"));
  const Outcome other = place_.run("simulate --config yielding.toml --method newmark");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("moves linear storeys"));
}

// One sentence, at the law's line.
TEST_F(StoreyLaws, AreRefusedByWhatKnowsLinearStoreysOnly) {
  ASSERT_EQ(place_.run("simulate --config linear.toml --out made").code, 0);
  place_.write("modes.toml", "[[modes]]\nfrequency_hz = 1.7\nstandard_deviation_hz = 0.01\n");
  for (const std::string command :
       {"reduce --config yielding.toml", "update modes.toml --config yielding.toml",
        "twins modes.toml --config yielding.toml", "posterior modes.toml --config yielding.toml",
        "substructures made/record.csv --config yielding.toml",
        "sense made/record.csv --config yielding.toml",
        "identify made/record.csv --config yielding.toml --damping-law auto"}) {
    const Outcome outcome = place_.run(command);
    EXPECT_EQ(outcome.code, 2) << command;
    EXPECT_THAT(outcome.err, HasSubstr("takes linear storeys only; found storey 1 bouc_wen")) << command;
    EXPECT_THAT(outcome.err, HasSubstr("yielding.toml:8")) << command;
  }
  EXPECT_THAT(place_.run("identifiability --config yielding.toml --model sdof").err,
              HasSubstr("Expected [model] name = \"beam\""));
  EXPECT_THAT(place_.run("identifiability --config yielding.toml --reduction modal_truncation").err,
              HasSubstr("is not reduced"));
}

}  // namespace
}  // namespace beamid::apps::storey_laws_test
