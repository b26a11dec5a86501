// Processes ended at any moment, by kill -9 too, and two at once: results and states are whole or absent,
// finished cases are kept, and what is left behind goes with the next run. The moments are drawn from a seed;
// where in the work they fall is the machine's affair. Oracle: the run that nothing ended.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <random>

#include "tests/reliability/moments.hpp"
#include "tests/reliability/shell.hpp"

namespace beamid::reliability::killed_test {
namespace {

using apps::contents, apps::Outcome, testing::Contains, testing::ElementsAre, testing::HasSubstr,
    testing::Not;
namespace fs = std::filesystem;

class Killed : public testing::Test {
 protected:
  Killed() { copy_tutorial(place_); }

  /// Runs it to its end once, and then so often that it is ended somewhere within that time, or just behind
  /// it.
  /// @param check after each
  void at_moments(const std::string& command, const std::string& signal, int count, const auto& check) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    ASSERT_EQ(shell(place_, command).code, 0);
    const double whole = std::chrono::duration<double>(Clock::now() - start).count();
    check("the whole run");
    std::mt19937 engine(22);
    std::uniform_real_distribution<double> moment(0.0, 1.2 * whole);
    for (int i = 0; i < count; ++i) {
      const Outcome outcome = shell(
          place_, fmt::format("timeout -s {} {:.3f} {}", signal, std::max(0.001, moment(engine)), command));
      check(fmt::format("run {} of {}: {}", i + 1, command, outcome.err));
    }
  }

  bool exists(const std::string& name) const { return fs::exists(place_.folder() / name); }

  apps::Workplace place_;
};

class KilledBy : public Killed, public testing::WithParamInterface<const char*> {};

TEST_P(KilledBy, ResultsAreWholeOrAbsent) {
  ASSERT_EQ(shell(place_, "\"$beamid\" modes --out whole").code, 0);
  at_moments("\"$beamid\" modes --out r", GetParam(), moments(4, 70), [&](const std::string& which) {
    if (exists("r")) {
      for (const auto& entry : fs::directory_iterator(place_.folder() / "whole"))
        EXPECT_TRUE(exists("r/" + entry.path().filename().string())) << which;
    }
    fs::remove_all(place_.folder() / "r");
  });
  ASSERT_EQ(shell(place_, "\"$beamid\" modes --out r").code, 0);
  for (const auto& entry : fs::directory_iterator(place_.folder() / "whole")) {
    if (entry.path().filename() == "timing.json") continue;
    EXPECT_EQ(contents(entry.path()), contents(place_.folder() / "r" / entry.path().filename()))
        << entry.path();
  }
  EXPECT_THAT(place_.files(), Not(Contains(HasSubstr(".partial-"))));
}

INSTANTIATE_TEST_SUITE_P(Signals, KilledBy, testing::Values("KILL", "INT", "TERM"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST_F(Killed, StatesAreWholeOrAsTheyWere) {
  const std::string command =
      "\"$beamid\" stream --config cantilever.toml --save-state state <tip_acceleration.csv >/dev/null";
  at_moments(command, "KILL", moments(6, 200), [&](const std::string& which) {
    const Outcome resumed = shell(place_, "\"$beamid\" stream --config cantilever.toml --resume state");
    EXPECT_EQ(resumed.code, 0) << which << resumed.err;
  });
  ASSERT_EQ(shell(place_, command).code, 0);
  EXPECT_THAT(place_.files(), Not(Contains(HasSubstr("state."))));
}

TEST_F(Killed, SweepsGoOnFromEveryMomentToTheSameBytes) {
  std::string rig = contents(apps::source("docs/tutorials/13_sweeps/rig.toml"));
  place_.write("rig.toml", rig.replace(rig.find("seeds = 200"), 11, "seeds = 20"));
  const std::string sweep = "\"$beamid\" sweep --config rig.toml --threads 2 --no-progress --out ";
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(shell(place_, sweep + "whole").code, 0);
  const double whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::mt19937 engine(23);
  std::uniform_real_distribution<double> moment(0.02, 1.5 * whole);
  int killed = 0;
  for (const int least = moments(6, 200); killed < least; fs::remove_all(place_.folder() / "swept"))
    for (int code = -1; code != 0; killed += code != 0) {
      const Outcome outcome =
          shell(place_, fmt::format("timeout -s KILL {:.3f} {}swept --resume", moment(engine), sweep));
      code = outcome.code;
      ASSERT_TRUE(code == 0 || code == 137) << outcome.err;
      if (code != 0) continue;
      for (const char* name : {"cases.csv", "results.json", "report.html"})
        EXPECT_EQ(contents(place_.folder() / "whole" / name), contents(place_.folder() / "swept" / name))
            << name;
    }
  EXPECT_THAT(place_.files(), Not(Contains(HasSubstr(".partial"))));
}

TEST_F(Killed, OfTwoOnOneFolderOneWinsAndTheOtherSaysSo) {
  const Outcome outcome =
      shell(place_,
            "\"$beamid\" modes --out r >/dev/null 2>one & \"$beamid\" modes --out r >/dev/null 2>two\n"
            "second=$?; wait $!; echo $? $second | tr ' ' '\\n' | sort; cat one two >&2");
  EXPECT_EQ(outcome.out, "0\n2\n") << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("output folder 'r' is not empty"));
  EXPECT_TRUE(exists("r/report.html"));
}

}  // namespace
}  // namespace beamid::reliability::killed_test
