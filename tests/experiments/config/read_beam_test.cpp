// Oracles: closed forms of section properties; the values written in the files themselves.
#include "experiments/config/readers.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "experiments/config/read_experiment.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::read_beam_test {
namespace {

using std::numbers::pi;

fem::Beam beam_of(const std::string& text) {
  const TemporaryFile file("beam.toml", "[beam]\n" + text);
  return read_experiment(file.path()).structure.beam();
}

const std::string steel = "length_m = 2\nwidth_m = 0.06\nheight_m = 0.01\nyoungs_modulus_pa = 2e11\n";

TEST(ReadBeam, TakesACircle) {
  const auto section =
      beam_of("length_m = 1\ndiameter_m = 0.02\nyoungs_modulus_pa = 2e11\ndensity_kg_per_m3 = 7850\n")
          .segments[0]
          .section;
  EXPECT_NEAR(section.bending_stiffness(0.3), 2e11 * pi * std::pow(0.02, 4) / 64, 1e-9);
  EXPECT_NEAR(section.mass_per_length(0.3), 7850 * pi * 1e-4, 1e-12);
  EXPECT_EQ(section.outline.shape, fem::Outline::Shape::ellipse);
  EXPECT_FALSE(section.shear_stiffness);
  EXPECT_EQ(section.rotary_inertia(0.0), 0.0);
}

TEST(ReadBeam, TapersLinearlyInItsDimensions) {
  const auto section = beam_of(steel +
                               "end_width_m = 0.02\nend_height_m = 0\ndensity_kg_per_m3 = 8000\n"
                               "rotary_inertia = true\n")
                           .segments[0]
                           .section;
  for (const double s : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    const double width = 0.06 - 0.04 * s, height = 0.01 * (1 - s), second = width * std::pow(height, 3) / 12;
    EXPECT_NEAR(section.bending_stiffness(s), 2e11 * second, 1e-9) << s;
    EXPECT_NEAR(section.mass_per_length(s), 8000 * width * height, 1e-12) << s;
    EXPECT_NEAR(section.rotary_inertia(s), 8000 * second, 1e-15) << s;
    EXPECT_NEAR(section.outline.height(s), height, 1e-16) << s;
  }
}

TEST(ReadBeam, SpreadsATotalMassAsTheArea) {
  const fem::Beam beam = beam_of(steel + "end_height_m = 0.005\nmass_kg = 9\n");
  EXPECT_NEAR(beam.mass(), 9.0, 1e-14);
  const auto& mass = beam.segments[0].section.mass_per_length;
  EXPECT_NEAR(mass(1.0) / mass(0.0), 0.5, 1e-15);
}

// Cowper: kappa = 10 (1 + nu) / (12 + 11 nu), G = E / (2 (1 + nu))
TEST(ReadBeam, WorksOutTheShearStiffness) {
  const std::string timoshenko = steel + "mass_kg = 9\ntheory = \"timoshenko\"\n";
  const double kappa = 13.0 / 15.3, modulus = 2e11 / 2.6, area = 6e-4;
  const auto from_ratio = beam_of(timoshenko + "poissons_ratio = 0.3\n").segments[0].section;
  EXPECT_NEAR((*from_ratio.shear_stiffness)(0) / (kappa * modulus * area), 1.0, 1e-14);
  EXPECT_NEAR(from_ratio.rotary_inertia(0), 4.5 * 0.01 * 0.01 / 12, 1e-18);  // rho I by default
  const auto from_modulus = beam_of(timoshenko + "shear_modulus_pa = 8e10\n").segments[0].section;
  const double ratio = 2e11 / 1.6e11 - 1;
  EXPECT_NEAR((*from_modulus.shear_stiffness)(0) / (10 * (1 + ratio) / (12 + 11 * ratio) * 8e10 * area), 1.0,
              1e-14);
  const auto as_told =
      beam_of(timoshenko + "poissons_ratio = 0.3\nshear_factor = 0.5\nrotary_inertia = false\n");
  EXPECT_NEAR((*as_told.segments[0].section.shear_stiffness)(0) / (0.5 * modulus * area), 1.0, 1e-14);
  EXPECT_EQ(as_told.segments[0].section.rotary_inertia(0), 0.0);
  const auto by_stiffness = beam_of(
      "length_m = 1\nbending_stiffness_n_m2 = 100\nmass_per_length_kg_per_m = 2\ntheory = \"timoshenko\"\n"
      "shear_stiffness_n = 1e6\nrotary_inertia_kg_m = 1e-5\n");
  EXPECT_EQ((*by_stiffness.segments[0].section.shear_stiffness)(0), 1e6);
  EXPECT_EQ(by_stiffness.segments[0].section.rotary_inertia(0), 1e-5);
}

TEST(ReadBeam, HoldsItsEndsInEveryWay) {
  EXPECT_EQ(end_supports().size(), 16u);
  for (const std::string& name : end_supports()) {
    const fem::Beam beam = beam_of(steel + "mass_kg = 9\nsupport = \"" + name + "\"\n");
    const auto held = [&](const std::string& kind) { return kind == "free" ? 0u : 1u; };
    const std::size_t dash = name.find('-');
    EXPECT_EQ(beam.supports.size(), held(name.substr(0, dash)) + held(name.substr(dash + 1))) << name;
    for (const fem::Support& support : beam.supports) {
      const std::string kind = support.position == 0.0 ? name.substr(0, dash) : name.substr(dash + 1);
      EXPECT_EQ(support.deflection, kind == "clamped" || kind == "pinned") << name;
      EXPECT_EQ(support.rotation, kind == "clamped" || kind == "guided") << name;
    }
  }
}

TEST(ReadBeam, PutsASpringInPlaceOfTheClamp) {
  const fem::Beam rotation = beam_of(steel + "mass_kg = 9\nroot_rotational_stiffness_n_m_per_rad = 5e3\n");
  ASSERT_EQ(rotation.supports.size(), 1u);
  EXPECT_TRUE(rotation.supports[0].deflection);
  EXPECT_FALSE(rotation.supports[0].rotation);
  EXPECT_EQ(rotation.springs.at(0).rotational, 5e3);
  const fem::Beam both = beam_of(steel +
                                 "mass_kg = 9\nroot_rotational_stiffness_n_m_per_rad = 5e3\n"
                                 "root_translational_stiffness_n_per_m = 1e6\n");
  EXPECT_TRUE(both.supports.empty());
  EXPECT_EQ(both.springs.at(0).translational, 1e6);
}

TEST(ReadBeam, TakesAllThatSitsOnIt) {
  const fem::Beam beam = beam_of(steel + R"(mass_kg = 9
tip_mass_kg = 1
sensor_mass_kg = 0.1
tip_rotary_inertia_kg_m2 = 0.01
tip_eccentricity_m = 0.05
axial_load_n = -20
mass_model = "lumped"
[[beam.bodies]]
position_m = 0.5
mass_kg = 2
rotary_inertia_kg_m2 = 0.02
eccentricity_m = -0.01
[[beam.supports]]
position_m = 1.5
kind = "guided"
[[beam.springs]]
position_m = 2
translational_n_per_m = 3
rotational_n_m_per_rad = 4
cubic_n_per_m3 = -5
[[beam.dashpots]]
position_m = 1
translational_n_s_per_m = 6
rotational_n_m_s_per_rad = 7
quadratic_n_s2_per_m2 = 8
[[beam.absorbers]]
position_m = 1.2
mass_kg = 9
stiffness_n_per_m = 10
damping_n_s_per_m = 11
[[beam.damages]]
from_m = 0.1
to_m = 0.2
loss = 0.3
[[beam.added_masses]]
from_m = 0.4
to_m = 0.6
mass_per_length_kg_per_m = 12
)");
  ASSERT_EQ(beam.bodies.size(), 3u);  // tip mass, sensor on the tip itself, body
  EXPECT_EQ(beam.bodies[0].eccentricity, 0.05);
  EXPECT_EQ(beam.bodies[0].rotary_inertia, 0.01);
  EXPECT_EQ(beam.bodies[1].mass, 0.1);
  EXPECT_EQ(beam.bodies[1].eccentricity, 0.0);
  EXPECT_EQ(beam.bodies[2].eccentricity, -0.01);
  EXPECT_DOUBLE_EQ(beam.tip_mass(), 1.1);
  EXPECT_EQ(beam.axial_load, -20);
  EXPECT_EQ(beam.mass_model, fem::MassModel::lumped);
  ASSERT_EQ(beam.supports.size(), 2u);
  EXPECT_FALSE(beam.supports[1].deflection);
  EXPECT_EQ(beam.springs.at(0).cubic, -5);
  EXPECT_EQ(beam.dashpots.at(0).quadratic, 8);
  EXPECT_EQ(beam.absorbers.at(0).damping, 11);
  EXPECT_EQ(beam.damages.at(0).loss, 0.3);
  EXPECT_EQ(beam.added_masses.at(0).mass_per_length, 12);
}

TEST(ReadBeam, JoinsSegments) {
  const fem::Beam beam = beam_of(
      "[[beam.segments]]\nlength_m = 1\nbending_stiffness_n_m2 = 10\n"
      "mass_per_length_kg_per_m = 2\n[[beam.segments]]\n" +
      steel + "mass_kg = 3\n");
  EXPECT_EQ(beam.segments.size(), 2u);
  EXPECT_DOUBLE_EQ(beam.length(), 3.0);
  EXPECT_DOUBLE_EQ(beam.mass(), 5.0);
  EXPECT_EQ(beam.supports.at(0).position, 0.0);
}

struct Refused {
  const char* content;  ///< after "[beam]", "length_m = 2" and three lines more: line 6 is the first of these
  const char* message;
};

TEST(ReadBeam, RefusesWhatMakesNoSense) {
  const Refused cases[] = {
      {"mass_kg = 1\ndiameter_m = 0.1\n",
       "bad.toml:3:1: beam.width_m has no use beside diameter_m; expected a rectangle or a circle, or no "
       "width_m"},
      {"mass_kg = 1\nend_diameter_m = 0.1\n",
       "bad.toml:1:1: beam.diameter_m is missing; expected a positive number beside end_diameter_m"},
      {"mass_kg = 1\nsupport = \"clamped\"\n",
       "bad.toml:7:11: beam.support is the text \"clamped\"; expected one of clamped-clamped, "
       "clamped-pinned, clamped-guided, "
       "clamped-free, pinned-clamped, pinned-pinned, pinned-guided, pinned-free, guided-clamped, "
       "guided-pinned, guided-guided, guided-free, free-clamped, free-pinned, free-guided, free-free"},
      {"mass_kg = 1\nshear_factor = 0.8\n",
       "bad.toml:7:1: beam.shear_factor has no use with theory \"euler_bernoulli\"; expected theory = "
       "\"timoshenko\", or no shear_factor"},
      {"mass_kg = 1\ntheory = \"timoshenko\"\n",
       "bad.toml:1:1: beam.poissons_ratio is missing; expected a number beside theory = \"timoshenko\", or "
       "shear_stiffness_n"},
      {"mass_kg = 1\npoissons_ratio = 0.6\n",
       "bad.toml:7:18: beam.poissons_ratio is 0.6; expected a number above -1, at most 0.5"},
      {"mass_kg = 1\ntheory = \"shear\"\n",
       "bad.toml:7:10: beam.theory is the text \"shear\"; expected one of euler_bernoulli, timoshenko"},
      {"mass_kg = 1\nrotary_inertia = 1\n",
       "bad.toml:7:18: beam.rotary_inertia is 1; expected true or false"},
      {"mass_kg = 1\nbodies = [{ position_m = 3, mass_kg = 1 }]\n",
       "bad.toml:7:26: beam.bodies[1].position_m is 3; expected a number from 0 to the beam's length, 2"},
      {"mass_kg = 1\nsprings = [{ position_m = 1 }]\n",
       "bad.toml:7:12: beam.springs[1] has no effect; expected at least one of translational_n_per_m, "
       "rotational_n_m_per_rad, cubic_n_per_m3"},
      {"mass_kg = 1\nsupports = [{ position_m = 1 }]\n",
       "bad.toml:7:13: beam.supports[1].kind is missing; expected one of clamped, pinned, guided"},
      {"mass_kg = 1\ndamages = [{ from_m = 1, to_m = 0.5, loss = 0.1 }]\n",
       "bad.toml:7:33: beam.damages[1].to_m is 0.5; expected a number above from_m, 1"},
      {"mass_kg = 1\ndamages = [{ from_m = 0.2, to_m = 0.5, loss = 1 }]\n",
       "bad.toml:7:47: beam.damages[1].loss is 1; expected a number from 0 to below 1"},
      {"mass_kg = 1\nsegments = [{ length_m = 1 }]\n",
       "bad.toml:2:1: beam.length_m has no use beside beam.segments; expected it in each of beam.segments, "
       "or no length_m"}};
  for (const Refused& refused : cases) {
    const TemporaryFile file("bad.toml", "[beam]\n" + steel + refused.content);
    EXPECT_EQ(input_error_of(file, [&] { read_experiment(file.path()); }), refused.message)
        << refused.content;
  }
}

TEST(Overrides, TakeThePlaceOfTheFilesOwnKeys) {
  const TemporaryFile file("beam.toml", "[beam]\n" + steel + "mass_per_length_kg_per_m = 5\n");
  const fem::Beam beam =
      read_experiment(file.path(), {{"beam", "length_m", 3.0, "--length"},
                                    {"beam", "mass_kg", 6.0, "--beam-mass", {"mass_per_length_kg_per_m"}}})
          .structure.beam();
  EXPECT_EQ(beam.length(), 3.0);
  EXPECT_DOUBLE_EQ(beam.mass(), 6.0);
  EXPECT_EQ(input_error_of(file,
                           [&] {
                             read_experiment(file.path(), {{"beam", "length_m", -3.0, "--length"}});
                           }),
            "--length: beam.length_m is -3; expected a positive number");
  EXPECT_EQ(
      input_error_of(file,
                     [&] {
                       read_experiment(file.path(), {{"beam", "mass_kg", 6.0, "--beam-mass"}});
                     }),
      "beam.toml:1:1: mass is given by mass_kg, mass_per_length_kg_per_m; expected exactly one of mass_kg, "
      "mass_per_length_kg_per_m, density_kg_per_m3");
}

}  // namespace
}  // namespace beamid::experiments::read_beam_test
