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

// A strain gauge at the free end reads noise alone. Oracle: the record without it.
TEST(UnknownForce, IsFoundBesideAGaugeThatNothingStrains) {
  Workplace place;
  std::string mast = contents(source("docs/tutorials/24_virtual_sensing/mast.toml"));
  const std::string gauge = "position_m = 0.5\n";
  mast.replace(mast.find(gauge), gauge.size(), "position_m = 2.0\n");
  place.write("mast.toml", mast);
  place.write("without.toml", contents(source("docs/tutorials/24_virtual_sensing/accelerometers.toml")));
  const json with = json_of(place.run("sense --config mast.toml --json"))["tables"]["sensed"],
             without = json_of(place.run("sense --config without.toml --json"))["tables"]["sensed"];
  ASSERT_EQ(with.size(), 3);
  for (std::size_t i = 0; i < with.size(); ++i)
    for (const char* const of : {"root_mean_square", "reported_error"})
      EXPECT_NEAR(with[i][of].get<double>() / without[i][of].get<double>(), 1.0, 1e-5) << with[i]["name"];
}

}  // namespace
}  // namespace beamid::apps::sense_test
