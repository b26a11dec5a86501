// Stamps that several samples share, as whole seconds of a faster logger. Oracle: the rate of the writer.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/record/inspect/inspection.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/studies/inspect/inspection_report.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/recognised_text.hpp"

namespace beamid::experiments::shared_stamps_test {
namespace {

using testing::AllOf, testing::HasSubstr, testing::Not;

// Samples at a rate, from a second and a part of it on, each stamped by its whole second.
std::string whole_seconds(int rows, double rate, double from, bool dated) {
  return (dated ? "Date;Acc (g)\n" : "Time (s);Acc (g)\n") + signal_rows(rows, [=](int k, double a) {
           const int second = static_cast<int>(std::floor(from + k / rate + 1e-9));
           return dated ? fmt::format("2026-11-26 10:00:{:02d};{:.5f}", second, a)
                        : fmt::format("{};{:.5f}", second, a);
         });
}

TEST(SharedStamps, OfEvenCountsGiveTheRate) {
  for (const bool dated : {true, false}) {
    const Record record = recognised(whole_seconds(552, 50.0, 0.3, dated));
    ASSERT_EQ(record.size(), 552);
    EXPECT_NEAR(record.interval(), 0.02, 1e-12);
    EXPECT_NEAR(record.time[0], 0.3, 1e-9);
    EXPECT_THAT(record.remarks, testing::Contains(HasSubstr("50 samples share each stamp of 1 s")));
  }
}

TEST(SharedStamps, OfUnevenOrFewCountsAreOneQuestion) {
  const std::string uneven = whole_seconds(552, 50.2, 0.3, true);
  EXPECT_THAT(question_of(uneven), AllOf(HasSubstr("50 to 51 samples share each stamp of 1 s"),
                                         HasSubstr("--rate HZ"), HasSubstr("about 50.2 Hz")));
  RecordFormat stated;
  stated.sampling_rate = 50.2;
  EXPECT_EQ(question_of(uneven, stated), "read at 50.2 Hz");
  EXPECT_THAT(question_of(whole_seconds(200, 50.0, 0.0, true)), HasSubstr("--rate HZ"));  // four seconds
  EXPECT_THAT(question_of(whole_seconds(40, 2.0, 0.0, false)),
              HasSubstr("--rate HZ"));  // two sensors, perhaps
  std::string gap = whole_seconds(552, 50.0, 0.0, false);
  gap.erase(gap.find("\n5;") + 1, gap.find("\n6;") - gap.find("\n5;"));
  EXPECT_THAT(question_of(gap), HasSubstr("--rate HZ"));
}

TEST(SharedStamps, OfRowsThatAreWrittenTwiceAreNone) {
  std::vector<double> times, values;
  for (int k = 0; k < 100; ++k) times.push_back(0.01 * (k / 2)), values.push_back(std::sin(0.1 * (k / 2)));
  EXPECT_FALSE(shared_stamps(times, {times, values}));
  values[11] += 1.0;
  EXPECT_TRUE(shared_stamps(times, {times, values}));
}

TEST(SharedStamps, AreCountedByTheInspection) {
  const auto text_of = [](const std::string& content) {
    const TemporaryFile file("record.txt", content);
    return sampling_text(inspect(file.path(), {}));
  };
  EXPECT_THAT(text_of(whole_seconds(552, 50.0, 0.3, true)),
              AllOf(HasSubstr("50 samples share each stamp of 1 s"), HasSubstr("Evenly sampled at 50 Hz.")));
  EXPECT_THAT(text_of(whole_seconds(552, 50.2, 0.3, true)),
              AllOf(HasSubstr("50 to 51 samples share each stamp"), HasSubstr("about 50.2 Hz"),
                    HasSubstr("--rate HZ"), Not(HasSubstr("Evenly sampled"))));
}

}  // namespace
}  // namespace beamid::experiments::shared_stamps_test
