// Oracle: the numbers counted; of the rate only that it is there, as it depends on the clock.
#include "experiments/text/progress.hpp"

#include <gmock/gmock.h>

#include <thread>
#include <vector>

namespace beamid::experiments::countdown_test {
namespace {

using testing::ElementsAre, testing::MatchesRegex, testing::SizeIs;

class Countdowns : public testing::Test {
 protected:
  std::vector<std::string> shown_;
  const Progress progress_ = [this](const std::string& what) { shown_.push_back(what); };
};

TEST_F(Countdowns, SayHowManyOfHowManyHowFastAndHowLong) {
  Countdown countdown(progress_, 1000, "cases", 100);
  countdown.count(37);
  EXPECT_THAT(shown_,
              ElementsAre(MatchesRegex("137 of 1000 cases, [0-9.e+]+ per second, [0-9]+ s remaining")));
}

TEST_F(Countdowns, NameThePartOfTheWork) {
  Countdown countdown(progress_, 20, "trials");
  countdown.begin("beam A");
  countdown.count(5);
  countdown.begin("beam B");
  ASSERT_THAT(shown_, SizeIs(2));  // counting shows itself a few times a second only
  EXPECT_EQ(shown_[0], "beam A: 0 of 20 trials");
  EXPECT_THAT(shown_[1], MatchesRegex("beam B: 5 of 20 trials, .* remaining"));
}

TEST_F(Countdowns, DoNotCountToOne) {
  Countdown countdown(progress_, 1, "runs");
  countdown.begin("rayleigh, ekf");
  EXPECT_THAT(shown_, ElementsAre("rayleigh, ekf"));
}

TEST_F(Countdowns, LoseNoCountFromManyThreads) {
  Countdown countdown(progress_, 8000, "runs");
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 2000; ++k) countdown.count();
    });
  for (std::thread& thread : threads) thread.join();
  countdown.begin("end");
  EXPECT_THAT(shown_.back(), MatchesRegex("end: 8000 of 8000 runs, .*, 0 s remaining"));
}

TEST(DurationText, TakesTheUnitsThatSuit) {
  EXPECT_EQ(duration_text(12.4), "12 s");
  EXPECT_EQ(duration_text(70), "1 min 10 s");
  EXPECT_EQ(duration_text(7380), "2 h 3 min");
}

}  // namespace
}  // namespace beamid::experiments::countdown_test
