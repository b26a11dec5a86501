// beamid stream on the record that ships with the project.
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::stream_test {
namespace {

using testing::HasSubstr, testing::IsEmpty, testing::StartsWith;

/// A folder that holds the tutorial, and its record from 2 to 4 s as samples.
class Stream : public testing::Test {
 protected:
  Stream() {
    fs::copy(source("docs/tutorials/02_identify_a_record"), place_.folder(), fs::copy_options::recursive);
    std::istringstream record(contents(place_.folder() / "tip_acceleration.csv"));
    std::string line;
    for (int number = 0; std::getline(record, line); ++number)
      if (number >= 501 && number < 1001) lines_.push_back(line + "\n");
  }

  std::string part(std::size_t from, std::size_t to) const {
    std::string text;
    for (std::size_t i = from; i < to; ++i) text += lines_[i];
    return text;
  }

  /// With these samples on standard input.
  Outcome run(const std::string& words, const std::string& samples) const {
    place_.write("samples", samples);
    return place_.run("--version >version; (cat samples | '" BEAMID_COMMAND
                      "' stream --config cantilever.toml " +
                      words + ")");
  }

  Workplace place_;
  std::vector<std::string> lines_;
};

TEST_F(Stream, AnswersEverySampleWithALine) {
  const Outcome outcome = run("", part(0, 500));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, StartsWith("time_s,stiffness_n_per_m,stiffness_deviation_n_per_m,damping"));
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 501);
}

// Oracle: the stream that was not interrupted, byte for byte.
TEST_F(Stream, GoesOnWhereItWasSaved) {
  const std::string whole = run("", part(0, 500)).out;
  const std::string first = run("--save-state now.json", part(0, 200)).out;
  const std::string second = run("--resume now.json --save-state now.json", part(200, 500)).out;
  EXPECT_EQ(first + second.substr(second.find('\n') + 1), whole);
  EXPECT_EQ(nlohmann::json::parse(contents(place_.folder() / "now.json")).at("step"), 500);
}

TEST_F(Stream, PreparesTheEarlierRecordAndSaysThatSamplesAreNot) {
  place_.write("cantilever.toml", contents(place_.folder() / "cantilever.toml") +
                                      "\n[[record.prepare]]\nstep = \"high_pass\"\ncorner_hz = 1\n");
  const Outcome outcome = run("", part(0, 20));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(
      outcome.first_error_line(),
      StartsWith("The earlier record was prepared (1 step of [[record.prepare]]); samples are taken as"));
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 21);
}

TEST_F(Stream, SaysWhichSampleIsWrong) {
  const Outcome outcome = run("", lines_[0] + "2.004;1\n");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.first_error_line(), StartsWith("standard input:2:1: 1 fields; expected 2"));
  EXPECT_THAT(run("", lines_[1] + lines_[0]).first_error_line(),
              HasSubstr("standard input:2:1: the time stamp is 2 s; expected more than the one before"));
}

// The example of its own help. Oracle: what identify finds of the record behind its higher modes, K = 509.39
// and C = 0.2111. Before: C = 0.17848 +- 0.00024, 136 deviations off.
TEST_F(Stream, OfItsOwnExampleIsRightAndSaysWhenItIs) {
  const Outcome outcome = place_.run("--version >version; (cat tip_acceleration.csv | '" BEAMID_COMMAND
                                     "' stream --config cantilever.toml)");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.first_error_line(), HasSubstr("the innovations do not agree with the filter"));
  std::istringstream rows(outcome.out);
  std::string line, last;
  int settled = 0;
  while (std::getline(rows, line)) {
    last = line;
    if (!line.ends_with(",settled")) continue;
    ++settled;
    std::vector<double> fields;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',') && fields.size() < 5;)
      fields.push_back(std::stod(cell));
    ASSERT_LT(std::abs(fields[1] - 509.39), 0.02 + 5.0 * fields[2]) << line;
    ASSERT_LT(std::abs(fields[3] - 0.2111), 0.001 + 5.0 * fields[4]) << line;
  }
  EXPECT_GT(settled, 1000);
  EXPECT_THAT(last, testing::EndsWith(",settled"));
}

// Its samples settle at ten times the damping, as forward Euler's closed form says: nothing in them shows it.
TEST_F(Stream, IsNotReliedOnWhereTheEarlierRecordContradictsTheExperiment) {
  std::string experiment = contents(place_.folder() / "cantilever.toml");
  experiment.replace(experiment.find("exponential"), 11, "forward_euler");
  place_.write("cantilever.toml", experiment);
  const Outcome outcome = run("", part(0, 500));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err,
              StartsWith("The earlier record, identified alike: Filter and modal analysis disagree"));
  EXPECT_THAT(outcome.err, HasSubstr("forward_euler at 4 ms makes C 965 % too large"));
  EXPECT_THAT(outcome.err, HasSubstr("they are not to be used"));
}

TEST_F(Stream, ThatFailsHasAnExitCodeAndKeepsItsState) {
  const Outcome outcome = run("--save-state now.json", part(0, 20) + "2.08,inf\n" + part(21, 30));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("infinite"));
  EXPECT_THAT(outcome.err, HasSubstr("--on-failure inflate goes on"));
  EXPECT_EQ(nlohmann::json::parse(contents(place_.folder() / "now.json")).at("step"), 20);
}

TEST_F(Stream, KeepsItsStateWhateverEndsIt) {
  const auto step = [&] {
    const auto state = nlohmann::json::parse(contents(place_.folder() / "now.json"));
    fs::remove(place_.folder() / "now.json");
    return state.at("step");
  };
  EXPECT_EQ(run("--save-state now.json", part(0, 20) + "garbage\n").code, 2);
  EXPECT_EQ(step(), 20);
  EXPECT_EQ(run("--save-state now.json", part(0, 20) + lines_[19]).code, 2);
  EXPECT_EQ(step(), 20);
  const Outcome endless = run("--save-state now.json", part(0, 20) + std::string(70000, '7'));
  EXPECT_EQ(endless.code, 2);
  EXPECT_THAT(endless.first_error_line(),
              StartsWith("standard input:21:65537: a line of more than 65536 characters"));
  EXPECT_EQ(step(), 20);
  run("--save-state now.json | head -3", part(0, 400));
  EXPECT_GE(step(), 1);
}

class StreamInterrupted : public Stream, public testing::WithParamInterface<const char*> {};

TEST_P(StreamInterrupted, KeepsItsStateAndEndsByTheSignal) {
  place_.write("samples", part(0, 20));
  // A shell without job control ignores SIGINT for what it runs in the background: env takes that back.
  place_.write(
      "end.sh",
      "mkfifo pipe\n: >rows\n"
      "env --default-signal=INT \"$1\" stream --config cantilever.toml --save-state now.json <pipe >rows & "
      "started=$!\n"
      "exec 3>pipe\ncat samples >&3\n"
      "while kill -0 $started && [ \"$(wc -l <rows)\" -lt 21 ]; do sleep 0.01; done\n"
      "kill -$2 $started\nwait $started\necho $?\n");
  const Outcome outcome =
      place_.run("--version >version; timeout 20 sh end.sh '" BEAMID_COMMAND "' " + std::string(GetParam()));
  EXPECT_THAT(outcome.out, HasSubstr(std::string(GetParam()) == "INT"    ? "130\n"
                                     : std::string(GetParam()) == "TERM" ? "143\n"
                                                                         : "129\n"));
  EXPECT_EQ(nlohmann::json::parse(contents(place_.folder() / "now.json")).at("step"), 20);
}

INSTANTIATE_TEST_SUITE_P(Signals, StreamInterrupted, testing::Values("INT", "TERM", "HUP"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST_F(Stream, ReplacesNothingButAState) {
  const Outcome outcome = run("--save-state cantilever.toml", part(0, 20));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.first_error_line(), HasSubstr("is no state that --save-state wrote"));
}

TEST_F(Stream, SaysWhatIsWrongWithAState) {
  EXPECT_THAT(run("--resume no.json", "").first_error_line(), StartsWith("no.json: "));
  place_.write("bad.json", "{\"filter\": \"ekf\"}\n");
  EXPECT_THAT(run("--resume bad.json", "").first_error_line(), HasSubstr("expected what --save-state wrote"));
}

}  // namespace
}  // namespace beamid::apps::stream_test
