// What an interrupted sweep leaves, and how it is resumed. Oracle: the rows written.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "experiments/sweep/manifest.hpp"
#include "experiments/text/input_error.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/sweep/sweep_rows.hpp"

namespace beamid::experiments::journal_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr, testing::ThrowsMessage;

class JournalTest : public testing::Test {
 protected:
  JournalTest() : folder_(fs::path(file_.path()).parent_path() / "kept.partial") { fs::remove_all(folder_); }
  ~JournalTest() override { fs::remove_all(folder_); }

  /// Two cases, the second of two rows.
  void keep_two() const {
    Journal journal(folder_, manifest_, plan_, false);
    journal.append({found_row(0, 11)});
    SweepRow first = found_row(1, 9), second = first;
    first.rows = second.rows = second.row = 2;
    journal.append({first, second});
  }
  std::vector<std::size_t> resumed() const {
    std::vector<std::size_t> kept;
    const Journal journal(folder_, manifest_, plan_, true);
    for (const SweepRow& row : journal.kept()) kept.push_back(row.number);
    return kept;
  }
  void add(const std::string& text) const { std::ofstream(folder_ / "cases.csv", std::ios::app) << text; }

  TemporaryFile file_{"empty.toml", ""};
  fs::path folder_;
  SweepPlan plan_ = plan_with({"beam.length_m=1,2"}, 1, 3);
  nlohmann::ordered_json manifest_ = manifest_of({{file_.path(), ""}, {}, {}}, plan_, {});
};

TEST_F(JournalTest, KeepsWholeCasesAndCutsATornOneOff) {
  keep_two();
  const auto size = fs::file_size(folder_ / "cases.csv");
  EXPECT_THAT(resumed(), ElementsAre(0u, 1u, 1u));
  add(to_line(found_row(2, 12)).substr(0, 20));
  EXPECT_THAT(resumed(), ElementsAre(0u, 1u, 1u));
  EXPECT_EQ(fs::file_size(folder_ / "cases.csv"), size);
}

TEST_F(JournalTest, CutsACaseOffThatLacksARow) {
  keep_two();
  const auto size = fs::file_size(folder_ / "cases.csv");
  SweepRow first = found_row(2, 12);
  first.rows = 2;
  add(to_line(first));
  EXPECT_THAT(resumed(), ElementsAre(0u, 1u, 1u));
  EXPECT_EQ(fs::file_size(folder_ / "cases.csv"), size);
}

TEST_F(JournalTest, RefusesWhatNoInterruptionLeaves) {
  keep_two();
  EXPECT_THAT([&] { Journal(folder_, manifest_, plan_, false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("--resume continues it")));
  const nlohmann::ordered_json other = manifest_of({{file_.path(), "#"}, {}, {}}, plan_, {});
  EXPECT_THAT([&] { Journal(folder_, other, plan_, true); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("holds another sweep")));
  {
    const Journal first(folder_, manifest_, plan_, true);
    EXPECT_THAT([&] { Journal(folder_, manifest_, plan_, true); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("in use")));
  }
  add("nonsense\n" + to_line(found_row(2, 12)));
  EXPECT_THAT([&] { Journal(folder_, manifest_, plan_, true); },
              ThrowsMessage<InputError>(HasSubstr("cases.csv:5:1: no row")));
}

TEST_F(JournalTest, OfASweepThatIsRunningIsNeitherOfferedNorDiscarded) {
  keep_two();
  {
    const Journal running(folder_, manifest_, plan_, true);
    for (const bool resume : {false, true})
      EXPECT_THAT([&] { Journal(folder_, manifest_, plan_, resume); },
                  ThrowsMessage<std::invalid_argument>(HasSubstr("in use by another beamid sweep")));
    EXPECT_FALSE(discard_journal(folder_));
  }
  EXPECT_THAT(resumed(), ElementsAre(0u, 1u, 1u));
  EXPECT_TRUE(discard_journal(folder_));
  EXPECT_FALSE(fs::exists(folder_));
  EXPECT_TRUE(discard_journal(folder_));
}

}  // namespace
}  // namespace beamid::experiments::journal_test
