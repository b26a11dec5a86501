// A file is a chapter: neither a paragraph nor a book. Oracle: the sources' own lines and includes.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/layers/include_rules.hpp"
#include "tests/layers/source_files.hpp"

namespace beamid::layers::chapters_test {
namespace {

constexpr double most_files = 850, most_short = 135, most_one_user = 60;
constexpr long longest = 450, shortest = 40;  // lines

std::vector<std::string> product_files() {
  std::vector<std::string> files;
  for (const char* folder : {"fem", "filters", "reduction", "experiments", "apps"})
    for (std::string& file : sources_below(folder)) files.push_back(std::move(file));
  return files;
}

long lines(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

std::string own_source(std::string header) {
  return header.replace(header.size() - 4, 4, ".cpp");
}

std::string listed(const std::set<std::string>& names) {
  std::ostringstream text;
  for (const std::string& name : names) text << name << '\n';
  return text.str();
}

TEST(Chapters, AreNeitherParagraphsNorBooks) {
  const std::vector<std::string> files = product_files();
  std::set<std::string> few, many;
  for (const std::string& file : files) {
    const long count = lines(text_of(file));
    if (count < shortest) few.insert(file);
    if (count > longest) many.insert(file);
  }
  EXPECT_LE(files.size(), most_files);
  EXPECT_TRUE(many.empty()) << "longer than " << longest << " lines:\n" << listed(many);
  EXPECT_LE(few.size(), most_short) << "shorter than " << shortest << " lines:\n" << listed(few);
}

// What one file uses lives in that file; tests may be a second reason for a header.
TEST(Chapters, HaveFewHeadersForOneUser) {
  const std::vector<std::string> files = product_files();
  std::map<std::string, std::set<std::string>> users;
  for (const std::string& file : files)
    for (const Include& include : includes_of(text_of(file)))
      if (include.quoted && file != own_source(include.target)) users[include.target].insert(file);
  std::set<std::string> lonely;
  for (const std::string& file : files)
    if (file.ends_with(".hpp") && !file.starts_with("apps/package/") && users[file].size() < 2)
      lonely.insert(file);
  EXPECT_LE(lonely.size(), most_one_user) << listed(lonely);
}

}  // namespace
}  // namespace beamid::layers::chapters_test
