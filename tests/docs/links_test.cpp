// Every link of README, CONTRIBUTING and docs/ leads to a file that is there, and to a heading that it has.
// Pages of theory end with the sources and the commands of their subject, and rows of a table have its number
// of cells.
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

TEST(TheoryPages, EndWithSourcesThatAreThereAndCommands) {
  static const std::regex path("`((fem|filters|reduction|experiments|apps|tests)/[A-Za-z0-9_/.]+)`");
  std::vector<std::string> wrong;
  for (const auto& entry : fs::directory_iterator(source("docs/theory"))) {
    const std::string text = contents(entry.path()), name = entry.path().filename().string();
    const std::size_t sources = text.find("\n## Where in the code\n"),
                      commands = text.find("\n## Commands\n");
    if (commands == std::string::npos || sources > commands ||
        text.find("\n## ", commands + 1) != std::string::npos) {
      wrong.push_back(name + ": expected 'Where in the code' and 'Commands' at its end");
      continue;
    }
    const std::string listed = text.substr(sources, commands - sources);
    for (std::sregex_iterator one(listed.begin(), listed.end(), path), end; one != end; ++one)
      if (!fs::exists(source((*one)[1].str()))) wrong.push_back(name + ": no " + one->str());
  }
  EXPECT_THAT(wrong, testing::IsEmpty());
}

/// A row "| a | b |" has three bars; one behind a backslash is text.
TEST(Tables, HaveRowsOfEqualLength) {
  std::vector<std::string> uneven;
  for (const fs::path& page : markdown_pages()) {
    const std::vector<std::string> lines = lines_of(contents(page));
    bool fenced = false;
    long of_head = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      fenced ^= lines[i].rfind("```", 0) == 0;
      if (fenced || lines[i].empty() || lines[i][0] != '|') {
        of_head = 0;
        continue;
      }
      const std::string row = std::regex_replace(lines[i], std::regex(R"(\\\|)"), "");
      const long bars = std::count(row.begin(), row.end(), '|');
      if (of_head == 0) of_head = bars;
      if (bars != of_head)
        uneven.push_back(fmt::format("{}:{}", page.lexically_relative(source(".")).string(), i + 1));
    }
  }
  EXPECT_THAT(uneven, testing::IsEmpty());
}

TEST(Links, NameHeadingsAsForgesDo) {
  EXPECT_EQ(anchor_of("What `it` shows, and [why](a.md)"), "what-it-shows-and-why");
}

}  // namespace
}  // namespace beamid::docs::links_test
