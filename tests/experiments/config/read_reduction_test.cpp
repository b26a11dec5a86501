#include "experiments/config/readers.hpp"

#include <gtest/gtest.h>

#include "experiments/config/read_experiment.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::read_reduction_test {
namespace {

std::string error_of(const std::string& text) {
  try {
    parse_reduction(text, "--reduction");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ReductionOnTheCommandLine, IsReadBackAsItIsWritten) {
  for (const char* text : {"rayleigh", "modal_truncation:modes=3", "guyan:masters_m=0.4/0.8/1.1",
                           "rayleigh:shape=given,shape_file=shape.csv", "none"})
    EXPECT_EQ(to_text(parse_reduction(text, "--reduction")), text);
  const Choice choice = parse_reduction("guyan:masters_m=1.1", "--reduction");
  EXPECT_EQ(choice.options.numbers("masters_m"), std::vector<double>{1.1});
  EXPECT_EQ(choice.place.file, "--reduction");
}

TEST(ReductionOnTheCommandLine, IsRefusedWithWhatWasExpected) {
  EXPECT_TRUE(error_of("guian").starts_with("--reduction: unknown reduction 'guian'; known: "))
      << error_of("guian");
  EXPECT_EQ(error_of("modal_truncation:modes"),
            "--reduction: 'modes' after 'modal_truncation'; expected OPTION=VALUE, as in "
            "modal_truncation:modes=3");
  EXPECT_EQ(error_of("modal_truncation:modes=many"),
            "--reduction: option 'modes' of reduction 'modal_truncation' is 'many'; expected a number");
  EXPECT_EQ(
      error_of("guyan:masters_m=0.4//1.1"),
      "--reduction: option 'masters_m' of reduction 'guyan' is '0.4//1.1'; expected numbers parted by '/', "
      "as 0.4/0.8/1.1");
  EXPECT_EQ(error_of("none:modes=3"), "--reduction: unknown option 'modes' of reduction 'none'; it has none");
  EXPECT_EQ(error_of("guyan:shape_file=shape.csv"),
            "--reduction: shape_file has no use with reduction 'guyan' as it is; expected shape=given");
  for (const char* text :
       {"", ":", "modal_truncation:", "modal_truncation:modes=", "modal_truncation:modes=nan",
        "modal_truncation:modes=1e400", "modal_truncation:modes=0", "guyan:masters_m="})
    EXPECT_NE(error_of(text), "no error") << text;
}

std::string beam_with(const std::string& tables) {
  return "[beam]\nlength_m = 1\nmass_kg = 1\nbending_stiffness_n_m2 = 1\n" + tables;
}

TEST(ReductionTables, AreReadInTheirOrder) {
  const TemporaryFile file("beam.toml",
                           beam_with("[[reductions]]\nmethod = \"modal_truncation\"\nmodes = 2\n"
                                     "[[reductions]]\nmethod = \"guyan\"\nmasters_m = [0.5, 1.0]\n"
                                     "[[reductions]]\nmethod = \"rayleigh\"\nshape = \"given\"\n"
                                     "shape_file = \"shape.csv\"\n"));
  const auto reductions = read_experiment(file.path()).reductions;
  ASSERT_EQ(reductions.size(), 3u);
  EXPECT_EQ(to_text(reductions[0]), "modal_truncation:modes=2");
  EXPECT_EQ(to_text(reductions[1]), "guyan:masters_m=0.5/1");
  EXPECT_EQ(reductions[2].shape_file, "shape.csv");
  EXPECT_EQ(reductions[0].place.line, 6u);
}

TEST(ReductionTables, AreRefusedWithTheirPlace) {
  const auto message = [](const std::string& tables) {
    const TemporaryFile file("beam.toml", beam_with(tables));
    return input_error_of(file, [&] { read_experiment(file.path()); });
  };
  EXPECT_TRUE(
      message("[[reductions]]\nmethod = \"guian\"\n").starts_with("beam.toml:6:10: unknown reduction "));
  EXPECT_TRUE(message("[[reductions]]\nmethod = \"none\"\nmodes = 2\n")
                  .starts_with("beam.toml:7:1: unknown option 'modes' of reduction 'none'"));
  EXPECT_EQ(
      message("[reduction]\nshape_file = \"shape.csv\"\n"),
      "beam.toml:6:1: reduction.shape_file has no use without shape = \"given\"; expected shape = \"given\", "
      "or no shape_file");
  EXPECT_EQ(message("[[reductions]]\nshape = \"given\"\nshape_file = \"\"\n"),
            "beam.toml:7:14: reductions[1].shape_file is the text \"\"; expected the name of a file");
}

TEST(Shape, IsReadFromTwoColumns) {
  for (const char* text : {"position_m,deflection\n0,0\n0.5,0.3\n1,1\n", "0 0\n0.5 0.3\n1 1\n",
                           "# position_m deflection\n0\t0\n0.5\t0.3\n1\t1\n"}) {
    const TemporaryFile file("shape.csv", text);
    const reduction::Training shape = read_shape(file.path(), 1.0);
    ASSERT_EQ(shape.positions.size(), 3) << text;
    EXPECT_EQ(shape.positions[1], 0.5);
    EXPECT_EQ(shape.deflections(1, 0), 0.3);
  }
}

TEST(Shape, IsRefusedWithItsPlace) {
  const std::pair<const char*, const char*> cases[] = {
      {"0,0,0\n1,1,1\n", "shape.csv:1:1: 3 columns; expected two columns, position_m and deflection"},
      {"position_mm,deflection\n0,0\n1,1\n",
       "shape.csv:1: columns 'position_mm' and 'deflection'; expected two columns, position_m and "
       "deflection"},
      {"0,0\n1.5,1\n", "shape.csv:2:1: position 1.5 m; expected one on the beam, 0 to 1 m"},
      {"0,0\n1,x\n", "shape.csv:2:3: column 2 holds 'x'; expected a number"},
      {"0.5,0\n0.5,1\n", "shape.csv:2:1: position 0.5 m after 0.5 m; expected increasing positions"},
      {"0,0\n1,0\n", "shape.csv: every deflection is zero; expected a shape"}};
  for (const auto& [text, message] : cases) {
    const TemporaryFile file("shape.csv", text);
    EXPECT_EQ(input_error_of(file, [&] { read_shape(file.path(), 1.0); }), message);
  }
}

}  // namespace
}  // namespace beamid::experiments::read_reduction_test
