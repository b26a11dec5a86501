// beamid stream on the record that ships with the project.
#include <gmock/gmock.h>

#include <sstream>

#include "tests/apps/run_command.hpp"

namespace beamid::apps {
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

TEST_F(Stream, SaysWhatIsWrongWithAState) {
  EXPECT_THAT(run("--resume no.json", "").first_error_line(), StartsWith("no.json: "));
  place_.write("bad.json", "{\"filter\": \"ekf\"}\n");
  EXPECT_THAT(run("--resume bad.json", "").first_error_line(), HasSubstr("expected what --save-state wrote"));
}

}  // namespace
}  // namespace beamid::apps
