// JSON read back: what is no JSON is refused at its place, in beamid's own words.
#include "experiments/text/toml_table.hpp"

#include <gtest/gtest.h>

#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::json_file_test {
namespace {

std::string error_of(const std::string& text) {
  const TemporaryFile file("results.json", text);
  return input_error_of(file, [&] { read_json(file.path(), "results"); });
}

TEST(JsonFile, IsReadInItsOrder) {
  const TemporaryFile file("results.json", "{\"b\": 1, \"a\": [2.5, \"ξ\"]}");
  EXPECT_EQ(read_json(file.path(), "results").dump(), "{\"b\":1,\"a\":[2.5,\"ξ\"]}");
}

TEST(JsonFile, IsRefusedWhereItIsNone) {
  EXPECT_EQ(error_of("{\"a\": 1,\n \"b\": }"), "results.json:2:7: no JSON; expected results");
  EXPECT_EQ(error_of("[1, 2]"), "results.json: no JSON object; expected results");
  EXPECT_EQ(error_of("{\"a\": 1e999}"), "results.json: a number beyond double precision; expected results");
  EXPECT_EQ(error_of("{"), "results.json:1:2: no JSON; expected results");
}

// 100,000 nested brackets overflowed the stack of whoever walked through them.
TEST(JsonFile, IsRefusedWhereItNestsWithoutEnd) {
  const std::string deep = "{\"a\":" + std::string(100000, '[') + std::string(100000, ']') + "}";
  EXPECT_EQ(error_of(deep), "results.json: JSON of more than 64 levels; expected results");
  EXPECT_EQ(error_of("{\"a\":" + std::string(60, '[') + std::string(60, ']') + "}"), "no error");
}

// 1e92 as a count was whatever the conversion made of it.
TEST(JsonFile, HoldsWholeNumbersOrIsRefused) {
  const auto read = [](const char* text) {
    try {
      return std::to_string(whole_number(nlohmann::json::parse(text), "steps", 0, 1000));
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(read("0"), "0");
  EXPECT_EQ(read("1000"), "1000");
  EXPECT_EQ(read("1001"), "steps is 1001; expected a whole number from 0 to 1000");
  EXPECT_EQ(read("-1"), "steps is -1; expected a whole number from 0 to 1000");
  EXPECT_EQ(read("18446744073709551615"),
            "steps is 18446744073709551615; expected a whole number from 0 to 1000");
  EXPECT_EQ(read("1e92"), "steps is 1e+92; expected a whole number from 0 to 1000");
  EXPECT_EQ(read("2.5"), "steps is 2.5; expected a whole number from 0 to 1000");
  EXPECT_EQ(read("[3]"), "steps is array; expected a whole number from 0 to 1000");
}

}  // namespace
}  // namespace beamid::experiments::json_file_test
