// Pages and messages are written in plain technical English: a record shows, a user states, a residual
// remains. Outside code, outputs and quotations of pages, and in the texts of sources, the words of the list
// below are not used, and spelling is British.
#include <gmock/gmock.h>

#include "tests/docs/literals.hpp"

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

/// What the texts of a source may have nevertheless; in lower case.
struct Allowed {
  const char* file;     ///< below the project's folder; "" is every file
  const char* pattern;  ///< taken out before the text is read
  const char* reason;
};

const std::vector<Allowed> allowed{
    {"", R"(\b95 % from\b)", "heading of the first of two columns, from and to"},
    {"", R"(\bdeviations?( \[| / bound)|/ deviation\b|cramer-rao, 1 deviation)", "heading of a column"},
    {"", R"(\bdeviation: standard deviation\b)", "explains such a heading"},
    {"", R"(`deviation`|normal:mean:deviation|\bdeviation\{)", "a key or an argument"},
    {"experiments/record/steps/event.cpp", R"(\blargest deviation\b)", "of a signal from its mean"},
    {"experiments/results/gnuplot.cpp", R"(\bleft\b|\bcenter\b|\bpointsize\b)", "gnuplot's key words"},
    {"experiments/results/report_page.cpp", R"(:root \{[^]*)", "style sheet: CSS has its own spelling"},
    {"experiments/studies/reduce/figures.cpp", R"(\bdisplacement left\b)", "the side of a figure"},
    {"experiments/modal/universal_modes.cpp", R"(si: meter \(newton\))",
     "the format's own name of the units"},
    {"apps/new.cpp", R"("left"|"left\.)", "name of a joint on the left"},
};

std::vector<Paragraph> without_allowed(const std::string& file, std::vector<Paragraph> texts) {
  for (Paragraph& one : texts) {
    one.text = lower(one.text);
    for (const Allowed& exception : allowed)
      if (!*exception.file || file == exception.file)
        one.text = std::regex_replace(one.text, std::regex(exception.pattern), "...");
  }
  return texts;
}

/// Texts also avoid `left` without a verb before it, but for the side.
std::vector<std::string> breaches_of_source(const std::string& file, const std::string& code) {
  static const std::regex left(R"(\bleft\b)");
  const std::vector<Paragraph> texts = without_allowed(file, messages(code));
  std::vector<std::string> found = breaches(texts);
  for (const Paragraph& one : texts)
    if (std::regex_search(one.text, left))
      found.push_back(fmt::format("line {}: left (remain, omit, residual)", one.line));
  return found;
}

// Oracle: the same list.
TEST(English, IsPlainInEveryMessage) {
  std::string report;
  for (const char* folder : {"fem", "reduction", "filters", "experiments", "apps"})
    for (const auto& entry : fs::recursive_directory_iterator(source(folder))) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      const std::string file = entry.path().lexically_relative(source(".")).generic_string();
      for (const std::string& breach : breaches_of_source(file, contents(entry.path())))
        report += file + ", " + breach + "\n";
    }
  EXPECT_EQ(report, "");
}

TEST(English, ReadsTheTextsOfASource) {
  const auto read = messages(
      "#include \"a tells.hpp\"\n// \"says it\"\nchar c = '\"'; int n = 10'000;\n"
      "f(\"one \"\n  \"two\\nthree\", \"key\", R\"x(raw \"left\")x\");\n/* \"ask it\" */");
  ASSERT_THAT(read, SizeIs(2));
  EXPECT_EQ(read[0].line, 4);
  EXPECT_EQ(read[0].text, "one two\nthree");
  EXPECT_EQ(read[1].line, 5);
  EXPECT_EQ(read[1].text, "raw \"left\"");
  EXPECT_THAT(breaches_of_source("a.cpp", "\"it\\nasks\\n and is left\""),
              ElementsAre(HasSubstr("asks"), HasSubstr("is left"), HasSubstr("left (")));
  EXPECT_THAT(breaches_of_source("apps/new.cpp", "R\"(at = \"left.x\")\""), IsEmpty());
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
