// Test files are compiled several as one unit, so that none may see the helpers of another. Oracle: the
// files' own names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "tests/layers/source_files.hpp"

namespace beamid::layers::test_namespaces_test {
namespace {

using testing::ElementsAre, testing::IsEmpty;

/// Namespaces that a text opens at the beginning of a line, the nameless one as "".
std::vector<std::string> namespaces_of(const std::string& text) {
  static const std::regex opening(R"((?:^|\n)namespace ?([\w:]*) \{)");
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), opening), end; match != end; ++match)
    found.push_back((*match)[1]);
  return found;
}

TEST(TestFiles, HaveANamelessNamespaceInOneOfTheirOwnName) {
  std::map<std::string, std::string> file_of_name;  // by program/name
  for (const std::string& file : sources_below("tests")) {
    if (!file.ends_with("_test.cpp")) continue;
    const std::string name = std::filesystem::path(file).stem().string();
    const std::vector<std::string> found = namespaces_of(text_of(file));
    ASSERT_GE(found.size(), 2u) << file;
    EXPECT_TRUE(found.end()[-2].ends_with("::" + name)) << file << ": namespace " << found.end()[-2];
    EXPECT_THAT(found.end()[-1], IsEmpty()) << file;
    const std::string program = file.substr(0, file.find('/', std::string("tests/").size()));
    const auto [other, is_new] = file_of_name.try_emplace(program + "/" + name, file);
    EXPECT_TRUE(is_new) << file << " and " << other->second << ": one program, one name";
  }
  EXPECT_FALSE(file_of_name.empty());
}

TEST(TestFiles, ShowTheNamespacesTheyOpen) {
  EXPECT_THAT(namespaces_of("#include <a>\n\nnamespace b::c {\nnamespace {\nint namespace_d;\n}\n}\n"),
              ElementsAre("b::c", ""));
}

}  // namespace
}  // namespace beamid::layers::test_namespaces_test
