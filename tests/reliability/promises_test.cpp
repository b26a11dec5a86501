// docs/reliability.md names tests that exist. Oracle: the sources.
#include <gmock/gmock.h>

#include <regex>

#include "tests/apps/run_command.hpp"

namespace beamid::reliability::promises_test {
namespace {

TEST(Promises, AreHeldByTestsThatExist) {
  std::string sources;
  for (const auto& entry : apps::fs::recursive_directory_iterator(apps::source("tests")))
    if (entry.path().extension() == ".cpp") sources += apps::contents(entry.path());
  const std::string page = apps::contents(apps::source("docs/reliability.md"));
  static const std::regex name(R"(`([A-Z]\w*)\.([A-Z]\w*)`)");
  std::size_t count = 0;
  for (std::sregex_iterator one(page.begin(), page.end(), name), end; one != end; ++one, ++count)
    EXPECT_THAT(sources, testing::HasSubstr("(" + (*one)[1].str() + ", " + (*one)[2].str() + ")"));
  EXPECT_GT(count, 20u);
}

}  // namespace
}  // namespace beamid::reliability::promises_test
