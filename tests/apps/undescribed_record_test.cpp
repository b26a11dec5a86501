// beamid identify of a record that nobody describes, and of one in several files.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::undescribed_record_test {
namespace {

using nlohmann::json, testing::HasSubstr, testing::Not;

// Oracle: the record was simulated at 3.4555 Hz with 0.45 %; K = m (2 pi f)^2.
TEST(UndescribedRecord, GivesFrequencyAndDampingRatioAndWithAMassStiffness) {
  Workplace place;
  fs::copy(source("docs/tutorials/02_identify_a_record/tip_acceleration.csv"), place.folder() / "phone.csv");
  const Outcome alone = place.run("identify phone.csv");
  ASSERT_EQ(alone.code, 0) << alone.err;
  EXPECT_THAT(alone.out, HasSubstr("--mass KG"));
  EXPECT_THAT(alone.out, Not(HasSubstr("stiffness K")));
  EXPECT_THAT(alone.out, Not(HasSubstr("as described")));
  const json found = json_of(place.run("identify phone.csv --mass 2.5 --json"));
  const double f = found.at("frequency_hz").at("estimate"), k = found.at("stiffness_n_per_m").at("estimate");
  EXPECT_NEAR(f, 3.4555, 2e-4);
  EXPECT_NEAR(found.at("damping_ratio").at("estimate").get<double>(), 0.0045, 5e-5);
  EXPECT_NEAR(k / (2.5 * std::pow(2.0 * std::numbers::pi * f, 2)), 1.0, 1e-4);
  const Outcome both = place.run("identify phone.csv --mass 2.5 --config none.toml");
  EXPECT_EQ(both.code, 2);
}

// A file in the form of a logger, whose options are the same words for every command.
TEST(UndescribedRecord, IsDescribedByTheSameOptionsEverywhere) {
  Workplace place;
  std::ofstream file(place.folder() / "logger.txt");
  file << "Logger 7\nn|clock|tip\n";
  for (int k = 0; k < 2000; ++k)
    file << k << "|" << 5 * k << "|"
         << std::exp(-0.002 * k) * std::cos(2.0 * std::numbers::pi * 5.0 * 0.005 * k) << "\n";
  file.close();
  const std::string options =
      " logger.txt --time clock:ms --column tip --quantity acceleration --unit g --delimiter bar --decimal "
      "point "
      "--header-lines 2 --json";
  for (const std::string command : {"modal", "track", "backbone", "inspect", "identify"}) {
    const Outcome outcome = place.run(command + options);
    EXPECT_NE(outcome.code, 2) << command << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("5.00")) << command;
  }
  EXPECT_EQ(place.run("modal" + options + " --position 0.5").code, 0);
  EXPECT_EQ(place.run("modal logger.txt --position 0.5").code, 2);
  const Outcome written = place.run("inspect" + options + " --write mine.toml");
  ASSERT_EQ(written.code, 0) << written.err;
  EXPECT_THAT(place.run("modal --config mine.toml").out, HasSubstr("5.000"));
  EXPECT_EQ(place.run("inspect logger.txt --time 2:ms --write mine.toml").code, 2) << "it exists";
}

// Oracle: the same record in one file.
TEST(JoinedFiles, AreTheRecordThatOneFileHolds) {
  Workplace place;
  const auto base = [](double t) {
    return std::sin(9.0 * t) + std::sin(23.0 * t + 1.0) + std::sin(31.0 * t);
  };
  const auto floor = [](double t) { return std::sin(9.0 * t + 0.1) + 0.5 * std::sin(23.0 * t); };
  const auto write = [&](const std::string& name, double begin, int count, double rate, const auto& value) {
    std::ofstream file(place.folder() / name);
    file << "Recorder: X100\nDate: today\n\ntime_s,signal\n";
    file.precision(12);
    for (int k = 0; k < count; ++k) {
      const double t = begin + k / rate;
      file << t << "," << value(t) << "\n";
    }
  };
  write("ground.csv", 10.0, 400, 100.0, base);
  write("floor.csv", 10.5, 400, 100.0, floor);
  write("slow.csv", 10.3, 200, 50.0, floor);
  std::ofstream(place.folder() / "parts.toml")
      << "[record]\nfiles = [\"ground.csv\", \"floor.csv\", \"slow.csv\"]\nchannels = [\n"
         "{ file = 1, column = 2, quantity = \"base_acceleration\", unit = \"m/s2\" },\n"
         "{ file = 2, column = 2, quantity = \"acceleration\", unit = \"m/s2\" },\n"
         "{ file = 3, column = 2, quantity = \"acceleration\", unit = \"m/s2\" } ]\n";
  const Outcome outcome = place.run("modal --config parts.toml --method output_error --json");
  ASSERT_EQ(outcome.code, 3) << outcome.err;  // sines hold no mode
  EXPECT_THAT(outcome.out, HasSubstr("3 files joined by their stamps"));
  EXPECT_THAT(outcome.out, HasSubstr("slow is brought there from 50 Hz"));
  const Outcome wrong = place.run("modal ground.csv floor.csv --config parts.toml");
  EXPECT_EQ(wrong.code, 2);
}

}  // namespace
}  // namespace beamid::apps::undescribed_record_test
