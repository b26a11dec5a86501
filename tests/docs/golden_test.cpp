// Text and results.json of every command on the tutorials' inputs are those of tests/golden.
//
// These numbers are copied from the program's own output: they prove that a change changes nothing else, not
// that anything is right. What is right is proven by the tests that name an oracle.
#include <gmock/gmock.h>

#include "tests/docs/golden_case.hpp"

namespace beamid::docs::golden_test {
namespace {

using testing::IsEmpty;

std::string first_ones(const std::vector<std::string>& differences) {
  constexpr std::size_t shown = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(shown, differences.size()); ++i) text += differences[i] + "\n";
  return text + (differences.size() > shown ? fmt::format("and {} more\n", differences.size() - shown) : "") +
         "Where this is meant: tests/golden/update\n";
}

/// results.json without what every release changes.
json comparable(const std::string& text) {
  json results = json::parse(text);
  results.erase("version");
  return rounded(results);
}

/// For tests/python/equality_test.py, which need not run the command again.
void keep(const std::string& name, const std::string& printed) {
  const fs::path folder = BEAMID_GOLDEN_OUTPUT;
  fs::create_directories(folder);
  std::ofstream(folder / (name + ".json")) << printed;
}

class Golden : public testing::TestWithParam<GoldenCase> {
 protected:
  /// Measured records of tutorials 3, 10 and 12, put where the page says; false where they are not here.
  bool prepare() const {
    for (const std::string& record : GetParam().data) {
      const fs::path file = source("../shared/data") / record;
      if (!fs::exists(file)) return false;
      fs::copy(file, shell_.root() / GetParam().folder / file.filename());
    }
    if (GetParam().before.empty()) return true;
    const Outcome outcome = shell_.run(GetParam().before, GetParam().folder);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return true;
  }

  Shell shell_;
};

TEST_P(Golden, OutputIsTheSame) {
  const GoldenCase& tested = GetParam();
  if (!prepare()) GTEST_SKIP() << "the measured records are not here";
  const Outcome outcome = shell_.run(tested.command, tested.folder);
  const std::string text = as_text(outcome);
  if (updating())
    std::ofstream(tested.file(".txt")) << text;
  else {
    const auto differences = text_differences(contents(tested.file(".txt")), text, tested.looser);
    EXPECT_THAT(differences, IsEmpty()) << tested.name << ".txt\n" << first_ones(differences);
  }
  if (tested.text_only) return;
  const std::string printed = shell_.run(tested.command + " --json", tested.folder).out;
  keep(tested.name, printed);
  const json results = comparable(printed);
  const auto fails = [](const json& message) { return message["severity"] == "failure"; };
  EXPECT_EQ(outcome.code == 3, std::any_of(results["messages"].begin(), results["messages"].end(), fails));
  if (updating())
    std::ofstream(tested.file(".json")) << results.dump(1) << "\n";
  else {
    const auto differences =
        JsonComparison(tested.looser)(json::parse(contents(tested.file(".json"))), results);
    EXPECT_THAT(differences, IsEmpty()) << tested.name << ".json\n" << first_ones(differences);
  }
}

INSTANTIATE_TEST_SUITE_P(Command, Golden, testing::ValuesIn(golden_cases()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace beamid::docs::golden_test
