// Oracles: exact roots. At the tip of a cantilever anti-resonances are the frequencies of the clamped-pinned
// beam.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/apps/run_command.hpp"
#include "tests/apps/study_beam.hpp"

namespace beamid::apps::frf_test {
namespace {

using nlohmann::json, std::numbers::pi, testing::HasSubstr, testing::StartsWith;

TEST(Frf, FindsResonancesAndAntiResonances) {
  for (const char* words :
       {"frf --json --elements 100 --to 100", "frf --json --elements 100 --to 100 --damping-ratio 1e-4"}) {
    const Outcome outcome = Workplace().run(words);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json pair = json::parse(outcome.out)["pairs"][0];
    ASSERT_EQ(pair["resonances"].size(), 3u) << words;
    ASSERT_EQ(pair["anti_resonances"].size(), 2u) << words;
    const double resonances[] = {1.875104068711961, 4.694091132974175, 7.854757438237613};
    const double anti_resonances[] = {3.926602312047919, 7.068582745628732};
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(
          pair["resonances"][i]["frequency_hz"].get<double>() / study_beam_frequency_hz(resonances[i]), 1.0,
          1e-6);
    for (int i = 0; i < 2; ++i)
      EXPECT_NEAR(pair["anti_resonances"][i]["frequency_hz"].get<double>() /
                      study_beam_frequency_hz(anti_resonances[i]),
                  1.0, 1e-5);
  }
}

TEST(Frf, BeginsAtTheStaticDeflection) {
  Workplace place;
  const Outcome outcome = place.run("frf --damping-ratio 0.01 --from 0.01 --out results");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string text = contents(place.folder() / "results" / "frf.csv");
  EXPECT_THAT(text,
              StartsWith("frequency_hz,real_m_per_n,imaginary_m_per_n,magnitude_m_per_n,phase_rad\n0.01,"));
  const double real = std::stod(text.substr(text.find("\n0.01,") + 6));
  EXPECT_NEAR(real * 3 * 228.96 / std::pow(1.1, 3), 1.0, 2e-5);  // (f / f1)^2 = 6e-6
  for (const char* file : {"frf_plot.svg", "frf_plot.png", "resonances.csv", "results.json"})
    EXPECT_TRUE(fs::exists(place.folder() / "results" / file)) << file;
}

// At resonance a single mode's receptance is 1 / (2 xi K) of its own stiffness; the others add a per cent.
TEST(Frf, ShowsTheHeightOfAResonance) {
  const json found = json::parse(Workplace().run("frf --json --damping-ratio 0.01 --to 8").out);
  const double modal_mass = 3.055 / 4, omega = 2 * pi * study_beam_frequency_hz(1.875104068711961);
  EXPECT_NEAR(found["pairs"][0]["resonances"][0]["magnitude_m_per_n"].get<double>() * 0.02 * modal_mass *
                  omega * omega,
              1.0, 1e-3);
}

// Force here, motion there, or the other way round: [rayleigh1877].
TEST(Frf, IsReciprocal) {
  Workplace place;
  place.write(
      "pairs.toml",
      "beam = { length_m = 1, bending_stiffness_n_m2 = 10, mass_kg = 2 }\ndamping = { law = \"structural\", "
      "loss_factor = 0.02 }\n[frequency_response]\nkind = \"mobility\"\npoints = 50\npairs = [{ input_m = "
      "0.3, output_m = 1 }, { input_m = 1, output_m = 0.3 }]\n");
  const Outcome outcome = place.run("frf --config pairs.toml --out results --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(contents(place.folder() / "results" / "frf.csv"), HasSubstr("x0_3m_to_tip_real_m_per_n_s"));
  const json pairs = json::parse(outcome.out)["pairs"];
  ASSERT_FALSE(pairs[0]["resonances"].empty());
  for (std::size_t i = 0; i < pairs[0]["resonances"].size(); ++i)
    EXPECT_NEAR(pairs[0]["resonances"][i]["magnitude_m_per_n_s"].get<double>() /
                    pairs[1]["resonances"][i]["magnitude_m_per_n_s"].get<double>(),
                1.0, 1e-9);
}

TEST(Frf, SumsModesWhereTheLawHasNoMatrix) {
  const json ratios = json::parse(Workplace().run("frf --json --damping-ratio 0.01").out);
  EXPECT_EQ(ratios["method"], "modal");
  EXPECT_EQ(json::parse(Workplace().run("frf --json").out)["method"], "direct");
}

// Twenty equal storeys, f_j = sqrt(k / m) sin((2 j - 1) pi / 82) / pi, at fifty frequencies: up to four modes
// lie between two of them, and every one is found.
TEST(Frf, FindsResonancesBetweenItsFrequencies) {
  Workplace place;
  std::string masses, stiffnesses;
  for (int i = 0; i < 20; ++i) masses += i > 0 ? ", 1000" : "1000", stiffnesses += i > 0 ? ", 2e6" : "2e6";
  for (const std::string damping : {"", "[damping]\nratio = 0.001\n"}) {
    place.write("chain.toml", "[chain]\nmasses_kg = [" + masses + "]\nstiffnesses_n_per_m = [" + stiffnesses +
                                  "]\n" + damping +
                                  "[frequency_response]\npoints = 50\nfrom_hz = 0.1\nto_hz = 15\n"
                                  "pairs = [{ input_m = 20, output_m = 20 }]\n");
    const Outcome outcome = place.run("frf --config chain.toml --json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json found = json::parse(outcome.out);
    const json& resonances = found["pairs"][0]["resonances"];
    ASSERT_EQ(resonances.size(), 20u) << damping;
    for (int j = 1; j <= 20; ++j)
      EXPECT_NEAR(resonances[j - 1]["frequency_hz"].get<double>(),
                  std::sqrt(2000.0) * std::sin((2 * j - 1) * pi / 82) / pi, damping.empty() ? 1e-9 : 0.02);
    EXPECT_EQ(found["pairs"][0]["anti_resonances"].size(), 19u) << damping;
    if (damping.empty()) continue;
    EXPECT_THAT(found["messages"].dump(), HasSubstr("shows less than half"));
  }
}

TEST(Frf, WarnsOfResonancesThatTheSumLacks) {
  Workplace place;
  place.write("sum.toml",
              "[chain]\nmasses_kg = [1000, 1000, 1000]\nstiffnesses_n_per_m = [2e6, 2e6, 2e6]\n"
              "[damping]\nratio = 0.01\n[frequency_response]\nmodes = 1\nto_hz = 20\n");
  EXPECT_THAT(json::parse(place.run("frf --config sum.toml --json").out)["messages"].dump(),
              HasSubstr("1 modes are summed, and 3 natural frequencies lie up to 20 Hz"));
}

TEST(Frf, RefusesAPointThatCannotMove) {
  Workplace place;
  place.write(
      "bad.toml",
      "beam = { length_m = 1, bending_stiffness_n_m2 = 10, mass_kg = 2 }\n[frequency_response]\npairs = [{ "
      "input_m = 0 }]\n");
  const Outcome outcome = place.run("frf --config bad.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.first_error_line(),
            "bad.toml: point 'root' is held by a support; expected one that can move");
}

// Nothing holds it there: any force moves it without end.
TEST(Frf, RefusesNoFrequencyOfAFreeBody) {
  Workplace place;
  place.write("free.toml",
              "[beam]\nlength_m = 1\nbending_stiffness_n_m2 = 10\nmass_kg = 1\nsupport = \"free-free\"\n"
              "[frequency_response]\nfrom_hz = 0\nto_hz = 50\nspacing = \"linear\"\n");
  const Outcome outcome = place.run("frf --config free.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.first_error_line(), HasSubstr("frequency_response.from_hz is 0, where a structure"));
}

}  // namespace
}  // namespace beamid::apps::frf_test
