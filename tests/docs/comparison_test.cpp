// What the comparison with golden outputs lets pass, and what not.
#include <gmock/gmock.h>

#include "tests/docs/golden_case.hpp"

namespace beamid::docs::comparison_test {
namespace {

using testing::ElementsAre, testing::IsEmpty;

std::vector<std::string> differences(const char* golden, const char* found, std::vector<Looser> looser = {}) {
  return JsonComparison(std::move(looser))(json::parse(golden), json::parse(found));
}

TEST(JsonComparison, LetsRoundingPass) {
  EXPECT_THAT(differences(R"({"a": [1.0, 1e-20]})", R"({"a": [1.0000009, 0]})"), IsEmpty());
}

TEST(JsonComparison, NamesPathGoldenAndFound) {
  EXPECT_THAT(differences(R"({"runs": [{"k": 500.0}]})", R"({"runs": [{"k": 500.001}]})"),
              ElementsAre("/runs/0/k: golden 500.0, found 500.001"));
}

TEST(JsonComparison, NamesKeysThatCameAndWent) {
  EXPECT_THAT(differences(R"({"old": 1})", R"({"new": null})"),
              ElementsAre("/old: golden 1, found nothing", "/new: golden nothing, found null"));
}

TEST(JsonComparison, ComparesCountsAndKindsExactly) {
  EXPECT_THAT(differences(R"([10000000, true])", R"([10000001, 1])"),
              ElementsAre("/0: golden 10000000, found 10000001", "/1: golden true, found 1"));
  EXPECT_THAT(differences("[1, 2]", "[1]"), ElementsAre(": golden 2 items, found 1 items"));
}

TEST(JsonComparison, IsLooserWhereAReasonIsGiven) {
  EXPECT_THAT(
      differences(R"({"share": 0.10, "k": 1.0})", R"({"share": 0.11, "k": 1.1})",
                  read_looser(json::parse(R"([{"where": "share", "relative": 0.2, "reason": "random"}])"))),
      ElementsAre("/k: golden 1.0, found 1.1"));
  EXPECT_THROW(read_looser(json::parse(R"([{"where": "share", "relative": 0.2}])")), json::exception);
}

TEST(JsonComparison, ComparesNumbersWithinMessages) {
  EXPECT_THAT(differences(R"(["K is 3.14 N/m"])", R"(["K is 3.15 N/m"])"), IsEmpty());
  EXPECT_THAT(differences(R"(["K is 3.14 N/m"])", R"(["K is 3.16 N/m"])"), testing::SizeIs(1));
}

TEST(TextComparison, LetsTheLastDigitPassAndTheWidthOfColumns) {
  EXPECT_THAT(text_differences("K  3.14\n---  ----\n", "K      3.15\n---- -----\n", {}), IsEmpty());
  EXPECT_THAT(text_differences("K  3.14\n", "K  3.16\n", {}),
              ElementsAre("line 1: golden\n  K  3.14\nfound\n  K  3.16"));
}

TEST(TextComparison, ComparesWordsAndCountsExactly) {
  EXPECT_THAT(text_differences("12 of 15\nconverged\n", "13 of 15\ndiverged\nmore\n", {}),
              testing::SizeIs(3));
}

TEST(TextComparison, KnowsTheLastDigitOfPowers) {
  EXPECT_DOUBLE_EQ(last_digit("+1.23e-07"), 1e-9);
  EXPECT_DOUBLE_EQ(last_digit("3e-12"), 1e-12);
  EXPECT_DOUBLE_EQ(last_digit("-3.10"), 0.01);
  EXPECT_DOUBLE_EQ(last_digit("310"), 0);
}

TEST(Rounded, KeepsNineDigitsAndCounts) {
  EXPECT_EQ(rounded(json::parse("[0.12345678949, 12345678901, null]")).dump(),
            "[0.123456789,12345678901,null]");
}

}  // namespace
}  // namespace beamid::docs::comparison_test
