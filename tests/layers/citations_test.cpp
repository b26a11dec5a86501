// Every source cited in the code can be looked up in docs/references.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

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

TEST(CitedKeys, AreFoundWithAndWithoutAPlace) {
  EXPECT_THAT(cited_keys("[hairer1996, ch. IV.3] and [bucy1968], not K[2009] or [1 2]"),
              testing::ElementsAre("bucy1968", "hairer1996"));
}

}  // namespace
}  // namespace beamid::layers::citations_test
