// Oracle: what the handbooks know of materials, and beams described in wrong units.
#include "experiments/identify/verdict/plausibility.hpp"

#include <gmock/gmock.h>

#include "experiments/config/read_experiment.hpp"

namespace beamid::experiments::plausibility_test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

std::vector<std::string> of(const std::string& beam, const std::string& more = "") {
  return implausible(read_experiment(TomlTable::parse("[beam]\n" + beam + more, "test.toml")));
}

const std::string steel = "length_m = 0.5\nwidth_m = 0.03\nheight_m = 0.003\n",
                  steel_material = "youngs_modulus_pa = 2.12e11\ndensity_kg_per_m3 = 7850\n";

TEST(Plausibility, FindsNothingWrongWithARealBeam) {
  EXPECT_THAT(of(steel + steel_material), IsEmpty());
  EXPECT_THAT(of("length_m = 60\ndiameter_m = 3\n" + steel_material), IsEmpty());  // a mast
  EXPECT_THAT(of("length_m = 3e-4\nwidth_m = 5e-5\nheight_m = 2e-6\nyoungs_modulus_pa = 1.6e11\n"
                 "density_kg_per_m3 = 2330\n"),
              testing::SizeIs(testing::Le(1u)));  // an atomic-force cantilever
}

TEST(Plausibility, DoubtsMillimetres) {
  EXPECT_THAT(
      of("length_m = 0.5\nwidth_m = 30\nheight_m = 3\n" + steel_material),
      ElementsAre(HasSubstr("the beam's height of 3 m is more than a fifth of the beam's length of 0.5 m")));
}

TEST(Plausibility, DoubtsGigapascals) {
  EXPECT_THAT(of(steel + "youngs_modulus_pa = 212\ndensity_kg_per_m3 = 7850\n"),
              ElementsAre(HasSubstr("Young's modulus is 212 Pa; materials have 1e+08 to 1e+12 Pa"),
                          HasSubstr("The first frequency is 0.0003")));
}

TEST(Plausibility, DoubtsGramsPerCubicCentimetre) {
  EXPECT_THAT(of(steel + "youngs_modulus_pa = 2.12e11\ndensity_kg_per_m3 = 7.85\n"),
              ElementsAre(HasSubstr("density is 7.85 kg/m3")));
}

TEST(Plausibility, DoubtsPercentForARatio) {
  EXPECT_THAT(of(steel + steel_material, "[damping]\nratio = 2\n"),
              ElementsAre(HasSubstr("The damping ratio is 2, 200 % of critical")));
}

TEST(Plausibility, SaysWhatIsJoinedOrOverlaps) {
  EXPECT_THAT(of(steel + steel_material,
                 "[[beam.supports]]\nposition_m = 0\nkind = \"pinned\"\n"
                 "[[beam.damages]]\nfrom_m = 0.1\nto_m = 0.2\nloss = 0.5\n"
                 "[[beam.damages]]\nfrom_m = 0.15\nto_m = 0.3\nloss = 0.2\n"),
              ElementsAre(HasSubstr("Two supports at 0 m are taken for one"),
                          HasSubstr("Damages 1 and 2 overlap from 0.15 to 0.2 m; together they take 60 %")));
}

TEST(Plausibility, ComesFirst) {
  Results results;
  results.heading("Modes");
  results.paragraph("text");
  warn(results, read_experiment(TomlTable::parse(
                    "[beam]\nlength_m = 0.5\nwidth_m = 30\nheight_m = 3\n" + steel_material, "test.toml")));
  ASSERT_EQ(results.report.size(), 3u);
  EXPECT_THAT(std::get<Paragraph>(results.report[1]).text, HasSubstr("Implausible, check the units"));
  EXPECT_EQ(results.values["beam_warnings"].size(), 1u);
}

}  // namespace
}  // namespace beamid::experiments::plausibility_test
