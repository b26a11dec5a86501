// Oracles: exact roots of the frequency equations, and the release amplitudes of the exact continuum (the
// five test beams of the study: 1.10 m x 60 mm x 6 mm, 2.12e11 Pa, 3.055 kg).
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "tests/apps/run_command.hpp"
#include "tests/apps/study_beam.hpp"

namespace beamid::apps::modes_test {
namespace {

using nlohmann::json, std::numbers::pi, testing::HasSubstr, testing::IsEmpty, testing::StartsWith;

struct TestBeam {
  const char* tip_mass;
  double frequency_hz, displacement_mm[3], acceleration[3];  // of modes 1 to 3, released from 12 mm
};

constexpr TestBeam five_beams[] = {
    {"0.0198575", 4.145510989755, {11.6663, 0.28420, 0.034836}, {7.915, 7.577, 7.285}},
    {"0.360490", 3.455527194845, {11.8415, 0.14519, 0.010818}, {5.582, 2.978, 1.844}},
    {"1.338090", 2.515654977346, {11.9565, 0.04123, 0.001935}, {2.987, 0.676, 0.294}},
    {"2.330965", 2.068201252526, {11.9803, 0.01879, 0.000763}, {2.023, 0.287, 0.112}},
    {"3.644615", 1.729901652424, {11.9904, 0.00917, 0.000342}, {1.417, 0.134, 0.050}}};

TEST(Modes, OfTheFiveTestBeamsAreThoseOfTheContinuum) {
  for (const TestBeam& beam : five_beams) {
    const json found =
        json_of(Workplace().run(std::string("modes --json --modes 3 --tip-mass ") + beam.tip_mass));
    const json& first = found["modes"][0];
    EXPECT_NEAR(first["frequency_hz"].get<double>() / beam.frequency_hz, 1.0, 1e-8) << beam.tip_mass;
    EXPECT_NEAR(first["exact_frequency_hz"].get<double>() / beam.frequency_hz, 1.0, 1e-12) << beam.tip_mass;
    for (int i = 0; i < 3; ++i) {  // to the digits of the table
      const json& mode = found["modes"][i];
      EXPECT_NEAR(12.0 * mode["release_displacement_fraction"].get<double>(), beam.displacement_mm[i],
                  1e-4 * beam.displacement_mm[i] + 6e-7);
      EXPECT_NEAR(0.012 * mode["release_acceleration_per_displacement_per_s2"].get<double>(),
                  beam.acceleration[i], 1e-4 * beam.acceleration[i] + 6e-4);
      EXPECT_NEAR(mode["mac_exact"].get<double>(), 1.0, 1e-9);
    }
  }
}

struct Ends {
  const char* name;
  double root;
  int rigid;
};

TEST(Modes, OfEverySupportHaveTheirExactRoots) {
  const Ends all[] = {{"clamped-clamped", 4.730040744862704, 0},
                      {"free-free", 4.730040744862704, 2},
                      {"clamped-pinned", 3.926602312047919, 0},
                      {"pinned-free", 3.926602312047919, 1},
                      {"pinned-pinned", pi, 0},
                      {"guided-guided", pi, 1},
                      {"clamped-guided", 2.365020372431352, 0},
                      {"guided-pinned", pi / 2, 0},
                      {"clamped-free", 1.875104068711961, 0}};
  for (const Ends& ends : all) {
    const json found =
        json_of(Workplace().run(std::string("modes --json --elements 100 --support ") + ends.name));
    for (int i = 0; i <= ends.rigid; ++i) {
      const json& mode = found["modes"][i];
      EXPECT_EQ(mode["rigid"], i < ends.rigid) << ends.name;
      if (i < ends.rigid) {
        EXPECT_EQ(mode["frequency_hz"], 0.0) << ends.name;
      }
      if (i == ends.rigid) {
        EXPECT_NEAR(mode["frequency_hz"].get<double>() / study_beam_frequency_hz(ends.root), 1.0, 1e-8)
            << ends.name;
      }
    }
  }
}

TEST(Modes, EstimateTheirOwnError) {
  const json found = json_of(Workplace().run("modes --json --modes 6"));
  for (const json& mode : found["modes"]) {
    const double estimate = mode["discretisation_error_estimate"], exact = mode["exact_relative_error"];
    EXPECT_NEAR(estimate / exact, 1.0, 0.05);
    EXPECT_GT(mode["digits"], 10.0);
    EXPECT_LT(mode["residual"], 1e-8);
    EXPECT_NEAR(mode["rayleigh_quotient_frequency_hz"].get<double>() / mode["frequency_hz"].get<double>(),
                1.0, 1e-10);
  }
}

// Textbooks: 61.3, 18.8 and 6.5 % of a uniform cantilever's mass move in its first modes; all of a free
// beam's in one.
TEST(Modes, TellTheirEffectiveMass) {
  const json clamped = json_of(Workplace().run("modes --json --modes 3"));
  EXPECT_NEAR(clamped["modes"][0]["effective_mass_fraction"].get<double>(), 0.6131, 1e-4);
  EXPECT_NEAR(clamped["modes"][1]["effective_mass_fraction"].get<double>(), 0.1883, 1e-4);
  EXPECT_NEAR(clamped["total_mass_kg"].get<double>(), 3.055, 1e-12);
  const json free = json_of(Workplace().run("modes --json --modes 4 --support free-free"));
  double sum = 0.0;
  for (const json& mode : free["modes"]) sum += mode["effective_mass_kg"].get<double>();
  EXPECT_NEAR(sum, 3.055, 1e-9);
}

// A rotational spring between pinned and clamped; a load towards its buckling value.
TEST(Modes, FollowTheOptions) {
  const auto first = [](const std::string& words) {
    return json_of(Workplace().run("modes --json --modes 1 " + words))["modes"][0]["frequency_hz"]
        .get<double>();
  };
  const double clamped = first("");
  EXPECT_LT(first("--root-rotational-stiffness 2e3"), clamped);
  EXPECT_NEAR(first("--root-rotational-stiffness 1e12") / clamped, 1.0, 1e-8);
  const double buckling = pi * pi * 228.96 / (4 * 1.21);
  EXPECT_NEAR(
      std::pow(first("--support pinned-pinned --axial-load 933.7881") / first("--support pinned-pinned"), 2),
      1.0 - 933.7881 / (4 * buckling), 1e-6);
  EXPECT_GT(first("--axial-load -100"), clamped);
  EXPECT_LT(first("--tip-mass 0.36 --tip-inertia 0.01 --tip-eccentricity 0.05"), first("--tip-mass 0.36"));
  EXPECT_NEAR(first("--length 2.2") / clamped, 0.25, 1e-9);      // the same steel
  EXPECT_NEAR(first("--beam-mass 12.22") / clamped, 0.5, 1e-9);  // four times the mass
  EXPECT_NEAR(first("--diameter 0.006") / first("--width 1 --height 0.006"), std::sqrt(3.0) / 2, 1e-9);
}

TEST(Modes, TakeOptionsBeforeTheFile) {
  Workplace place;
  place.write(
      "beam.toml",
      "title = \"a beam\"\n[beam]\nlength_m = 2\nbending_stiffness_n_m2 = 10\nmass_per_length_kg_per_m = 1\n"
      "elements = 10\n");
  const json changed =
      json_of(place.run("modes --json --config beam.toml --length 1 --beam-mass 4 --elements 20"));
  EXPECT_EQ(changed["configuration"]["title"], "a beam (with --length 1 --beam-mass 4)");
  EXPECT_EQ(changed["configuration"]["experiment"]["beam"]["length_m"], 1.0);
  EXPECT_EQ(changed["configuration"]["experiment"]["beam"]["mass_kg"], 4.0);
  EXPECT_EQ(changed["elements"], 20);
  EXPECT_EQ(changed["degrees_of_freedom"], 40);
}

// One dashpot against the whole beam: the first mode's ratio is c phi(L)^2 / (2 omega) when it is small.
TEST(Modes, WithDashpotsAreComplex) {
  Workplace place;
  place.write("beam.toml",
              "[beam]\nlength_m = 1\nbending_stiffness_n_m2 = 10\nmass_per_length_kg_per_m = 1\n"
              "dashpots = [{ position_m = 1, translational_n_s_per_m = 1e-3 }]\n");
  const json found = json_of(place.run("modes --json --modes 2 --config beam.toml"));
  const double omega = 1.875104068711961 * 1.875104068711961 * std::sqrt(10.0);
  EXPECT_NEAR(found["complex_modes"][0]["damping_ratio"].get<double>() / (1e-3 * 4 / (2 * omega)), 1.0, 1e-5);
  EXPECT_NEAR(found["complex_modes"][0]["frequency_hz"].get<double>(), omega / (2 * pi), 1e-6);
  EXPECT_THAT(place.run("modes --config beam.toml").out, HasSubstr("complex modes"));
}

TEST(Modes, ShowTheRatiosOfTheDampingLaw) {
  Workplace place;
  place.write(
      "beam.toml",
      "[beam]\nlength_m = 1\nbending_stiffness_n_m2 = 10\nmass_per_length_kg_per_m = 1\n[damping]\nlaw = "
      "\"rayleigh\"\nanchors = [{ frequency_hz = 1, ratio = 0.01 }, { frequency_hz = 10, ratio = 0.01 }]\n");
  const json mode = json_of(place.run("modes --json --modes 1 --config beam.toml"))["modes"][0];
  const double f = mode["frequency_hz"];  // xi = (alpha / omega + beta omega) / 2 through both anchors
  EXPECT_NEAR(mode["damping_ratio"].get<double>(), 0.01 * (10 / f + f) / 11, 1e-12);
}

TEST(Modes, WriteTablesPicturesAndMeshes) {
  Workplace place;
  const Outcome outcome = place.run("modes --modes 2 --surface --out results");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* file : {"modes.csv", "modes.pvd", "modes.vtu", "mode_1.vtu", "mode_2.vtu",
                           "mode_shapes.png", "mode_shapes.svg", "results.json"})
    EXPECT_TRUE(fs::exists(place.folder() / "results" / file)) << file;
  EXPECT_THAT(contents(place.folder() / "results" / "modes.csv"), HasSubstr("mode,frequency_hz,"));
}

TEST(Modes, OfAFineMeshAreDrawnOnACoarserOne) {
  Workplace place;
  EXPECT_EQ(place.run("modes --modes 2 --elements 20000 --out results").code, 0);
  EXPECT_LT(fs::file_size(place.folder() / "results" / "modes.vtu"), 2000000u);
  EXPECT_THAT(contents(place.folder() / "results" / "results.json"), HasSubstr("2000 elements"));
}

TEST(BeamOptions, AreRefusedWhenTheyMakeNoSense) {
  const std::pair<const char*, const char*> cases[] = {
      {"modes --support clamped-fre",
       "--support: beam.support is the text \"clamped-fre\"; did you mean 'clamped-free'?"},
      {"modes --length -1", "--length: beam.length_m is -1; expected a positive number"},
      {"modes --height nan", "beamid: modes: --height is 'nan'; expected a number"},
      {"modes --length long", "beamid: modes: --length is 'long'; expected a number"},
      {"modes --elements 0", "beamid: modes: --elements is 0; expected a whole number from 1 to 1000000"},
      {"modes --modes 0", "beamid: modes: --modes is 0; expected a whole number from 1 to 1000"},
      {"modes --diameter 0.1 --width 0.1",
       "beamid: modes: --diameter and --width exclude each other; expected one of them"},
      {"simulate --method verlet", nullptr},
      {"frf --from 10 --to 5", "--to: frequency_response.to_hz is 5; expected a number above from_hz, 10"},
      {"modes --config no.toml", "no.toml: no such file; expected a TOML file"}};
  for (const auto& [words, message] : cases) {
    const Outcome outcome = Workplace().run(words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_THAT(outcome.out, IsEmpty()) << words;
    if (message) {
      EXPECT_EQ(outcome.first_error_line(), message);
    }
  }
}

TEST(Modes, OfABuckledBeamAreNone) {
  // Oracle: pi^2 EI / (4 L^2) = 466.889385 N.
  const Outcome outcome = Workplace().run("modes --axial-load 1e4");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(
      outcome.first_error_line(),
      "--axial-load: axial_load_n is 10000; the beam buckles at 466.889 N of compression, expected less than "
      "that");
  EXPECT_EQ(Workplace().run("modes --axial-load 466.88938").code, 2);
  EXPECT_EQ(Workplace().run("modes --axial-load 466.8889").code, 0);
}

TEST(Modes, SayWhereTheBeamBuckles) {
  Workplace place;
  place.write("beam.toml",
              "[beam]\nlength_m = 1\nbending_stiffness_n_m2 = 100\nmass_per_length_kg_per_m = 1\n"
              "support = \"pinned-pinned\"\naxial_load_n = 990\n");
  const Outcome outcome = place.run("modes --config beam.toml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, StartsWith("beam.toml:6:16: axial_load_n is 990; the beam buckles at 986.96 N"));
}

TEST(Modes, AreAsManyAsTheMeshHas) {
  const Outcome outcome = Workplace().run("modes --elements 3 --modes 50");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("50 modes requested; the mesh of 3 elements has 6 coordinates"));
}

}  // namespace
}  // namespace beamid::apps::modes_test
