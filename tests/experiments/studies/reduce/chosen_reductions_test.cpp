#include "experiments/studies/reduce/report.hpp"

#include <gtest/gtest.h>

#include <set>

#include "experiments/config/readers.hpp"
#include "fem/beam.hpp"
#include "reduction/reduction.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::experiments::chosen_reductions_test {
namespace {

std::vector<Choice> parsed(const std::vector<std::string>& texts) {
  std::vector<Choice> choices;
  for (const std::string& text : texts) choices.push_back(parse_reduction(text, "--reduction"));
  return choices;
}

TEST(DefaultReductions, HoldEveryRegisteredOneButNone) {
  std::set<std::string> names;
  for (const Choice& choice : default_reductions(fem::Beam(test::steel_beam(0.0)))) {
    EXPECT_TRUE(choice.place.file.empty());
    names.insert(choice.name);
  }
  for (const auto& [name, entry] : reduction::reduction_registry().entries())
    EXPECT_EQ(names.contains(name), name != "none") << name;
}

TEST(DefaultReductions, AssumeACosineOnACantileverAlone) {
  const auto count = [](const fem::Beam& beam) {
    int cosines = 0;
    for (const Choice& choice : default_reductions(beam))
      cosines += choice.name == "rayleigh" && choice.options.text("shape") == "one_minus_cosine";
    return cosines;
  };
  fem::Beam beam = test::steel_beam(0.0);
  EXPECT_EQ(count(beam), 1);
  beam.supports.push_back({beam.length(), true, false});
  EXPECT_EQ(count(beam), 0);
}

TEST(Labels, AreShortAndAllDifferent) {
  EXPECT_EQ(labels(parsed(
                {"rayleigh", "modal_truncation:modes=2", "rayleigh:shape=one_minus_cosine", "none", "none"})),
            (std::vector<std::string>{"rayleigh", "modal_truncation", "rayleigh one_minus_cosine", "none #1",
                                      "none #2"}));
}

}  // namespace
}  // namespace beamid::experiments::chosen_reductions_test
