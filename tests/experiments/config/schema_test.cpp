// What a row of a schema makes of a file. Oracles: the values and the rules written here.
#include "experiments/config/schema.hpp"

#include <gmock/gmock.h>

#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::schema_test {
namespace {

using testing::ElementsAre;

enum class Colour { red, green };

struct Thing {
  double length = 2.0;
  std::optional<double> width;
  int count = 3;
  std::uint64_t seed = 1;
  bool loud = false;
  std::string name = "thing";
  std::vector<std::string> friends;
  std::optional<std::vector<double>> weights;
  std::pair<double, double> span{0.0, 1.0};
  std::optional<Colour> colour;
};

Schema<Thing> thing_keys() {
  Schema<Thing> keys("thing");
  keys.key("length_m", &Thing::length, positive, "how long", "1.5")
      .key("width_m", &Thing::width, {.least = 0.0, .most = 1.0, .below = true}, "how wide", "0.5")
      .excludes({"loud"})
      .key("count", &Thing::count, {1, 10}, "how many", "4")
      .key("seed", &Thing::seed, {0, 100}, "of the noise", "7")
      .key("loud", &Thing::loud, "whether it is", "true")
      .key("name", &Thing::name, "its name", "\"a\"")
      .key("friends", &Thing::friends, "their names", "[\"a\"]")
      .key("weights", &Thing::weights, not_negative, "one or more", "[1.0]")
      .key("span_s", &Thing::span, "from, to", "[0.0, 2.0]")
      .choice("colour", &Thing::colour, {std::pair{"red", Colour::red}, {"green", Colour::green}}, "of it",
              "\"red\"");
  return keys;
}

Thing read(const std::string& text) {
  return thing_keys().read(TomlTable::parse("[thing]\n" + text, "a.toml").table("thing"));
}

std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Schema, ReadsAMemberOfEveryType) {
  const Thing thing = read(
      "length_m = 1.5\nwidth_m = 0.25\ncount = 4\nseed = 9\nname = \"x\"\nfriends = [\"a\", \"b\"]\n"
      "weights = [1, 2]\nspan_s = [3, 4]\ncolour = \"green\"\n");
  EXPECT_EQ(thing.length, 1.5);
  EXPECT_EQ(thing.width, 0.25);
  EXPECT_EQ(thing.count, 4);
  EXPECT_EQ(thing.seed, 9u);
  EXPECT_EQ(thing.name, "x");
  EXPECT_THAT(thing.friends, ElementsAre("a", "b"));
  EXPECT_THAT(*thing.weights, ElementsAre(1.0, 2.0));
  EXPECT_EQ(thing.span, std::pair(3.0, 4.0));
  EXPECT_EQ(thing.colour, Colour::green);
  EXPECT_TRUE(read("loud = true\n").loud);
}

TEST(Schema, LeavesWhatAFileDoesNotSayAtTheMembersOwnDefault) {
  const Thing thing = read("");
  EXPECT_EQ(thing.length, 2.0);
  EXPECT_EQ(thing.count, 3);
  EXPECT_FALSE(thing.width || thing.weights || thing.colour);
  EXPECT_EQ(thing_keys().find("length_m")->fallback, "`2`");
  EXPECT_EQ(thing_keys().find("width_m")->fallback, "none");
  EXPECT_EQ(thing_keys().find("name")->fallback, "`\"thing\"`");
  EXPECT_EQ(thing_keys().find("span_s")->fallback, "`[0, 1]`");
}

TEST(Schema, RefusesAWrongTypeAtTheValuesPlace) {
  EXPECT_EQ(refusal("length_m = \"long\"\n"),
            "a.toml:2:12: thing.length_m is the text \"long\"; expected a positive number");
  EXPECT_EQ(refusal("count = 1.5\n"), "a.toml:2:9: thing.count is 1.5; expected a whole number from 1 to 10");
  EXPECT_EQ(refusal("colour = 3\n"), "a.toml:2:10: thing.colour is 3; expected one of the texts red, green");
}

TEST(Schema, RefusesANumberOutOfItsRange) {
  EXPECT_EQ(refusal("\nlength_m = 0\n"), "a.toml:3:12: thing.length_m is 0; expected a positive number");
  EXPECT_EQ(refusal("width_m = 1\n"), "a.toml:2:11: thing.width_m is 1; expected a number from 0 to below 1");
  EXPECT_EQ(refusal("width_m = -1\n"),
            "a.toml:2:11: thing.width_m is -1; expected a number from 0 to below 1");
  EXPECT_EQ(refusal("seed = 101\n"), "a.toml:2:8: thing.seed is 101; expected a whole number from 0 to 100");
  EXPECT_EQ(refusal("weights = [1, -1]\n"),
            "a.toml:2:15: thing.weights holds -1; expected zero or a positive number");
  EXPECT_EQ(refusal("colour = \"blue\"\n"),
            "a.toml:2:10: thing.colour is the text \"blue\"; expected one of red, green");
}

TEST(Schema, RefusesAKeyThatAnotherOneExcludes) {
  EXPECT_EQ(refusal("width_m = 0.5\nloud = true\n"),
            "a.toml:3:1: thing.loud has no use beside width_m; expected one or the other, or no loud");
}

TEST(Schema, LetsAKeySetFromOutsideReplaceThoseThatCannotStandBesideIt) {
  EXPECT_THAT(thing_keys().rivals("width_m"), ElementsAre("loud"));
  EXPECT_THAT(thing_keys().rivals("loud"), ElementsAre("width_m"));
  EXPECT_THAT(thing_keys().rivals("length_m"), ElementsAre());
}

TEST(Schema, AsksForWhatATableCannotDoWithout) {
  struct Point {
    double x = 0.0, from = 0.0, to = 1.0;
  };
  Schema<Point> keys("point");
  keys.key("x_m", &Point::x, on_beam, "where", "1")
      .required()
      .key("from_m", &Point::from, "begin", "0")
      .key("to_m", &Point::to, {.greater_than = "from_m"}, "end", "1");
  const auto error_of = [&](const std::string& text) -> std::string {
    try {
      keys.read(TomlTable::parse("[point]\n" + text, "a.toml").table("point"), 2.0);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  const std::string range = "expected a number from 0 to the beam's length, 2";
  EXPECT_EQ(error_of(""), "a.toml:1:1: point.x_m is missing; " + range);
  EXPECT_EQ(error_of("x_m = 3\n"), "a.toml:2:7: point.x_m is 3; " + range);
  EXPECT_EQ(error_of("x_m = 2\nfrom_m = 4\nto_m = 3\n"),
            "a.toml:4:8: point.to_m is 3; expected a number above from_m, 4");
}

TEST(Schema, TakesTheUnitFromTheEndOfAKeysName) {
  const std::pair<const char*, const char*> units[] = {{"length_m", "m"},
                                                       {"rotational_n_m_per_rad", "N m/rad"},
                                                       {"mass_per_length_kg_per_m", "kg/m"},
                                                       {"quadratic_n_s2_per_m2", "N s2/m2"},
                                                       {"guess_per_s", "1/s"},
                                                       {"youngs_modulus_pa", "Pa"},
                                                       {"from_hz", "Hz"},
                                                       {"guess", ""},
                                                       {"elements", ""},
                                                       {"noise_m_per_m", "m/m"},
                                                       {"bending_stiffness_n_m2", "N m2"},
                                                       {"x_m", "m"}};
  for (const auto& [key, unit] : units) EXPECT_EQ(unit_in_key(key), unit) << key;
}

}  // namespace
}  // namespace beamid::experiments::schema_test
