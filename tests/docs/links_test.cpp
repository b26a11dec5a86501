// Every link of README, CONTRIBUTING and docs/ to a file leads to one.
#include <gmock/gmock.h>

#include "tests/docs/compare_numbers.hpp"
#include "tests/docs/shell.hpp"

namespace beamid::docs::links_test {
namespace {

std::vector<fs::path> markdown_pages() {
  std::vector<fs::path> pages{source("README.md"), source("CONTRIBUTING.md")};
  for (const auto& entry : fs::recursive_directory_iterator(source("docs")))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  return pages;
}

TEST(Links, LeadToFilesThatAreThere) {
  static const std::regex link(R"(\]\(([^)#: ]+)(#[^)]*)?\))");
  std::vector<std::string> broken;
  std::size_t checked = 0;
  for (const fs::path& page : markdown_pages()) {
    const std::string text = contents(page);
    for (std::sregex_iterator one(text.begin(), text.end(), link), end; one != end; ++one, ++checked)
      if (!fs::exists(page.parent_path() / (*one)[1].str()))
        broken.push_back(page.lexically_relative(source(".")).string() + ": " + (*one)[1].str());
  }
  EXPECT_THAT(broken, testing::IsEmpty());
  EXPECT_GT(checked, 50u);
}

}  // namespace
}  // namespace beamid::docs::links_test
