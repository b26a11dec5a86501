// The layers: fem and filters know nobody, reduction knows fem, experiments all three, apps everything below.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/layers/include_rules.hpp"
#include "tests/layers/source_files.hpp"

namespace beamid::layers::layers_test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

class Layer : public testing::TestWithParam<const char*> {};

// Oracle: the rules of docs/decisions/0001-registry-and-layers.md.
TEST_P(Layer, IncludesOnlyWhatItsRuleAllows) {
  const auto files = sources_below(GetParam());
  EXPECT_FALSE(files.empty()) << "no sources found below " << BEAMID_SOURCE_DIR << "/" << GetParam();
  for (const std::string& file : files) EXPECT_THAT(objections(file, text_of(file)), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Project, Layer,
                         testing::Values("fem", "filters", "reduction", "experiments", "apps"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(Headers, ShowNoLibraryOutsideItsPlace) {
  std::map<std::string, std::string> texts;
  for (const char* folder : {"fem", "filters", "reduction", "experiments", "apps"})
    for (const std::string& file : sources_below(folder)) texts[file] = text_of(file);
  EXPECT_THAT(leaks(texts), IsEmpty());
}

// The next tests plant includes by hand, so that the test above is known to be able to fail.
TEST(IncludeRules, RefuseAFilterThatKnowsBeams) {
  EXPECT_THAT(objections("filters/methods/spy.cpp", "#include <vector>\n\n#include \"fem/beam.hpp\"\n"),
              ElementsAre(HasSubstr("filters/methods/spy.cpp:3: filters includes \"fem/beam.hpp\"")));
}

TEST(IncludeRules, LetReductionSeeTheRegistryButNoFilter) {
  EXPECT_THAT(objections("reduction/reduction.hpp", "#include \"filters/registry.hpp\"\n"), IsEmpty());
  EXPECT_THAT(objections("reduction/reduction.hpp", "#include \"filters/filter.hpp\"\n"), testing::SizeIs(1));
}

TEST(IncludeRules, RefuseLibrariesOutsideTheirPlaces) {
  EXPECT_THAT(objections("experiments/record/record.cpp", "#include <vtkPoints.h>\n"), testing::SizeIs(1));
  EXPECT_THAT(objections("experiments/results/vtk/module/mesh.cpp", "#include <vtkPoints.h>\n"), IsEmpty());
  EXPECT_THAT(objections("filters/filter_run.cpp", "#include <cvodes/cvodes.h>\n"), testing::SizeIs(1));
  EXPECT_THAT(objections("filters/schemes/cvode.cpp", "#include <cvodes/cvodes.h>\n"), IsEmpty());
  EXPECT_THAT(objections("reduction/projection.cpp", "#include <Eigen/UmfPackSupport>\n"),
              testing::SizeIs(1));
  EXPECT_THAT(objections("reduction/modes.cpp", "#  include <Spectra/SymGEigsSolver.h>\n"),
              testing::SizeIs(1));
  EXPECT_THAT(objections("experiments/record/record.hpp", "#include <toml++/toml.h>\n"), testing::SizeIs(1));
  EXPECT_THAT(objections("experiments/paper.cpp", "#include <boost/program_options.hpp>\n"),
              testing::SizeIs(1));
}

TEST(IncludeRules, RefuseARoomThatLooksUp) {
  EXPECT_THAT(objections("experiments/modal/poles.hpp", "#include \"experiments/record/record.hpp\"\n"),
              IsEmpty());
  EXPECT_THAT(objections("experiments/modal/poles.hpp", "#include \"experiments/studies/study.hpp\"\n"),
              ElementsAre(HasSubstr("room modal includes")));
  EXPECT_THAT(objections("experiments/attic/box.hpp", "#include \"experiments/record/record.hpp\"\n"),
              ElementsAre(HasSubstr("no room 'attic'")));
}

TEST(IncludeRules, LetOnlySourcesOfItsPlaceShareAHeaderThatShowsALibrary) {
  std::map<std::string, std::string> texts{
      {"experiments/text/node.hpp", "#include <toml++/toml.h>\n"},
      {"experiments/text/node.cpp", "#include \"experiments/text/node.hpp\"\n"}};
  EXPECT_THAT(leaks(texts), IsEmpty());
  texts["experiments/text/table.hpp"] = texts["experiments/text/node.cpp"];
  texts["experiments/paper.cpp"] = texts["experiments/text/node.cpp"];
  EXPECT_THAT(leaks(texts), testing::UnorderedElementsAre(HasSubstr("experiments/text/table.hpp:1: "),
                                                          HasSubstr("experiments/paper.cpp:1: ")));
}

TEST(IncludeRules, RefuseALibraryNobodyHasNamed) {
  EXPECT_THAT(objections("fem/beam.cpp", "#include <armadillo/armadillo.h>\n"),
              ElementsAre(HasSubstr("belongs to no library")));
}

TEST(IncludeRules, RefusePathsThatDoNotStartAtTheRoot) {
  EXPECT_THAT(objections("fem/beam.cpp", "#include \"beam.hpp\"\n"), testing::SizeIs(1));
  EXPECT_THAT(objections("fem/beam.cpp", "#include \"../filters/options.hpp\"\n"), testing::SizeIs(1));
}

TEST(IncludeRules, OverlookWhatIsCommentedOut) {
  EXPECT_THAT(objections("fem/beam.cpp", "// #include \"apps/command.hpp\"\n"), IsEmpty());
}

}  // namespace
}  // namespace beamid::layers::layers_test
