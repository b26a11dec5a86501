// beamid twins, end to end: what a user gets where the list is not proven.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::twins_test {
namespace {

using nlohmann::json, testing::HasSubstr;

// Two halves of a beam that is pinned at both ends, 80 and 110 N m2. Oracle: turned round it is the same
// beam, so that 110 and 80 have the same frequencies; those are of an independent finite-element model.
class TwoHalves : public testing::Test {
 protected:
  TwoHalves() {
    place_.write(
        "beam.toml",
        "[beam]\nlength_m = 1\nbending_stiffness_n_m2 = 100\nmass_per_length_kg_per_m = 2\n"
        "elements = 20\nsupport = \"pinned-pinned\"\n"
        "[[parameters]]\nquantity = \"bending_stiffness\"\nname = \"left\"\nfrom_m = 0\nto_m = 0.5\n"
        "[[parameters]]\nquantity = \"bending_stiffness\"\nname = \"right\"\nfrom_m = 0.5\nto_m = 1\n");
    std::string modes;
    for (const char* const hz : {"10.6837", "43.1399", "96.3133"})
      modes += std::string("[[modes]]\nfrequency_hz = ") + hz + "\nfrequency_relative_deviation = 0.001\n";
    place_.write("modes.toml", modes);
  }
  Outcome run(const std::string& options) {
    return place_.run("twins modes.toml --config beam.toml --model-error 0.05 " + options);
  }
  Workplace place_;
};

TEST_F(TwoHalves, AreFoundEitherWayRound) {
  EXPECT_THAT(run("").out, testing::StartsWith("2 sets of parameters explain these modes equally well."));
}

TEST_F(TwoHalves, AreNotClaimedToBeTheOnlySetAfterOneSearch) {
  const Outcome outcome = run("--starts 1");
  EXPECT_THAT(outcome.out, testing::StartsWith(
                               "One set of parameters explains the modes, as far as so few starts can show"));
  const json found = json_of(run("--starts 1 --json"));
  EXPECT_EQ(found["messages"][0]["severity"], "warning");
}

}  // namespace
}  // namespace beamid::apps::twins_test
