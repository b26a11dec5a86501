// beamid sense and identify under a force nobody measured, end to end: what a user gets.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::sense_test {
namespace {

using nlohmann::json, testing::HasSubstr;

// Oracle: the two commands ask the same record the same, and the mast it was simulated from.
TEST(UnknownForce, IsNoObstacleToIdentify) {
  Workplace place;
  fs::copy(source("docs/tutorials/24_virtual_sensing/mast.toml"), place.folder() / "mast.toml");
  ASSERT_EQ(place.run("simulate --config mast.toml --out shaken").code, 0);
  const json sensed = json_of(place.run("sense shaken/record.csv --config mast.toml --json"));
  const json identified = json_of(place.run("identify shaken/record.csv --config mast.toml --json"));
  EXPECT_EQ(identified["command"], "identify");
  EXPECT_EQ(identified["tables"], sensed["tables"]);
  EXPECT_EQ(identified["status"], sensed["status"]);
  const Outcome compared = place.run("compare shaken/record.csv --config mast.toml");
  EXPECT_EQ(compared.code, 2);
  EXPECT_THAT(compared.err, HasSubstr("[[unknown_forces]] are followed by beamid identify"));
}

}  // namespace
}  // namespace beamid::apps::sense_test
