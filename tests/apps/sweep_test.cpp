// Oracle: the same sweep in one piece, on one thread, without interruption.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <unistd.h>

#include <map>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::sweep_test {
namespace {

using testing::HasSubstr, testing::IsEmpty;

// Small enough for some hundred cases per second.
constexpr const char* rig = R"([beam]
length_m = 1.10
width_m = 0.060
height_m = 0.006
youngs_modulus_pa = 2.12e11
mass_kg = 3.055
tip_mass_kg = 0.36
elements = 8
[damping]
ratio = 0.01
[[sensors]]
quantity = "displacement"
noise_m = 0.0003
[simulation]
duration_s = 4
sampling_rate_hz = 40
[reduction]
method = "modal_truncation"
[compare]
passes = 1
[sweep]
vary = ["damping.ratio=0.005,0.02"]
)";

/// Names of files that hold results, and what is in them; clock and command line left out.
std::map<std::string, std::string> results_in(const fs::path& folder) {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name != "timing.json" && name != "report.html") found[name] = contents(entry.path());
  }
  return found;
}

void expect_same(const Workplace& place, const std::string& one, const std::string& other) {
  const auto expected = results_in(place.folder() / one), found = results_in(place.folder() / other);
  EXPECT_TRUE(expected.contains("cases.csv") && expected.contains("cases.h5"));
  for (const auto& [name, text] : expected)
    EXPECT_TRUE(found.contains(name) && found.at(name) == text) << name << " differs";
  EXPECT_EQ(expected.size(), found.size());
}

class Sweep : public testing::Test {
 protected:
  Sweep() { place_.write("rig.toml", rig); }
  Outcome sweep(const std::string& words) const { return place_.run("sweep --config rig.toml " + words); }
  void expect_success(const Outcome& outcome) const { EXPECT_EQ(outcome.code, 0) << outcome.err; }

  Workplace place_;
};

TEST_F(Sweep, CountsBeamsWithoutAMotionAsDiverged) {
  const Outcome outcome = sweep("--seeds 2 --vary beam.height_m=1e12");
  expect_success(outcome);
  EXPECT_THAT(outcome.out, HasSubstr("cases diverged; the first, case 0: the reproduced motion grows"));
}

TEST_F(Sweep, IsTheSameOnAnyNumberOfThreads) {
  expect_success(sweep("--seeds 8 --threads 1 --out one"));
  expect_success(sweep("--seeds 8 --threads 3 --out three"));
  expect_same(place_, "one", "three");
  EXPECT_EQ(contents(place_.folder() / "one/report.html"), contents(place_.folder() / "three/report.html"));
}

// Not SIGINT: a shell ignores that for what it starts in the background. Both are handled alike.
TEST_F(Sweep, SaysWhatIsKeptWhenItIsInterrupted) {
  place_.write("stop.sh",
               "\"$1\" sweep --config rig.toml --seeds 3000 --threads 1 --out broken 2>said & started=$!\n"
               "until [ \"$(wc -l 2>/dev/null <broken.partial/cases.csv || echo 0)\" -gt 8 ]; do :; done\n"
               "kill -TERM $started\nwait $started\necho $? >code\n");
  place_.run("--version >version; sh stop.sh '" BEAMID_COMMAND "'");
  EXPECT_EQ(contents(place_.folder() / "code"), "143\n");
  EXPECT_THAT(
      contents(place_.folder() / "said"),
      testing::MatchesRegex("\ninterrupted; [0-9]+ of 6000 cases are kept in 'broken.partial': the same "
                            "command with --resume goes on\n"));
}

TEST_F(Sweep, GoesOnWhereItWasKilled) {
  expect_success(sweep("--seeds 60 --out whole"));
  place_.write("kill.sh",
               "\"$1\" sweep --config rig.toml --seeds 60 --threads 1 --out broken & started=$!\n"
               "until [ \"$(wc -l 2>/dev/null <broken.partial/cases.csv || echo 0)\" -gt 8 ]; do :; done\n"
               "kill -9 $started\n"
               "wait $started\n"
               "printf '110,1,2,111,0.0' >>broken.partial/cases.csv\n");
  place_.run("--version >version; sh kill.sh '" BEAMID_COMMAND "'");
  ASSERT_FALSE(fs::exists(place_.folder() / "broken"));
  EXPECT_EQ(sweep("--seeds 60 --out broken").code, 2);
  EXPECT_EQ(sweep("--seeds 59 --out broken --resume").code, 2);
  expect_success(sweep("--seeds 60 --out broken --resume"));
  expect_same(place_, "whole", "broken");
  EXPECT_FALSE(fs::exists(place_.folder() / "broken.partial"));
}

// flock holds the journal as a sweep that is running would.
TEST_F(Sweep, LeavesASweepThatIsRunningAlone) {
  fs::create_directory(place_.folder() / "out.partial");
  expect_success(sweep("--seeds 2 --out once"));
  for (const char* name : {"manifest.json", "cases.csv"})
    fs::copy(place_.folder() / "once" / name, place_.folder() / "out.partial");
  const std::string before = contents(place_.folder() / "out.partial/cases.csv");
  const int running = open((place_.folder() / "out.partial/cases.csv").c_str(), O_RDWR);
  ASSERT_EQ(flock(running, LOCK_EX | LOCK_NB), 0);
  for (const char* words :
       {"--seeds 2 --out out", "--seeds 2 --out out --force", "--seeds 2 --out out --resume"}) {
    const Outcome outcome = sweep(words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_THAT(outcome.first_error_line(), HasSubstr("running")) << words;
  }
  EXPECT_EQ(contents(place_.folder() / "out.partial/cases.csv"), before);
  close(running);
  expect_success(sweep("--seeds 2 --out out --force"));
}

// Oracle: one thread. So little memory has no room for the stacks of 200 threads.
TEST_F(Sweep, TakesFewerThreadsWhereTheSystemRefusesThem) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "under sanitizers, which take terabytes of addresses";
#endif
  expect_success(sweep("--seeds 120 --threads 1 --out one"));
  const Outcome outcome =
      place_.run("sweep --config rig.toml --seeds 120 --threads 200 --out many", "ulimit -v 1200000;");
  expect_success(outcome);
  expect_same(place_, "one", "many");
}

// A limit on the size of files stands for a full disk: the write fails halfway.
TEST_F(Sweep, GoesOnAfterAFullDisk) {
  expect_success(sweep("--seeds 20 --out whole"));
  place_.write("full.sh",
               "trap '' XFSZ\nulimit -f 4\n"
               "\"$1\" sweep --config rig.toml --seeds 20 --out broken >/dev/null; echo $?\n");
  const Outcome full = place_.run("--version >version; sh full.sh '" BEAMID_COMMAND "'");
  EXPECT_EQ(full.out, "1\n");
  EXPECT_THAT(full.err, HasSubstr("finished cases are kept, --resume goes on with them"));
  EXPECT_FALSE(fs::exists(place_.folder() / "broken"));
  expect_success(sweep("--seeds 20 --out broken --resume"));
  expect_same(place_, "whole", "broken");
  expect_success(sweep("--seeds 20 --out broken --resume"));  // nothing is left to do
  expect_same(place_, "whole", "broken");
}

TEST_F(Sweep, IsTheSumOfItsShards) {
  expect_success(sweep("--seeds 7 --out whole"));
  for (const std::string part : {"1", "2", "3"})
    expect_success(sweep("--seeds 7 --shard " + part + "/3 --out part" + part));
  expect_success(place_.run("sweep --merge part3 part1 part2 --out joined"));
  expect_same(place_, "whole", "joined");
  const Outcome missing = place_.run("sweep --merge part1 part3");
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("5 of 14 cases are missing, the first is 1"));
  EXPECT_THAT(place_.run("sweep --merge part1 part1").err, HasSubstr("case 0 is in another folder too"));
}

class SweepByMpi : public Sweep {
 protected:
  /// On so many processes, of which the first computes nothing.
  Outcome sweep_on(int processes, const std::string& words) const {
    return place_.run("sweep --config rig.toml " + words, start + std::to_string(processes));
  }
  void SetUp() override {
    if (std::system("command -v mpirun >/dev/null") != 0) GTEST_SKIP() << "mpirun is not installed";
    static const Outcome outcome = sweep_on(2, "--seeds 1");  // once for all of them
    if (outcome.err.find("was built without MPI") != std::string::npos) GTEST_SKIP() << outcome.err;
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }

  // Open MPI's libraries leak a little, which builds with sanitizers would count as failures.
  const std::string start =
      "ASAN_OPTIONS=detect_leaks=0 mpirun --allow-run-as-root --oversubscribe --bind-to none -n ";
};

TEST_F(SweepByMpi, IsTheSameOnAnyNumberOfProcesses) {
  expect_success(sweep("--seeds 10 --out one"));
  for (const int processes : {2, 3}) {
    const std::string folder = std::to_string(processes);
    const Outcome outcome = sweep_on(processes, "--seeds 10 --out " + folder);
    expect_success(outcome);
    EXPECT_THAT(outcome.out, HasSubstr("Written to " + folder));
    EXPECT_EQ(outcome.out.find("Written to"), outcome.out.rfind("Written to"));  // by one process
    expect_same(place_, "one", folder);
  }
}

TEST_F(SweepByMpi, SaysOnceWhatIsWrong) {
  const Outcome outcome = sweep_on(3, "--seeds 0");
  EXPECT_EQ(outcome.code, 2);
  const std::string message = "--seeds is 0; expected a whole number";
  EXPECT_THAT(outcome.err, HasSubstr(message));
  EXPECT_EQ(outcome.err.find(message), outcome.err.rfind(message));
  EXPECT_THAT(sweep_on(2, "--threads 2").err, HasSubstr("--threads has no use under mpirun"));
}

// kill -9 of one that computes: mpirun ends the others, finished cases are kept.
TEST_F(SweepByMpi, GoesOnWhereAProcessWasKilled) {
  expect_success(sweep("--seeds 100 --out whole"));
  place_.write("kill.sh", start + "3 \"$1\" sweep --config rig.toml --seeds 100 --out broken & started=$!\n" +
                              "until [ \"$(wc -l 2>/dev/null <broken.partial/cases.csv || echo 0)\" -gt 8 ]; "
                              "do :; done\n"
                              "kill -9 $(pgrep -P $started -n)\n"
                              "wait $started\n");
  place_.run("--version >version; sh kill.sh '" BEAMID_COMMAND "'");
  ASSERT_FALSE(fs::exists(place_.folder() / "broken"));
  expect_success(sweep_on(2, "--seeds 100 --out broken --resume"));
  expect_same(place_, "whole", "broken");
}

// Oracle: the same files with another content.
TEST_F(Sweep, GoesOnOnlyWithTheFilesItBeganWith) {
  place_.write("force.csv", "time_s,force_n\n0,0\n1,2\n2,0\n3,0\n4,0\n");
  place_.write("rig.toml", std::string(rig) + "[excitation]\nkind = \"table\"\nfile = \"force.csv\"\n");
  expect_success(sweep("--seeds 2 --out swept"));
  EXPECT_THAT(contents(place_.folder() / "swept/manifest.json"), HasSubstr("\"force.csv\": \""));
  expect_success(sweep("--seeds 2 --out swept --resume"));
  expect_success(sweep("--seeds 2 --shard 1/2 --out part1"));
  place_.write("force.csv", "time_s,force_n\n0,0\n1,3\n2,0\n3,0\n4,0\n");
  const Outcome other = sweep("--seeds 2 --out swept --resume");
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("'swept' holds the results of another sweep"));
  expect_success(sweep("--seeds 2 --shard 2/2 --out part2"));
  EXPECT_EQ(place_.run("sweep --merge part1 part2").code, 2);
}

// Oracle: the same on one thread and in one piece. Shards and an interruption tear blocks apart.
TEST_F(Sweep, IdentifiesOnceTheSameHoweverItIsDivided) {
  expect_success(sweep("--once --seeds 30 --threads 1 --out one"));
  expect_success(sweep("--once --seeds 30 --threads 3 --out three"));
  expect_same(place_, "one", "three");
  for (const std::string part : {"1", "2"})
    expect_success(sweep("--once --seeds 30 --shard " + part + "/2 --out part" + part));
  expect_success(place_.run("sweep --merge part1 part2 --out joined"));
  expect_same(place_, "one", "joined");
  EXPECT_THAT(contents(place_.folder() / "one/manifest.json"), HasSubstr("\"identify\": \"once\""));
}

TEST_F(Sweep, CountsACaseThatFailsAsARow) {
  expect_success(sweep("--vary sensors[1].position_m=1.1,9 --seeds 3 --out results"));
  const std::string cases = contents(place_.folder() / "results/cases.csv");
  EXPECT_THAT(cases, HasSubstr("\n9,1,1,10,0.02,9,,,,failed,,,"));
  const auto points = nlohmann::json::parse(contents(place_.folder() / "results/results.json"))["points"];
  ASSERT_EQ(points.size(), 6u);  // two ratios; stiffness and damping where the place is on the beam
  EXPECT_EQ(points[0]["converged"], 3);
  EXPECT_EQ(points[5]["refused_or_failed"], 3);
  EXPECT_EQ(sweep("--vary sensors[1].position_m=9").code, 1);  // not one
}

TEST_F(Sweep, SaysWhatIsWrongWithThePlan) {
  const auto line = [&](const std::string& words) {
    const Outcome outcome = sweep(words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_THAT(outcome.out, IsEmpty());
    return outcome.first_error_line();
  };
  EXPECT_THAT(line("--vary beam.tip_mas_kg=1,2"),
              HasSubstr("--vary: unknown key 'tip_mas_kg' in beam; did you mean 'tip_mass_kg'?"));
  EXPECT_THAT(line("--vary beam.length_m=1:2:1"), HasSubstr("expected a whole number of steps from 2"));
  EXPECT_THAT(line("--random 5"), HasSubstr("5 random samples and no key to draw"));
  EXPECT_THAT(line("--shard 5/4"), HasSubstr("--shard is '5/4'; expected I/N"));
  EXPECT_THAT(line("--once --vary model.name=modal"), HasSubstr("takes model sdof and one reduction; found"));
  EXPECT_THAT(line("--resume"), HasSubstr("--resume needs the --out DIR"));
  place_.write("rig.toml", std::string(rig) + "seeds = 0\n");
  EXPECT_THAT(line(""), HasSubstr("rig.toml:23:9: sweep.seeds is 0; expected a whole number from 1"));
}

}  // namespace
}  // namespace beamid::apps::sweep_test
