// Disks that are full or closed to writing, shells that are bare or foreign: a message where it cannot be
// done, the same bytes where it can. Oracles: the exit code, the folder's listing, the run in plain
// surroundings.
#include <gmock/gmock.h>
#include <unistd.h>

#include <ctime>

#include "tests/reliability/shell.hpp"

namespace beamid::reliability::surroundings_test {
namespace {

using apps::contents, apps::Outcome, testing::Contains, testing::EndsWith, testing::HasSubstr, testing::Not,
    testing::StartsWith;
namespace fs = std::filesystem;

class Surroundings : public testing::Test {
 protected:
  Surroundings() { copy_tutorial(place_); }

  /// Two folders of results, but for what the clock says.
  void expect_same(const std::string& one, const std::string& other) const {
    for (const auto& entry : fs::directory_iterator(place_.folder() / one)) {
      const std::string name = entry.path().filename().string();
      if (name == "timing.json") continue;
      EXPECT_EQ(contents(entry.path()), contents(place_.folder() / other / name)) << name;
    }
  }

  apps::Workplace place_;
};

TEST_F(Surroundings, AFullDeviceOrAClosedOutputIsAMessage) {
  for (const char* words : {"modes", "modes --json", "list", "inspect tip_acceleration.csv"})
    for (const char* to : {">/dev/full", ">&-"}) {
      const Outcome outcome = shell(place_, std::string("\"$beamid\" ") + words + " " + to);
      EXPECT_EQ(outcome.code, 1) << words << to;
      EXPECT_EQ(outcome.err, "beamid: standard output cannot be written\n") << words << to;
    }
}

// The signal SIGXFSZ ended the program without a word, and left what it had written.
TEST_F(Surroundings, TheLargestSizeOfAFileIsAMessageAndNothingIsLeft) {
  const std::vector<std::string> before = place_.files();
  for (const char* words : {"modes --out r", "identify --config cantilever.toml --out r",
                            "stream --config cantilever.toml --save-state s <tip_acceleration.csv"}) {
    const Outcome outcome =
        shell(place_, std::string("ulimit -f 2\n\"$beamid\" ") + words + " | cat >/dev/null\n");
    EXPECT_THAT(outcome.err, HasSubstr("File too large")) << words;
    EXPECT_EQ(place_.files(), before) << words;
  }
}

// Oracle: a file system of this size. Its figures and tables need more than any of them.
TEST_F(Surroundings, AFullDiskLeavesTheEarlierResults) {
  place_.write("full.sh",
               "mkdir disk\nmount -t tmpfs -o size=1m none disk 2>/dev/null || exit 77\n"
               "\"$1\" modes --modes 3 --out disk/r >/dev/null; echo $?\n"
               "for kb in 100 300 500; do\nhead -c ${kb}k /dev/zero >disk/fill\n"
               "\"$1\" identify --config cantilever.toml --out disk/r --force >/dev/null; echo $?\n"
               "grep -c command.*modes disk/r/results.json; ls -A disk\ndone\n");
  const Outcome outcome = shell(place_, "unshare -m sh full.sh \"$beamid\" || exit 77");
  if (outcome.code == 77) GTEST_SKIP() << "no file system may be mounted here";
  const std::string failed = "1\n1\nfill\nr\n";
  EXPECT_EQ(outcome.out, "0\n" + failed + failed + failed) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("No space left on device"));
}

TEST_F(Surroundings, AFolderClosedToWritingIsKnownBeforeTheWork) {
  fs::permissions(place_.folder().parent_path(), fs::perms::owner_all | fs::perms::others_exec);
  fs::permissions(place_.folder(), fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                                       fs::perms::others_exec);
  const std::string as_nobody = geteuid() == 0 ? "setpriv --reuid 65534 --regid 65534 --clear-groups " : "";
  if (shell(place_, as_nobody + "\"$beamid\" --version >/dev/null").code != 0)
    GTEST_SKIP() << "the command cannot be run as another user";
  for (const char* words :
       {"modes --out r", "sweep --config cantilever.toml --vary damping.ratio=0.1,0.2 --out r",
        "stream --config cantilever.toml --save-state s"}) {
    const Outcome outcome = shell(place_, as_nobody + "\"$beamid\" " + words);
    EXPECT_EQ(outcome.code, 1) << words;
    EXPECT_THAT(outcome.err, HasSubstr("Permission denied")) << words;
    EXPECT_EQ(outcome.out, "") << words;
  }
  fs::permissions(place_.folder(), fs::perms::owner_all);
}

TEST_F(Surroundings, NoHomeNoEnvironmentAndDecimalCommasChangeNothing) {
  const std::string words = "\"$beamid\" identify --config cantilever.toml --out ";
  ASSERT_EQ(shell(place_, words + "plain").code, 0);
  ASSERT_EQ(shell(place_, "env -i PATH=\"$PATH\" HOME=/nowhere " + words + "bare").code, 0);
  expect_same("plain", "bare");
  // The C library itself leaks what it reads of LOCPATH.
  const Outcome german =
      shell(place_,
            "localedef -i de_DE -f UTF-8 ./de_DE.UTF-8 2>/dev/null >&2; [ -d de_DE.UTF-8 ] || exit 77\n"
            "export LOCPATH=\"$PWD\" LC_ALL=de_DE.UTF-8 ASAN_OPTIONS=detect_leaks=0; bash -c 'printf %.1f "
            "1,5' >number; grep -qx 1,5 number || exit 77\n" +
                words + "german");
  if (german.code == 77) GTEST_SKIP() << "no locale with decimal commas can be made here";
  EXPECT_EQ(contents(place_.folder() / "number"), "1,5");
  ASSERT_EQ(german.code, 0) << german.err;
  expect_same("plain", "german");
}

// Oracle: the run beside a clock that goes on; date shows that this one does not.
TEST_F(Surroundings, AClockThatJumpsChangesNothing) {
  if (sanitized) GTEST_SKIP() << "under sanitizers";
  const Outcome dates = shell(place_, "export LD_PRELOAD='" BEAMID_JUMPING_CLOCK "'\ndate +%s; date +%s%N");
  ASSERT_GT(std::stoll(dates.out), 86400 * 39 + static_cast<long long>(std::time(nullptr)));
  fs::copy(apps::source("docs/tutorials/13_sweeps/rig.toml"), place_.folder());
  for (const std::string words : {"identify --config cantilever.toml", "sweep --config rig.toml --seeds 3"}) {
    fs::remove_all(place_.folder() / "plain");
    fs::remove_all(place_.folder() / "leapt");
    ASSERT_EQ(shell(place_, "\"$beamid\" " + words + " --out plain").code, 0);
    const Outcome leapt =
        shell(place_, "LD_PRELOAD='" BEAMID_JUMPING_CLOCK "' \"$beamid\" " + words + " --out leapt");
    ASSERT_EQ(leapt.code, 0) << leapt.err;
    expect_same("plain", "leapt");
  }
}

TEST_F(Surroundings, PathsMayHoldWhatAShellTakesForACommand) {
  const std::string odd = "it's \"odd\" $(touch OWNED) `touch OWNED` & \\ ξ.d";
  fs::create_directory(place_.folder() / odd);
  copy_tutorial(place_, odd);
  place_.write("odd.sh",
               "\"$1\" identify --config \"$2/cantilever.toml\" --out \"$2/r\" >/dev/null &&\n"
               "\"$1\" report \"$2/r\" --out \"$2/page.html\" >/dev/null\n");
  place_.write("name", odd);
  const Outcome outcome = shell(place_, "sh odd.sh \"$beamid\" \"$(cat name)\"");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(place_.folder() / odd / "r/convergence.svg"));
  EXPECT_TRUE(fs::exists(place_.folder() / odd / "page.html"));
  EXPECT_THAT(place_.files(), Not(Contains(EndsWith("OWNED"))));
}

TEST_F(Surroundings, WithoutABrowserThereIsAMessageAndNoPage) {
  ASSERT_EQ(shell(place_, "\"$beamid\" modes --out r").code, 0);
  const Outcome outcome = shell(place_, "PATH=/nowhere \"$beamid\" report r --pdf page.pdf");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, StartsWith("beamid: a PDF is printed by a browser"));
  EXPECT_THAT(place_.files(), Not(Contains(HasSubstr("page.pdf"))));
}

}  // namespace
}  // namespace beamid::reliability::surroundings_test
