// Oracles: the table of the study's beams (first frequency's error of the static shape, 33/140 m, 3 EI /
// L^3).
#include <gmock/gmock.h>

#include <sstream>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::reduce_test {
namespace {

using nlohmann::json, testing::HasSubstr, testing::IsEmpty, testing::StartsWith;

TEST(Reduce, ShowsRayleighsEquivalentMassAndItsPrice) {
  const json found = json_of(Workplace().run("reduce --json --tip-mass 0.0198575 --reduction rayleigh"));
  const json& one = found["reductions"][0];
  EXPECT_EQ(one["size"], 1);
  EXPECT_NEAR(one["equivalent_mass_kg"].get<double>(), 0.739965, 6e-7);
  EXPECT_NEAR(one["equivalent_stiffness_n_per_m"].get<double>(), 516.063, 5e-4);
  EXPECT_NEAR(one["modes"][0]["frequency_error_percent"].get<double>(), 1.38833, 5e-5);
  EXPECT_TRUE(one["modes"][1]["frequency_error_percent"].is_null());
  EXPECT_LT(one["decay_displacement_error_percent"], one["decay_acceleration_error_percent"]);
  EXPECT_EQ(found["damping_assumed"], true);
  EXPECT_NEAR(found["mesh"]["modes"][0]["frequency_hz"].get<double>(), 4.145510989755, 1e-6);
}

TEST(Reduce, ComparesOneOfEachKindByItselfAndFitsThePage) {
  const Outcome outcome = Workplace().run("reduce");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* name : {"rayleigh", "modal_truncation", "guyan"})
    EXPECT_THAT(outcome.out, HasSubstr("\n" + std::string(name)));
  EXPECT_THAT(outcome.out, HasSubstr("0.5 % in every mode is assumed"));
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

TEST(Reduce, WritesTablesPicturesAndMeshes) {
  Workplace place;
  const Outcome outcome =
      place.run("reduce --reduction rayleigh --reduction modal_truncation:modes=2 --modes 2 --out results");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* file :
       {"reductions.csv", "frequency_errors.csv", "mac.csv", "comac.csv", "equivalents.csv",
        "response_plot.png", "decay_plot.svg", "shape_plot.svg", "frequency_error_plot.png", "modes_mesh.vtu",
        "modes_rayleigh.vtu", "modes_modal_truncation.vtu", "results.json"})
    EXPECT_TRUE(fs::exists(place.folder() / "results" / file)) << file;
  EXPECT_THAT(contents(place.folder() / "results" / "comac.csv"),
              StartsWith("position_m,rayleigh_comac,modal_truncation_comac\n0,,\n"));
  EXPECT_THAT(contents(place.folder() / "results" / "timing.json"), HasSubstr("\"rayleigh_reduce_s\""));
  const std::string first = contents(place.folder() / "results" / "results.json");
  EXPECT_EQ(
      place
          .run("reduce --reduction rayleigh --reduction modal_truncation:modes=2 --modes 2 --out results "
               "--force")
          .code,
      0);
  EXPECT_EQ(contents(place.folder() / "results" / "results.json"), first);  // no clock in it
}

constexpr const char* beam = "[beam]\nlength_m = 1\nmass_kg = 1\nbending_stiffness_n_m2 = 10\n";

TEST(Reduce, TakesTheFilesReductionsUnlessTold) {
  Workplace place;
  place.write("both.toml", beam + std::string("[reduction]\nmethod = \"none\"\n[[reductions]]\nmethod = "
                                              "\"modal_truncation\"\nmodes = 2\n[[reductions]]\nmethod = "
                                              "\"rayleigh\"\n"));
  place.write("one.toml", beam + std::string("[reduction]\nmethod = \"modal_truncation\"\n"));
  const auto methods = [&](const std::string& words) {
    std::vector<std::string> names;
    const json found = json_of(place.run("reduce --json " + words));
    for (const json& one : found["reductions"]) names.push_back(one["method"]);
    return names;
  };
  EXPECT_THAT(methods("--config both.toml"), testing::ElementsAre("modal_truncation", "rayleigh"));
  EXPECT_THAT(methods("--config one.toml"), testing::ElementsAre("modal_truncation"));
  EXPECT_THAT(methods("--config both.toml --reduction none"), testing::ElementsAre("none"));
}

// The static shape given by hand, (3 L x^2 - x^3) / 2 L^3 at every tenth, is Rayleigh's own.
TEST(Reduce, TakesAShapeFromAFile) {
  Workplace place;
  std::string shape = "position_m,deflection\n";
  for (int i = 0; i <= 10; ++i)
    shape += std::to_string(0.11 * i) + "," + std::to_string(0.5 * 0.01 * i * i * (3.0 - 0.1 * i)) + "\n";
  place.write("shape.csv", shape);
  const json found = json_of(place.run(
      "reduce --json --reduction rayleigh:shape=given --reduction rayleigh --shape-file shape.csv"));
  EXPECT_NEAR(found["reductions"][0]["equivalent_mass_kg"].get<double>(),
              found["reductions"][1]["equivalent_mass_kg"].get<double>(), 1e-5);
  place.write("beam.toml",
              beam + std::string("[[reductions]]\nshape = \"given\"\nshape_file = \"shape.csv\"\n"));
  const Outcome outside = place.run("reduce --config beam.toml");
  EXPECT_EQ(outside.code, 2);
  EXPECT_EQ(outside.first_error_line(), "shape.csv:12:1: position 1.1 m; expected one on the beam, 0 to 1 m");
}

TEST(Reduce, RefusesWhatMakesNoSense) {
  const std::pair<const char*, const char*> cases[] = {
      {"reduce --modes 0", "beamid: reduce: --modes is 0; expected a whole number from 1 to 100"},
      {"reduce --band 1", "beamid: reduce: --band is 1; expected a number above 1 and at most 1000"},
      {"reduce --reduction rayleigh:shape=given",
       "--reduction: reduction 'rayleigh' is to take a given shape, and none is given; expected shape_file, "
       "or "
       "--shape-file FILE"},
      {"reduce --reduction none --shape-file shape.csv",
       "beamid: reduce: --shape-file has no use: no reduction waits for a shape; expected --reduction "
       "rayleigh:shape=given"},
      {"reduce --shape-file no.csv", nullptr},
      {"reduce --reduction guyan:masters_m=7", nullptr},
      {"reduce --reduction modal_truncation:modes=1000", nullptr},
      {"reduce --support free-free --reduction rayleigh", nullptr},
      {"reduce --reduction", nullptr}};
  for (const auto& [words, message] : cases) {
    const Outcome outcome = Workplace().run(words);
    EXPECT_EQ(outcome.code, 2) << words << "\n" << outcome.err;
    EXPECT_THAT(outcome.out, IsEmpty()) << words;
    if (message) {
      EXPECT_EQ(outcome.first_error_line(), message);
    }
  }
}

// A thousand elements, every support: an answer, and no number that is not one.
TEST(Reduce, AnswersForEverySupportAndFineMeshes) {
  for (const char* words : {"--elements 1000", "--support free-free", "--support clamped-clamped",
                            "--support pinned-free", "--axial-load 100", "--elements 1 --modes 2"}) {
    const Outcome outcome = Workplace().run(std::string("reduce --json ") + words);
    EXPECT_EQ(outcome.code, 0) << words << outcome.err;
    EXPECT_THAT(outcome.out, testing::Not(HasSubstr("\"warnings\""))) << words;
  }
}

}  // namespace
}  // namespace beamid::apps::reduce_test
