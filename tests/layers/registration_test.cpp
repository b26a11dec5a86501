// One file per extension: what the folders hold, what the files register, and what the program knows are the
// same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "experiments/modal/modal_method.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/springs/spring_law.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/studies/study.hpp"
#include "filters/filter.hpp"
#include "filters/scheme.hpp"
#include "filters/smoother.hpp"
#include "reduction/reduction.hpp"
#include "tests/layers/source_files.hpp"

namespace beamid::layers::registration_test {
namespace {

/// Names that a source text registers, in order of appearance.
std::vector<std::string> registered_names(const std::string& source) {
  static const std::regex line(R"re(_registry\(\)\s*\.add\(\s*\{\s*"([^"]+)")re");
  std::vector<std::string> names;
  for (std::sregex_iterator match(source.begin(), source.end(), line), end; match != end; ++match)
    names.push_back((*match)[1]);
  return names;
}

template <class Registry>
std::set<std::string> names_known_to(const Registry& registry) {
  std::set<std::string> names;
  for (const auto& [name, entry] : registry.entries()) names.insert(name);
  return names;
}

class ExtensionFolder : public testing::TestWithParam<const char*> {};

// Oracle: the file's own name.
TEST_P(ExtensionFolder, HasOneRegistrationPerFileUnderTheNameOfTheFile) {
  for (const std::string& name : extensions_in(GetParam())) {
    const std::string file = std::string(GetParam()) + "/" + name + ".cpp";
    EXPECT_THAT(registered_names(text_of(file)), testing::ElementsAre(name)) << file;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Project, ExtensionFolder,
    testing::Values("filters/methods", "filters/schemes", "filters/smoothers", "reduction/methods",
                    "experiments/modal/methods", "experiments/models", "experiments/models/springs",
                    "experiments/record/steps", "experiments/record/files", "experiments/studies"),
    [](const auto& tested) { return std::regex_replace(std::string(tested.param), std::regex("/"), "_"); });

// A plain static archive drops files that nobody calls, and these files are called by nobody: each set is
// compared with its folder, in a program linked as `beamid` is.
TEST(Registry, KnowsEveryFilterOfItsFolder) {
  EXPECT_EQ(names_known_to(filters::filter_registry()), extensions_in("filters/methods"));
}
TEST(Registry, KnowsEveryDiscretisationOfItsFolder) {
  EXPECT_EQ(names_known_to(filters::scheme_registry()), extensions_in("filters/schemes"));
}
TEST(Registry, KnowsEverySmootherOfItsFolder) {
  EXPECT_EQ(names_known_to(filters::smoother_registry()), extensions_in("filters/smoothers"));
}
TEST(Registry, KnowsEveryReductionOfItsFolder) {
  EXPECT_EQ(names_known_to(reduction::reduction_registry()), extensions_in("reduction/methods"));
}
TEST(Registry, KnowsEveryModalMethodOfItsFolder) {
  EXPECT_EQ(names_known_to(experiments::modal_method_registry()), extensions_in("experiments/modal/methods"));
}
TEST(Registry, KnowsEveryModelOfItsFolder) {
  EXPECT_EQ(names_known_to(experiments::model_registry()), extensions_in("experiments/models"));
}
TEST(Registry, KnowsEverySpringLawOfItsFolder) {
  EXPECT_EQ(names_known_to(experiments::spring_law_registry()), extensions_in("experiments/models/springs"));
}
TEST(Registry, KnowsEveryPreparationStepOfItsFolder) {
  EXPECT_EQ(names_known_to(experiments::step_registry()), extensions_in("experiments/record/steps"));
}
TEST(Registry, KnowsEveryStudyOfItsFolder) {
  EXPECT_EQ(names_known_to(experiments::study_registry()), extensions_in("experiments/studies"));
}

TEST(Registry, KnowsEveryReaderOfItsFolder) {
  EXPECT_EQ(names_known_to(experiments::record_reader_registry()), extensions_in("experiments/record/files"));
}

// The comparison means nothing when the folders are not found.
TEST(ExtensionFolders, HoldTheMethodsOfTheFirstStudy) {
  EXPECT_THAT(extensions_in("filters/methods"), testing::IsSupersetOf({"ekf", "ukf"}));
  EXPECT_THAT(extensions_in("filters/schemes"), testing::IsSupersetOf({"forward_euler", "exponential"}));
  EXPECT_THAT(extensions_in("reduction/methods"), testing::IsSupersetOf({"none", "rayleigh"}));
  EXPECT_THAT(extensions_in("experiments/models"), testing::IsSupersetOf({"sdof"}));
  EXPECT_THAT(extensions_in("experiments/studies"), testing::IsSupersetOf({"paper"}));
}

TEST(RegisteredNames, AreReadFromEveryRegistrationOfAText) {
  const std::string source =
      "const bool a = filter_registry().add({\"one\", ...});\n"
      "const bool b = model_registry().add(\n    {\"two\",\n ...});\n";
  EXPECT_THAT(registered_names(source), testing::ElementsAre("one", "two"));
}

}  // namespace
}  // namespace beamid::layers::registration_test
