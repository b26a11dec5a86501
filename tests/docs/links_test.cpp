// Every link of README, CONTRIBUTING and docs/ leads to a file that is there, and to a heading that it has.
#include <gmock/gmock.h>

#include <set>

#include "tests/docs/prose.hpp"

namespace beamid::docs::links_test {
namespace {

/// "## What `it` shows, and why" is #what-it-shows-and-why, as forges and the site have it.
std::string anchor_of(const std::string& heading) {
  static const std::regex address(R"(\]\([^)]*\))");
  std::string anchor;
  for (const unsigned char c : std::regex_replace(heading, address, "]"))
    if (c == ' ')
      anchor += '-';
    else if (std::isalnum(c) || c == '-' || c == '_' || c > 127)
      anchor += char(std::tolower(c));
  return anchor;
}

std::set<std::string> anchors_of(const fs::path& page) {
  std::set<std::string> anchors;
  bool fenced = false;
  for (const std::string& line : lines_of(contents(page))) {
    fenced ^= line.rfind("```", 0) == 0;
    const std::size_t level = line.find_first_not_of('#');
    if (!fenced && level != std::string::npos && level > 0 && line[level] == ' ')
      anchors.insert("#" + anchor_of(line.substr(level + 1)));
  }
  return anchors;
}

TEST(Links, LeadToFilesAndHeadingsThatAreThere) {
  static const std::regex link(R"(\]\(([^)#: ]*)(#[^) ]*)?\))");
  std::vector<std::string> broken;
  std::size_t checked = 0;
  for (const fs::path& page : markdown_pages()) {
    const std::string text = contents(page);
    for (std::sregex_iterator one(text.begin(), text.end(), link), end; one != end; ++one, ++checked) {
      const fs::path target =
          one->length(1) == 0 ? page : (page.parent_path() / (*one)[1].str()).lexically_normal();
      const bool heading_there = one->length(2) == 0 || target.extension() != ".md" ||
                                 anchors_of(target).count((*one)[2].str()) == 1;
      if (!fs::exists(target) || !heading_there)
        broken.push_back(page.lexically_relative(source(".")).string() + ": " + one->str());
    }
  }
  EXPECT_THAT(broken, testing::IsEmpty());
  EXPECT_GT(checked, 50u);
}

TEST(Links, NameHeadingsAsForgesDo) {
  EXPECT_EQ(anchor_of("What `it` shows, and [why](a.md)"), "what-it-shows-and-why");
}

}  // namespace
}  // namespace beamid::docs::links_test
