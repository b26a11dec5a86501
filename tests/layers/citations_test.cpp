// Every source cited in the code and in the pages can be looked up in docs/references.md, which lists it once
// and in its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <sstream>

#include "tests/layers/source_files.hpp"

namespace beamid::layers::citations_test {
namespace {

/// Keys such as julier2004 in a text that cites them as "[julier2004]" or "[julier2004, eq. 3]".
std::set<std::string> cited_keys(const std::string& text) {
  static const std::regex citation(R"re(\[([a-z]+[0-9]{4}[a-z]?)[,\]])re");
  std::set<std::string> keys;
  for (std::sregex_iterator match(text.begin(), text.end(), citation), end; match != end; ++match)
    keys.insert((*match)[1]);
  return keys;
}

/// Keys that stand, between backquotes, in the first column of a table.
std::set<std::string> listed_keys(const std::string& text) {
  static const std::regex row(R"re(\| `([a-z0-9]+)` \|)re");
  std::set<std::string> keys;
  for (std::sregex_iterator match(text.begin(), text.end(), row), end; match != end; ++match)
    keys.insert((*match)[1]);
  return keys;
}

class Folder : public testing::TestWithParam<const char*> {};

// Oracle: the first column of the tables of docs/references.md.
TEST_P(Folder, CitesOnlySourcesThatAreListed) {
  const std::set<std::string> listed = listed_keys(text_of("docs/references.md"));
  ASSERT_FALSE(listed.empty());
  for (const std::string& file : sources_below(GetParam()))
    for (const std::string& key : cited_keys(text_of(file)))
      EXPECT_TRUE(listed.contains(key))
          << file << " cites [" << key << "]; docs/references.md does not list it";
}

INSTANTIATE_TEST_SUITE_P(Project, Folder,
                         testing::Values("fem", "filters", "reduction", "experiments", "apps"),
                         [](const auto& tested) { return std::string(tested.param); });

// Oracle: the same, for the pages themselves.
TEST(Pages, CiteOnlySourcesThatAreListed) {
  const std::set<std::string> listed = listed_keys(text_of("docs/references.md"));
  std::size_t cited = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(BEAMID_SOURCE_DIR "/docs")) {
    if (entry.path().extension() != ".md") continue;
    const std::string page = std::filesystem::relative(entry.path(), BEAMID_SOURCE_DIR).string();
    for (const std::string& key : cited_keys(text_of(page))) {
      EXPECT_TRUE(listed.contains(key)) << page << " cites [" << key << "]";
      ++cited;
    }
  }
  EXPECT_GT(cited, 100u);
}

TEST(References, AreListedOnceAndInOrderUnderTheirHeading) {
  static const std::regex row(R"re(\| `([a-z0-9]+)` \| .+ \|)re");
  std::istringstream page(text_of("docs/references.md"));
  std::set<std::string> seen;
  std::string before;
  for (std::string line; std::getline(page, line);) {
    std::smatch match;
    if (line.starts_with("## ")) before.clear();
    if (!std::regex_match(line, match, row)) continue;
    EXPECT_LT(before, match[1].str());
    EXPECT_TRUE(seen.insert(match[1]).second) << match[1] << " is listed twice";
    before = match[1];
  }
  EXPECT_GT(seen.size(), 100u);
}

// Oracle: paper.bib gives every key that paper.md cites as [@key], and no other.
TEST(Paper, CitesWhatItsBibliographyLists) {
  static const std::regex citation("@([a-z]+[0-9]*[a-z]*)"), entry(R"re(@[a-z]+\{([a-z0-9]+),)re");
  const auto keys = [](const std::string& text, const std::regex& pattern) {
    std::set<std::string> found;
    for (std::sregex_iterator one(text.begin(), text.end(), pattern), end; one != end; ++one)
      found.insert((*one)[1]);
    return found;
  };
  EXPECT_EQ(keys(text_of("paper.md"), citation), keys(text_of("paper.bib"), entry));
}

TEST(CitedKeys, AreFoundWithAndWithoutAPlace) {
  EXPECT_THAT(cited_keys("[hairer1996, ch. IV.3] and [bucy1968], not K[2009] or [1 2]"),
              testing::ElementsAre("bucy1968", "hairer1996"));
}

}  // namespace
}  // namespace beamid::layers::citations_test
