// The kinds of objection: one list for program, sources and page.
// BEAMID_UPDATE_GOLDEN=1 experiments_tests --gtest_filter='ObjectionKinds.*' writes the table of the page
// anew.
#include "experiments/text/objection.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace beamid::experiments::objection_test {
namespace {

const std::filesystem::path root = BEAMID_SOURCE_DIR;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(ObjectionKinds, AreSortedAndNamedOnce) {
  const auto& all = objection_kinds();
  const auto before = [](const ObjectionKind& a, const ObjectionKind& b) {
    return std::pair(a.of, a.name) < std::pair(b.of, b.name);
  };
  EXPECT_TRUE(std::ranges::is_sorted(all, before));
  for (const ObjectionKind& kind : all)
    EXPECT_EQ(std::ranges::count(all, kind.name, &ObjectionKind::name), 1) << kind.name;
  EXPECT_THROW(Objection("no_such_kind", ""), std::logic_error);
}

// Oracle: the sources that raise them.
TEST(ObjectionKinds, AreRaisedSomewhere) {
  std::string sources;
  for (const char* room : {"experiments", "apps"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / room))
      if (entry.path().extension() == ".cpp" && entry.path().filename() != "objection.cpp")
        sources += text_of(entry.path());
  for (const ObjectionKind& kind : objection_kinds())
    EXPECT_THAT(sources, testing::HasSubstr('"' + kind.name + '"'));
}

TEST(ObjectionKinds, StandOnTheirPage) {
  const std::filesystem::path file = root / "docs/objections.md";
  std::string table;
  for (const ObjectionKind& kind : objection_kinds())
    table += "| `" + kind.name + "` | " + kind.of + " | " + kind.statistic + " | " + kind.meaning + " |\n";
  std::string page = text_of(file);
  const std::string head = "|---|---|---|---|\n";
  const std::size_t from = page.find(head) + head.size(), to = page.find("\n\n", from) + 1;
  if (std::getenv("BEAMID_UPDATE_GOLDEN") != nullptr)
    std::ofstream(file) << page.replace(from, to - from, table);
  else
    EXPECT_EQ(page.substr(from, to - from), table);
}

}  // namespace
}  // namespace beamid::experiments::objection_test
