#include "experiments/results/results.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "experiments/results/text.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::results_test {
namespace {

Results results() {
  Results results;
  results.command = "identify";
  results.seed = 7;
  results.configuration = {{"beam", {{"length_m", 1.1}}}, {"filter", "ekf"}};
  results.values = {{"status", "ok"}, {"beams", {{{"name", "S(0.65)"}, {"frequency_hz", 4.145510989755}}}}};
  results.heading("Identification");
  results.paragraph("First comes a text.");
  Table table{"table1", "Table 1"};
  table.column({"beam", "beam"})
      .column({"f1 [Hz]", "frequency_hz", "{:.4f}"})
      .row({"S(0.65)", 4.145510989755});
  results.table(table);
  results.paragraph("And a text after the table.");
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(5, 0, 1);
  results.figures.push_back({"figure1", {{"", {"t [s]"}, {"x [m]"}, {{"motion", x, x}}}}});
  results.attachments.push_back({{"notes.txt"}, [](const std::filesystem::path& folder) {
                                   std::ofstream(folder / "notes.txt") << "text";
                                 }});
  results.timing = {{"filter", 0.25}};
  return results;
}

// Oracle: the schema that docs/configuration.md promises, in this order.
TEST(Results, JsonHasTheSchemasKeysInOrder) {
  std::vector<std::string> keys;
  const auto json = to_json(results());
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"schema_version", "program", "version", "command", "seed",
                                            "configuration", "status", "beams", "messages", "verdict",
                                            "tables", "files"}));
  EXPECT_EQ(json["schema_version"], 4);
  EXPECT_EQ(json["program"], "beamid");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["beams"][0]["frequency_hz"], 4.145510989755);
  Results without_seed = results();
  without_seed.seed.reset();
  EXPECT_TRUE(to_json(without_seed)["seed"].is_null());
}

// Oracle: the table's own CSV.
TEST(Results, JsonHasEveryTableUnderTheKeysOfItsCsv) {
  Results results = results_test::results();
  results.table(Table{"gaps", "", {{"a", "a_m", "{}", {1.5, std::nan("")}}, {"b", "b", "{}", {"x", "y"}}}});
  const auto json = to_json(results);
  EXPECT_EQ(json["tables"]["gaps"].dump(), R"([{"a_m":1.5,"b":"x"},{"a_m":null,"b":"y"}])");
  EXPECT_EQ(to_csv(std::get<Table>(results.report.back())), "a_m,b\n1.5,x\n,y\n");
}

TEST(Results, JsonListsWhatMustBeHeeded) {
  Results results = results_test::results();
  results.note("Cut.");
  results.warning("Clipped.");
  EXPECT_FALSE(results.has_failed());
  results.warning("Diverged.", true);
  EXPECT_TRUE(results.has_failed());
  EXPECT_EQ(to_json(results)["messages"].dump(),
            R"([{"severity":"note","heading":"Identification","text":"Cut."},)"
            R"({"severity":"warning","heading":"Identification","text":"Clipped."},)"
            R"({"severity":"failure","heading":"Identification","text":"Diverged."}])");
}

TEST(Results, JsonHasAVerdictWithTheNumbersThatDecided) {
  Results results = results_test::results();
  results.values.erase("status");
  EXPECT_EQ(to_json(results)["verdict"].dump(),
            R"({"status":"no_objections","objections":[],"limitations":[]})");
  results.limitation("Not white.");
  results.object({"not_settled", "It moves.", 7.5, 5.0}, "a.csv: ");
  results.object({"gaps", "2 gaps."});
  EXPECT_EQ(to_json(results)["verdict"].dump(),
            R"({"status":"with_reservations","objections":[)"
            R"({"name":"not_settled","statistic":7.5,"limit":5.0,"sentence":"a.csv: It moves."},)"
            R"({"name":"gaps","statistic":null,"limit":null,"sentence":"2 gaps."}],)"
            R"("limitations":["Not white."]})");
  results.values["status"] = "contradicted";
  EXPECT_EQ(to_json(results)["verdict"]["status"], "contradicted");
}

TEST(Results, NumbersThatAreNotFiniteBecomeNullWithAWarning) {
  Results results = results_test::results();
  results.values["beams"][0]["frequency_hz"] = std::numeric_limits<double>::quiet_NaN();
  results.configuration["beam"]["length_m"] = -std::numeric_limits<double>::infinity();
  const auto json = to_json(results);
  EXPECT_TRUE(json["beams"][0]["frequency_hz"].is_null());
  EXPECT_EQ(json["warnings"].dump(),
            R"(["configuration.beam.length_m is -inf","beams[0].frequency_hz is nan"])");
}

TEST(Results, RefuseKeysAndFilesThatAreTaken) {
  Results key = results();
  key.values["seed"] = 3;
  EXPECT_THROW(to_json(key), std::invalid_argument);
  Results file = results();
  file.table(Table{"figure1", "the same CSV as the figure's"});
  EXPECT_THROW(to_json(file), std::invalid_argument);
}

// Oracle: the folder's own listing, and a second run.
TEST(Results, WriteTheFilesTheyListAndTheSameBytesAgain) {
  TemporaryFolder temporary;
  for (const char* name : {"first", "second"}) {
    Results results = results_test::results();
    results.timing[0].second = *name;  // the clock never gives the same twice
    ResultDirectory directory(temporary.path / name, false);
    write(results, directory);
    directory.commit();
  }
  const auto json = nlohmann::json::parse(contents(temporary.path / "first/results.json"));
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(temporary.path / "first")) {
    const std::string file = entry.path().filename().string();
    EXPECT_NE(std::find(json["files"].begin(), json["files"].end(), file), json["files"].end()) << file;
    EXPECT_EQ(contents(entry.path()) == contents(temporary.path / "second" / file), file != "timing.json")
        << file;
    ++count;
  }
  EXPECT_EQ(count, json["files"].size());
  EXPECT_EQ(contents(temporary.path / "first/table1.csv"), "beam,frequency_hz\nS(0.65),4.145510989755\n");
  EXPECT_TRUE(nlohmann::json::parse(contents(temporary.path / "first/timing.json"))["filter_s"].is_number());

  // What was written may be replaced: it lists itself.
  ResultDirectory directory(temporary.path / "first", true);
  directory.write("results.json", "{}");
  EXPECT_NO_THROW(directory.commit());
}

// Oracle: written by hand.
TEST(Results, PrintTextsAndTablesInTheirOrder) {
  std::ostringstream stream;
  print(stream, results());
  EXPECT_EQ(stream.str(),
            "Identification\n"
            "==============\n"
            "\n"
            "First comes a text.\n"
            "\n"
            "Table 1\n"
            "beam     f1 [Hz]\n"
            "-------  -------\n"
            "S(0.65)   4.1455\n"
            "\n"
            "And a text after the table.\n");
}

TEST(Results, ForATerminalAloneHaveNoFigures) {
  int drawn = 0;
  const auto figures = [&] {
    ++drawn;
    return std::vector<Figure>{Figure{"motion", {}}};
  };
  Results found;
  {
    const TerminalOnly shown;
    found.draw(figures);
  }
  EXPECT_EQ(drawn, 0);
  found.draw(figures);
  ASSERT_EQ(found.figures.size(), 1u);
  EXPECT_EQ(found.figures[0].name, "motion");
}

TEST(Results, JsonOnTheTerminalIsTheFile) {
  TemporaryFolder temporary;
  ResultDirectory directory(temporary.path / "out", false);
  write(results(), directory);
  std::ostringstream stream;
  print_json(stream, results());
  EXPECT_EQ(stream.str(), contents(directory.path() / "results.json"));
}

// Oracle: JSON is UTF-8 (RFC 8259, section 8.1); a Latin-1 text must not end the run.
TEST(Results, TextsThatAreNotUtf8AreReplaced) {
  Results results = results_test::results();
  results.values["channel"] = "Beschleunigung \xb2";
  std::ostringstream stream;
  EXPECT_NO_THROW(print_json(stream, results));
  EXPECT_TRUE(nlohmann::json::accept(stream.str()));
}

}  // namespace
}  // namespace beamid::experiments::results_test
