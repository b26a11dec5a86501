// Every word of the pages' prose is in the British dictionary or in the project's own list, and every word of
// that list is in a page. Oracle: hunspell with en_GB.
#include <gmock/gmock.h>

#include <set>

#include "tests/docs/prose.hpp"

namespace beamid::docs::spelling_test {
namespace {

std::set<std::string> words_of(const std::string& text) {
  static const std::regex word(R"(\\?[A-Za-z][A-Za-z']+[A-Za-z])");  // three letters at least
  std::set<std::string> words;
  for (std::sregex_iterator one(text.begin(), text.end(), word), end; one != end; ++one)
    if (one->str()[0] != '\\') words.insert(one->str());  // nor commands of equations
  return words;
}

std::set<std::string> words_of_pages() {
  std::set<std::string> all;
  for (const fs::path& page : markdown_pages())
    if (page.filename() != "references.md")  // names and titles, as published
      for (const Paragraph& paragraph : prose(lines_of(contents(page)))) all.merge(words_of(paragraph.text));
  return all;
}

std::set<std::string> not_in_the_dictionary(const std::set<std::string>& words) {
  const Shell shell;
  std::ofstream text(shell.root() / "words.txt");
  for (const std::string& word : words) text << word << '\n';
  text.close();
  const Outcome outcome = shell.run("hunspell -d en_GB -l words.txt");
  EXPECT_EQ(outcome.code, 0) << outcome.err << "\nexpected: apt-get install hunspell hunspell-en-gb";
  return words_of(outcome.out);
}

TEST(Spelling, IsThatOfTheDictionaryOrOfTheList) {
  const std::set<std::string> used = words_of_pages(), unknown = not_in_the_dictionary(used),
                              listed = words_of(contents(source("tests/docs/words.txt")));
  std::string report;
  for (const std::string& word : unknown)
    if (!listed.contains(word)) report += word + " is in no list\n";
  for (const std::string& word : listed)
    if (!used.contains(word) && !used.contains(word + "'s"))
      report += word + " of tests/docs/words.txt is in no page\n";
  EXPECT_EQ(report, "");
}

// The test can fail.
TEST(Spelling, FindsAWordThatIsNone) {
  EXPECT_EQ(not_in_the_dictionary({"stiffness", "stifness", "modelled", "modeled"}),
            (std::set<std::string>{"stifness", "modeled"}));
}

}  // namespace
}  // namespace beamid::docs::spelling_test
