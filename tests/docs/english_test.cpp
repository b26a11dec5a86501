// Pages are written in plain technical English: a record shows, a user states, a residual remains. Outside
// code, outputs and quotations the words of the list below are not used, and spelling is British.
#include <gmock/gmock.h>

#include "tests/docs/prose.hpp"

namespace beamid::docs::english_test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty, testing::SizeIs;

struct Rule {
  const char* pattern;  ///< in lower case; a first group that matched allows what was found
  const char* instead;
};

// Oracle: the project's rules of style (CONTRIBUTING.md).
const std::vector<Rule> rules{
    {R"(\bnothing\b)", "name what is absent: no force, no interpolation"},
    {R"(\b(words?)\b)", "the field's term: text, argument, key, message"},
    {R"(\b(tell|tells|told|telling)\b)", "show, determine, distinguish; specified"},
    {R"(\b(hear|hears|heard)\b)", "measure, receive"},
    {R"(\b(know|knows|knew)\b)", "assume, contain, take into account; known is allowed"},
    {R"(\b(say|says|said|saying)\b)", "state, report, show"},
    {R"(\b(ask|asks|asked|asking)\b)", "request, require"},
    {R"(\b(leave|leaves|leaving)\b)", "residual, remain, omit, keep"},
    {R"(\b(is|are|was|were|be|has|have|had) left\b)", "remain"},
    {R"(\bleft (of|by|over|open|alone|out)\b)", "residual, remain, omit"},
    {R"(\bhardly\b)", "poorly, little, almost never"},
    {R"(\bsurer\b)", "overconfident: below the Cramer-Rao bound"},
    {R"(\bsteady size\b)", "stationary"},
    {R"(\bmade up\b)", "interpolated, invented, composed"},
    {R"(\bof one's own\b)", "user-supplied"},
    {R"(\b95 % from\b)", "95 % interval"},
    {R"(\bdeviations?\b)", "standard deviation"},
};

const Rule american{
    R"(\b([a-z]+i[sz]ing|[a-z]*iz(e|es|ed|er|ers|ation|ations)|colors?|colored|behaviors?|centers?|centered|gray|neighbors?|neighboring|favor|modeled|modeling|labeled|labeling|canceled|traveling|analyz(e|es|ed)|artifacts?|catalog|meters?|fulfill|judgment|catalogs)\b)",
    "British spelling"};

bool british(const std::string& word) {
  static const std::regex american_ending(R"([a-z]*iz(e|es|ed|er|ers|ing|ation|ations))"),
      sizes(R"((over|under|re)?(siz|priz|seiz)(e|es|ed|ing)|sanitizers?)"), ising(R"([a-z]+ising)");
  return std::regex_match(word, ising) || std::regex_match(word, sizes);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// "line 12: hardly (poorly, ...)" for each breach.
std::vector<std::string> breaches(const std::vector<Paragraph>& paragraphs) {
  static const std::vector<std::regex> patterns = [] {
    std::vector<std::regex> made;
    for (const Rule& rule : rules) made.emplace_back(rule.pattern);
    return made;
  }();
  static const std::regex spelling(american.pattern), spaces(R"(\s+)"), full("standard deviation");
  std::vector<std::string> found;
  for (const Paragraph& paragraph : paragraphs) {
    const std::string text =
        std::regex_replace(std::regex_replace(lower(paragraph.text), spaces, " "), full, "sigma");
    const auto note = [&](const std::string& word, const char* instead) {
      found.push_back(fmt::format("line {}: {} ({})", paragraph.line, word, instead));
    };
    for (std::size_t i = 0; i < rules.size(); ++i)
      for (std::sregex_iterator one(text.begin(), text.end(), patterns[i]), end; one != end; ++one)
        note(one->str(), rules[i].instead);
    for (std::sregex_iterator one(text.begin(), text.end(), spelling), end; one != end; ++one)
      if (!british(one->str())) note(one->str(), american.instead);
  }
  return found;
}

TEST(English, IsPlainOnEveryPage) {
  std::string report;
  for (const fs::path& page : markdown_pages())
    if (page.filename() != "references.md")  // titles, as published
      for (const std::string& breach :
           breaches(prose(lines_of(contents(page)), page.filename() == "configuration.md")))
        report += page.lexically_relative(source(".")).string() + ", " + breach + "\n";
  EXPECT_EQ(report, "");
}

TEST(English, IsCheckedInProseAlone) {
  const auto read =
      prose(lines_of("Text tells\n`it says` \"nothing\" and $words$ [a](hardly.md)\n\n```\ntold\n```\n\n    "
                     "asks\n\n<!-- run: leaves -->\n"));
  ASSERT_THAT(read, SizeIs(1));
  EXPECT_EQ(read[0].line, 1);
  EXPECT_THAT(breaches(read), ElementsAre(HasSubstr("line 1: tells")));
}

TEST(English, FindsSpellingAndStandardDeviations) {
  const auto of = [](const std::string& text) { return breaches(prose(lines_of(text))); };
  EXPECT_THAT(of("The standard\ndeviation of a size, raising, normalised, colour."), IsEmpty());
  EXPECT_THAT(of("two deviations"), SizeIs(1));
  EXPECT_THAT(of("normalized"), ElementsAre(HasSubstr("British")));
  EXPECT_THAT(of("the center of a gray color"), SizeIs(3));
}

// Oracle: every row of the table of keys is the program's.
TEST(English, PassesOverTablesOfKeys) {
  EXPECT_THAT(prose(lines_of("| `key` | asks |"), true), IsEmpty());
  EXPECT_THAT(prose(lines_of("| `key` | asks |"), false), SizeIs(1));
}

}  // namespace
}  // namespace beamid::docs::english_test
