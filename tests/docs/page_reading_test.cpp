// How a page is read, and what of an output it may print.
#include <gmock/gmock.h>

#include "tests/docs/page.hpp"
#include "tests/docs/printed_output.hpp"

namespace beamid::docs::page_reading_test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::SizeIs;

Page page(const std::string& text) {
  return Page(lines_of(text));
}

TEST(PageReading, FindsCommandsAndOutputsWithTheirLines) {
  const Page read = page("Text\n\n    cd a\n    beamid list\n\n```\nit\n```\n\n```toml\nx = 1\n```\n");
  ASSERT_THAT(read.blocks(), SizeIs(2));
  EXPECT_EQ(read.blocks()[0].kind, Block::Kind::command);
  EXPECT_EQ(read.blocks()[0].line, 3);
  EXPECT_THAT(read.blocks()[0].text, ElementsAre("cd a", "beamid list"));
  EXPECT_EQ(read.blocks()[1].kind, Block::Kind::output);
  EXPECT_THAT(read.blocks()[1].text, ElementsAre("it"));
}

TEST(PageReading, AppliesACommentToTheNextBlockOnly) {
  const Page read = page(
      "<!-- exit code: 3 -->\n    a\n\n    b\n\n<!-- long: 9 s -->\n    c\n<!-- not run: why -->\n    d\n");
  ASSERT_THAT(read.blocks(), SizeIs(4));
  EXPECT_EQ(read.blocks()[0].exit_code, 3);
  EXPECT_EQ(read.blocks()[1].exit_code, 0);
  EXPECT_TRUE(read.blocks()[2].is_long);
  EXPECT_TRUE(read.blocks()[3].skipped);
  EXPECT_FALSE(read.blocks()[3].is_long);
}

TEST(PageReading, TakesCommandsThatTheReaderDoesNotSee) {
  const Page read = page("<!-- run: touch a -->\n");
  ASSERT_THAT(read.blocks(), SizeIs(1));
  EXPECT_THAT(read.blocks()[0].text, ElementsAre("touch a"));
}

TEST(PageReading, RefusesACommentThatItDoesNotKnow) {
  EXPECT_THROW(page("<!-- lnog: 9 s -->\n"), std::invalid_argument);
}

TEST(PrintedOutput, PartsFragmentsAtDots) {
  const auto parts = fragments({"a", "", "...", "", "b", "..."}, 10);
  ASSERT_THAT(parts, SizeIs(2));
  EXPECT_THAT(parts[0].text, ElementsAre("a"));
  EXPECT_THAT(parts[1].text, ElementsAre("b"));
  EXPECT_EQ(parts[1].line, 14);
}

TEST(PrintedOutput, IsFoundInTheLatestOutputThatHasIt) {
  const Place place =
      best_place({"K 1.0", "C 2.0"}, {{"K 1.0", "C 2.0"}, {"x", "K 1.0", "C 2.0"}, {"K 1.0"}});
  EXPECT_EQ(place.output, 1);
  EXPECT_EQ(place.line, 1);
}

TEST(PrintedOutput, NamesLinesOfThePageThatDiffer) {
  const std::vector<std::string> output{"K 1.0", "C 2.5", "end"};
  EXPECT_EQ(disagreement({7, {"K 1.0", "C 2.5"}}, output, 0, 1), "");
  EXPECT_THAT(disagreement({7, {"K 1.0", "C 2.7"}}, output, 0, 1),
              HasSubstr("line 8\n    printed C 2.7\n    found   C 2.5"));
  EXPECT_THAT(disagreement({7, {"end", "C 2.7"}}, output, 2, 1), HasSubstr("found   (the end)"));
}

}  // namespace
}  // namespace beamid::docs::page_reading_test
