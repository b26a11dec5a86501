// What every command says beside its numbers. Oracles: a beam is no higher than a fifth of its length; the
// stamps written are uneven; a filter that was given a hundredth of the frequency has lost its records.
#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::reported_warnings_test {
namespace {

using nlohmann::json, testing::HasSubstr, testing::Not;

const char* const stout_beam =
    "[beam]\nlength_m = 10\nwidth_m = 0.5\nheight_m = 2.1\nyoungs_modulus_pa = 2.12e11\n"
    "density_kg_per_m3 = 7850\n[damping]\nratio = 0.0045\n";

class Warned : public testing::TestWithParam<const char*> {};

TEST_P(Warned, OfImplausibleUnitsFirst) {
  Workplace place;
  place.write("beam.toml", stout_beam);
  const Outcome outcome = place.run(GetParam());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out.substr(0, 600),
              HasSubstr("Implausible, check the units: the beam's height of 2.1 m"));
}
INSTANTIATE_TEST_SUITE_P(Studies, Warned,
                         testing::Values("atlas --config beam.toml",
                                         "noise --config beam.toml --trials 2 --modes 1"));

TEST(Frame, IsWarnedOfImplausibleUnitsFirst) {
  Workplace place;
  place.write("frame.toml",
              "[frame]\njoints = [{ x_m = 0, y_m = 0 }, { x_m = 2, y_m = 0 }]\n"
              "[[frame.members]]\nfirst = 1\nsecond = 2\nwidth_m = 20\nheight_m = 2\n"
              "youngs_modulus_pa = 212\ndensity_kg_per_m3 = 7850\n"
              "[[frame.supports]]\njoint = 1\nkind = \"clamped\"\n");
  const Outcome outcome = place.run("frame frame.toml");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("member 1: the height of 2 m is more than a fifth of the frame's length"));
  EXPECT_THAT(outcome.out, HasSubstr("member 1: the Young's modulus is 212 Pa"));
}

const char* const cantilever =
    "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\n"
    "mass_kg = 3.055\ntip_mass_kg = 0.36\n[damping]\nratio = 0.0045\n";

/// A decay at 3.4555 Hz, its stamps moved by up to a third of their interval.
std::string uneven_decay(double phase) {
  std::ostringstream text;
  text.precision(12);
  text << "time_s,acceleration_m_per_s2\n";
  for (int k = 0; k < 2000; ++k) {
    const double time = 0.005 * (k + 0.3 * std::sin(1.7 * k * k + phase)), w = 2 * M_PI * 3.4555,
                 noise = 0.01 * std::sin(12.9898 * k + 78.233 * std::sin(3.1 * k + phase));
    text << time << "," << std::exp(-0.0045 * w * time) * std::cos(w * time + phase) + noise << "\n";
  }
  return text.str();
}

class UnevenRecords : public testing::TestWithParam<const char*> {};

TEST_P(UnevenRecords, AreSaidToBeResampled) {
  Workplace place;
  place.write("cantilever.toml", cantilever);
  place.write("a.csv", uneven_decay(0.1));
  place.write("b.csv", uneven_decay(0.7));
  const Outcome outcome = place.run(GetParam());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("The stamps are uneven"));
}
INSTANTIATE_TEST_SUITE_P(Commands, UnevenRecords,
                         testing::Values("identify a.csv --config cantilever.toml",
                                         "identify a.csv b.csv --config cantilever.toml",
                                         "check a.csv --config cantilever.toml"));

}  // namespace
}  // namespace beamid::apps::reported_warnings_test
