// The README stays short and true where it counts or copies.
#include <gmock/gmock.h>

#include "tests/docs/prose.hpp"

namespace beamid::docs::readme_test {
namespace {

using testing::HasSubstr;

const std::string readme = contents(source("README.md"));

TEST(Readme, HasAtMost150LinesAndItsPictureOnTheFirstScreen) {
  const auto lines = lines_of(readme);
  EXPECT_LE(lines.size(), 150u);
  const auto picture = std::find_if(lines.begin(), lines.end(),
                                    [](const std::string& line) { return line.rfind("![", 0) == 0; });
  EXPECT_LE(picture - lines.begin(), 20);
}

// A page as `beamid report --png` writes it; the size stands in the head of a PNG file.
TEST(Readme, HasAPictureOfAPageThatIsSmall) {
  const std::string picture = contents(source("docs/images/overview.png"));
  ASSERT_EQ(picture.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_LE(picture.size(), 150'000u);
  EXPECT_EQ(picture.substr(16, 8), std::string("\0\0\x03\xc0\0\0\x03\xa0", 8));  // 960 x 928
  EXPECT_THAT(readme, HasSubstr("beamid report tower --png overview.png"));
}

TEST(Readme, BeginsWithTheTwoCommandsOfSetUp) {
  EXPECT_LT(readme.find("./bootstrap paper "), readme.find("./bootstrap test "));
  EXPECT_LT(readme.find("./bootstrap test "), 300u);
}

std::string without_blanks(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isspace(c); });
  return text;
}

/// The first block of C++ of a page.
std::string shown_code(const std::string& page) {
  const std::size_t from = page.find("```cpp\n") + 7;
  return without_blanks(page.substr(from, page.find("```", from) - from));
}

// Oracle: the source that both copy.
TEST(Readme, AndContributingShowADiscretisationAsItIs) {
  const std::string code = without_blanks(contents(source("filters/schemes/forward_euler.cpp")));
  EXPECT_THAT(code, HasSubstr(shown_code(readme)));
  EXPECT_EQ(code, shown_code(contents(source("CONTRIBUTING.md"))));
}

}  // namespace
}  // namespace beamid::docs::readme_test
