// beamid new and beamid validate.
#include <gmock/gmock.h>

#include <sstream>

#include "experiments/config/key_tables.hpp"
#include "tests/apps/run_command.hpp"

namespace beamid::apps::experiment_files_test {
namespace {

constexpr const char* key_letters = "abcdefghijklmnopqrstuvwxyz0123456789_";

using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty, testing::StartsWith;

TEST(New, WritesAFileThatValidateAccepts) {
  Workplace place;
  const Outcome written = place.run("new mine.toml"), checked = place.run("validate mine.toml");
  EXPECT_EQ(written.code, 0) << written.err;
  EXPECT_THAT(written.out, StartsWith("Written: mine.toml\n"));
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_THAT(checked.out, StartsWith("mine.toml: valid\n"));
  EXPECT_THAT(checked.out, HasSubstr("'record.csv' is not there and was not checked"));
}

// Behind # stands only what may stand there: with every such line put to use, one key too many is refused
// where two exclude each other, and nothing else.
TEST(New, ShowsKeysThatExist) {
  Workplace place;
  const std::string text = place.run("new -").out;
  std::istringstream lines(text);
  std::string used;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t start = line.find_first_not_of(' ');
    const bool key =
        start != std::string::npos && line.compare(start, 2, "# ") == 0 &&
        (line.find(" = ") != std::string::npos || line.find('[') == start + 2 || line.find('{') == start + 2);
    const bool excluded = line.find("instead of") != std::string::npos;
    used += key && !excluded ? line.substr(start + 2) + "\n" : line + "\n";
  }
  place.write("all.toml", used);
  const Outcome checked = place.run("validate all.toml");
  EXPECT_EQ(checked.code, 0) << checked.err << used;
  for (const char* table : {"\n[reduction]", "\n[prior]", "\n[noise]", "\nwindow_s = ", "\nheader_lines = "})
    EXPECT_THAT(used, HasSubstr(table));
}

TEST(New, WritesTheSameToStandardOutput) {
  Workplace place;
  const Outcome printed = place.run("new -");
  EXPECT_EQ(printed.code, 0);
  EXPECT_THAT(place.files(), IsEmpty());
  place.run("new mine.toml");
  EXPECT_EQ(printed.out, contents(place.folder() / "mine.toml"));
}

TEST(New, ReplacesAFileOnlyWithForce) {
  Workplace place;
  place.write("mine.toml", "precious");
  const Outcome refused = place.run("new mine.toml");
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.first_error_line(), "mine.toml: exists; choose another name, or replace it with --force");
  EXPECT_EQ(contents(place.folder() / "mine.toml"), "precious");
  EXPECT_EQ(place.run("new mine.toml --force").code, 0);
  EXPECT_NE(contents(place.folder() / "mine.toml"), "precious");
}

TEST(New, RefusesFoldersAndMissingOnes) {
  Workplace place;
  EXPECT_EQ(place.run("new .").first_error_line(), ".: a directory; expected the name of a new file");
  EXPECT_THAT(place.run("new no/mine.toml").err, StartsWith("no/mine.toml: no folder '"));
  EXPECT_EQ(place.run("new").first_error_line(), "beamid: new: which FILE? ('-' for standard output)");
  EXPECT_THAT(place.files(), IsEmpty());
}

TEST(Validate, ReadsTheRecordToo) {
  Workplace place;
  fs::copy(source("docs/tutorials/02_identify_a_record"), place.folder(), fs::copy_options::recursive);
  const Outcome named = place.run("validate cantilever.toml"),
                given = place.run("validate cantilever.toml --record tip_acceleration.csv");
  EXPECT_EQ(named.code, 0) << named.err;
  EXPECT_EQ(named.out, given.out);
  EXPECT_EQ(
      named.out,
      "cantilever.toml: valid\n"
      "  beam     1.1 m, EI = 228.96 N m2, 3.055 kg with 0.36049 kg at its tip; first mode predicted at\n"
      "           3.4555 Hz\n"
      "  record   tip_acceleration.csv: 2001 samples from 2 to 10 s at 250 Hz; tip: acceleration at 1.1 m\n"
      "           up to 4.581 m/s2\n"
      "  methods  reduction rayleigh, model sdof, filter ekf, discretisation exponential\n"
      "  unknowns stiffness, damping ratio (initial estimates from the record)\n");
}

// Oracle: what the file says.
TEST(Validate, ShowsSensorsPriorsAndParameters) {
  Workplace place;
  fs::copy(source("docs/tutorials/02_identify_a_record"), place.folder(), fs::copy_options::recursive);
  const std::string file = contents(place.folder() / "cantilever.toml");
  place.write("prior.toml", file + "\n[prior]\nstiffness_n_per_m = 510\nstiffness_deviation_n_per_m = 150\n");
  EXPECT_THAT(
      place.run("validate prior.toml").out,
      HasSubstr("  unknowns stiffness 510 +- 150 N/m, damping ratio (initial estimates; the others from "
                "the record)\n"));
  place.write("beam.toml",
              file +
                  "\n[model]\nname = \"beam\"\n[[sensors]]\nname = \"mid\"\nposition_m = 0.5\n"
                  "quantity = \"displacement\"\n[[parameters]]\nquantity = \"bending_stiffness\"\n"
                  "guess_n_m2 = 200\nrelative_deviation = 0.1\n");
  const std::string shown = place.run("validate beam.toml").out;
  EXPECT_THAT(shown, HasSubstr("  sensors  mid: displacement at 0.5 m\n"));
  EXPECT_THAT(shown, HasSubstr("bending_stiffness 200 +- 20 N m2"));
}

TEST(Validate, RefusesARecordThatDoesNotFit) {
  Workplace place;
  place.run("new mine.toml");
  place.write("one_column.csv", "1\n2\n3\n");
  const Outcome outcome = place.run("validate mine.toml --record one_column.csv");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_EQ(outcome.first_error_line(),
            "one_column.csv:1:1: 1 column; expected at least 2, the column requested");
  EXPECT_EQ(place.run("validate mine.toml --record no.csv").first_error_line(),
            "no.csv: no such file; expected a record of numbers in columns");
}

TEST(Validate, RefusesAModelThatCannotReadTheRecord) {
  Workplace place;
  fs::copy(source("docs/tutorials/02_identify_a_record"), place.folder(), fs::copy_options::recursive);
  place.write("full.toml",
              contents(place.folder() / "cantilever.toml") + "\n[reduction]\nmethod = \"none\"\n");
  const Outcome outcome = place.run("validate full.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.first_error_line(),
            "full.toml: model 'sdof' needs a reduction to one coordinate; this one keeps 80");
}

TEST(Validate, SaysWhatIsMissing) {
  EXPECT_EQ(Workplace().run("validate").first_error_line(), "beamid: validate: which FILE?");
  EXPECT_EQ(Workplace().run("validate no.toml").first_error_line(),
            "no.toml: no such file; expected a TOML file");
}

// What a structure's file describes is simulated and identified as it stands. Oracle: its own values.
TEST(New, WritesAFileForEveryStructureThatRuns) {
  for (const std::string structure : {"chain", "frame", "space_frame", "system"}) {
    Workplace place;
    const std::string header = "%%MatrixMarket matrix coordinate real symmetric\n2 2 ";
    place.write("M.mtx", header + "2\n1 1 1000\n2 2 800\n");
    place.write("K0.mtx", header + "3\n1 1 1.2e6\n2 1 -1.2e6\n2 2 1.2e6\n");
    place.write("K1.mtx", header + "1\n1 1 2e6\n");
    ASSERT_EQ(place.run("new mine.toml --structure " + structure).code, 0);
    const Outcome checked = place.run("validate mine.toml");
    EXPECT_EQ(checked.code, 0) << structure << checked.err;
    const Outcome shaken = place.run("simulate --config mine.toml --out shaken");
    EXPECT_EQ(shaken.code, 0) << structure << shaken.err;
    const Outcome found = place.run("identify shaken/record.csv --config mine.toml");
    EXPECT_EQ(found.code, 0) << structure << found.err;
    EXPECT_THAT(found.out, HasSubstr("converged")) << structure;
  }
  EXPECT_EQ(Workplace().run("new mine.toml --structure bridge").code, 2);
}

TEST(Tutorials, HoldExperimentFilesThatAreValid) {
  int found = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source("docs/tutorials"))) {
    if (entry.path().extension() != ".toml") continue;
    if (fs::exists(entry.path().parent_path() / "CMakeLists.txt")) continue;  // for a command of their own
    if (contents(entry.path()).find("[[modes]]") != std::string::npos) continue;  // measured modes
    ++found;
    const Outcome outcome = Workplace().run("validate '" + entry.path().string() + "'");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_EQ(found, 48);
}

// Oracle: the rows that the reader has. A line behind # is a key, too.
TEST(New, WritesKeysThatExistWithValuesThatTheyMayHave) {
  using namespace experiments;
  const KeyTable* table = find_key_table("");
  int checked = 0;
  std::istringstream lines(Workplace().run("new -").out);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of("# ");
    if (first == std::string::npos) continue;
    const std::string text = line.substr(first), name = text.substr(0, text.find_first_not_of(key_letters));
    if (text[0] == '[') {
      table = find_key_table(text.substr(1, text.find(']') - 1));
      ASSERT_NE(table, nullptr) << line;
    } else if (text.substr(name.size()).starts_with(" = ")) {
      const Key* const key = table->find(name);
      ASSERT_NE(key, nullptr) << table->name() << ": " << line;
      if (!key->is_table()) {
        EXPECT_NO_THROW(table->check(TomlTable::parse("[table]\n" + text + "\n", "starter").table("table")))
            << line;
      }
      ++checked;
    }
  }
  EXPECT_GT(checked, 30);
}

}  // namespace
}  // namespace beamid::apps::experiment_files_test
