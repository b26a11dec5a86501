// What users include: each component's header leads into that component alone, and every type that they meet
// says what it is. Oracle: the sources' own text.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/layers/include_rules.hpp"
#include "tests/layers/source_files.hpp"

namespace beamid::layers::public_headers_test {
namespace {

using testing::ElementsAre, testing::IsEmpty;

const std::string shipped = "apps/package/include/beamid";

/// What the shipped headers reach by their includes (docs/decisions/0007-public-headers.md).
std::set<std::string> public_headers() {
  std::vector<std::string> waiting = sources_below(shipped);
  for (const std::string& file : sources_below("tests/include")) waiting.push_back(file);
  std::set<std::string> reached(waiting.begin(), waiting.end());
  while (!waiting.empty()) {
    const std::string file = waiting.back();
    waiting.pop_back();
    for (const Include& include : includes_of(text_of(file)))
      if (include.quoted && !include.target.starts_with("beamid/") && reached.insert(include.target).second)
        waiting.push_back(include.target);
  }
  return reached;
}

/// Types at the beginning of a line that no comment stands above.
std::vector<std::string> types_without_comment(const std::string& text) {
  static const std::regex type(R"(^(?:struct|class|enum class) (\w+)[^;]*$)");
  std::vector<std::string> found;
  std::istringstream lines(text);
  std::string before;
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, type) && !before.starts_with("///")) found.push_back(match[1]);
    if (!line.starts_with("template")) before = line;
  }
  return found;
}

TEST(PublicHeaders, HaveOneForEachComponentThatLeadsIntoItAlone) {
  std::set<std::string> components;
  for (const std::string& file : sources_below(shipped)) {
    const std::string component = std::filesystem::path(file).stem().string();
    components.insert(component);
    for (const Include& include : includes_of(text_of(file)))
      EXPECT_TRUE(include.target.starts_with(component + "/")) << file << " includes " << include.target;
  }
  EXPECT_THAT(components, ElementsAre("apps", "experiments", "fem", "filters", "reduction"));
}

TEST(PublicHeaders, SayWhatEachOfTheirTypesIs) {
  const std::set<std::string> headers = public_headers();
  EXPECT_TRUE(headers.contains("filters/filter.hpp"));
  EXPECT_FALSE(headers.contains("filters/batch_avx2.hpp"));
  for (const std::string& file : headers)
    EXPECT_THAT(types_without_comment(text_of(file)), IsEmpty()) << file;
}

TEST(TypesWithoutComment, AreFoundBelowTemplatesToo) {
  EXPECT_THAT(types_without_comment(
                  "/// One.\nstruct A {\n\nstruct B {\nclass C;\n/// Two.\ntemplate <class T>\nclass "
                  "D {\nenum class E { a };\nclass F final\n"),
              ElementsAre("B", "F"));
}

}  // namespace
}  // namespace beamid::layers::public_headers_test
