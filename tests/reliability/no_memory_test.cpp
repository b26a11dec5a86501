// An allocation that fails, by a library put before the C library's (failing_malloc.c): one after the other
// of those that main() makes. Oracles: the exit code; where the command goes on without that memory, what it
// says with all of it.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include "tests/reliability/moments.hpp"
#include "tests/reliability/shell.hpp"

namespace beamid::reliability::no_memory_test {
namespace {

using apps::Outcome, apps::Workplace;

struct Command {
  const char* name;
  const char* words;
};

class NoMemory : public testing::TestWithParam<Command> {
 protected:
  NoMemory() {
    copy_tutorial(place_);
    whole_ = run("");
  }

  Outcome run(const std::string& environment) const {
    return shell(place_, environment + " \"$beamid\" " + GetParam().words);
  }

  /// All `number` and, where `always`, all behind it fail.
  void expect_a_message(long number, bool always) {
    const std::string environment = fmt::format("LD_PRELOAD='" BEAMID_FAILING_MALLOC "' FAIL_AT={} {}",
                                                number, always ? "FAIL_ALWAYS=1" : "");
    const Outcome outcome = run(environment);
    const std::string which = fmt::format("allocation {}{}", number, always ? " and all behind it" : "");
    failures_ += outcome.code != 0;
    if (outcome.code == 0) {
      EXPECT_EQ(outcome.out, whole_.out) << which;
      return;
    }
    EXPECT_TRUE(outcome.code == 1 || outcome.code == 2) << which << ": " << outcome.code;
    EXPECT_NE(outcome.err, "") << which;
  }

  void SetUp() override {
    if (sanitized) GTEST_SKIP() << "under sanitizers";
  }

  Workplace place_;
  Outcome whole_;
  int failures_ = 0;
};

TEST_P(NoMemory, IsAMessage) {
  ASSERT_EQ(whole_.code, 0) << whole_.err;
  const int all = 1000, step = all / moments(10, all);
  for (int number = 1; number <= all; number += step) {
    expect_a_message(number, false);
    expect_a_message(number, true);
  }
  for (long number = 2000; number < 1000000; number *= 3)  // in the midst of the work
    expect_a_message(number, true);
  EXPECT_GT(failures_, 10);
}

INSTANTIATE_TEST_SUITE_P(
    In, NoMemory,
    testing::Values(Command{"Modes", "modes --config cantilever.toml"},
                    Command{"Identify", "identify --config cantilever.toml"},
                    Command{"Inspect", "inspect tip_acceleration.csv"},
                    Command{"Stream",
                            "stream --config cantilever.toml --save-state s <tip_acceleration.csv"}),
    [](const auto& command) { return std::string(command.param.name); });

}  // namespace
}  // namespace beamid::reliability::no_memory_test
