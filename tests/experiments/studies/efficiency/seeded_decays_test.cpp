// Clean free decays of all lengths and dampings. Oracle: none may fail; 95 % of the intervals hold the truth,
// in a binomial band of 99.9 %.
#include "experiments/studies/efficiency/seeded_decays.hpp"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>

namespace beamid::experiments::seeded_decays_test {
namespace {

TEST(SeededDecays, AreAllIdentified) {
  SeededDecays settings;
  settings.runs = 100;
  settings.periods = {5, 150};
  const DecayOutcomes found = seeded_decays(settings, [](const std::string&) {});
  for (int run = 0; run < settings.runs; ++run)
    EXPECT_EQ(found.runs[static_cast<std::size_t>(run)].failure, "") << "seed " << settings.seed + run;
  const boost::math::binomial distribution(settings.runs, 0.95);
  EXPECT_GE(found.frequency_inside(), quantile(distribution, 0.0005));
  EXPECT_GE(found.damping_inside(), quantile(distribution, 0.0005));
}

// 500 periods, of which a beam 10 % off misses 50 cycles.
TEST(SeededDecays, OfManyPeriodsAreIdentifiedFromAPoorBeam) {
  SeededDecays settings;
  settings.runs = 8;
  settings.periods = {450, 500};
  settings.damping_ratio = {0.001, 0.002};
  settings.samples_per_period = {8, 10};
  settings.beam_error = {1.09, 1.1};
  EXPECT_EQ(seeded_decays(settings, [](const std::string&) {}).failed(), 0);
}

}  // namespace
}  // namespace beamid::experiments::seeded_decays_test
