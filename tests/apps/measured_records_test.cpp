// beamid identify on measured records, which lie outside the project.
#include <gmock/gmock.h>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::measured_records_test {
namespace {

using nlohmann::json;

/// Oracle: an envelope fit and a nonlinear least-squares fit of a damped sine over the same window, both made
/// outside this project; docs/tutorials/03_your_own_file prints the same table.
struct Measured {
  const char* experiment;
  const char* record;
  double frequency_hz, damping_ratio;
};

void PrintTo(const Measured& tested, std::ostream* stream) {
  *stream << tested.experiment;
}

class MeasuredRecord : public testing::TestWithParam<Measured> {
 protected:
  json identify() const {
    const fs::path record = source("../shared/data/unb-tip-mass") / (std::string(GetParam().record) + ".txt"),
                   experiment = source("docs/tutorials/03_your_own_file") /
                                (std::string(GetParam().experiment) + ".toml");
    if (!fs::exists(record)) return {};
    const Outcome outcome =
        Workplace().run("identify '" + record.string() + "' --config '" + experiment.string() + "' --json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out);
  }
};

class OneMode : public MeasuredRecord {};

TEST_P(OneMode, AgreesWithAnIndependentFit) {
  const json results = identify();
  if (results.is_null()) GTEST_SKIP() << "the measured records are not here";
  for (const char* method : {"estimate", "modal_analysis"}) {
    EXPECT_NEAR(results.at("frequency_hz").at(method).get<double>(), GetParam().frequency_hz,
                0.002 * GetParam().frequency_hz)
        << method;
    EXPECT_NEAR(results.at("damping_ratio").at(method).get<double>(), GetParam().damping_ratio,
                0.10 * GetParam().damping_ratio)
        << method;
  }
  EXPECT_TRUE(results.at("modal_analysis").at("companions").empty());
}

INSTANTIATE_TEST_SUITE_P(UnbTipMass, OneMode,
                         testing::Values(Measured{"massa1_early", "massa1_test1-1", 11.166, 0.0145},
                                         Measured{"massa1", "massa1_test1-1", 11.223, 0.0128},
                                         Measured{"massa2", "massa2_test1-2", 14.40, 0.0139},
                                         Measured{"massa3", "massa3_test2-3", 19.86, 0.0176}),
                         [](const auto& tested) { return std::string(tested.param.experiment); });

/// The same files without the line that says which window: identify looks for the decay itself.
class NoWindow : public MeasuredRecord {};

// Damping and frequency depend on amplitude, the windows are others: 1 % and 20 %, and no divergence.
TEST_P(NoWindow, IsAskedForByTheDefaults) {
  const fs::path record = source("../shared/data/unb-tip-mass") / (std::string(GetParam().record) + ".txt");
  if (!fs::exists(record)) GTEST_SKIP() << "the measured records are not here";
  std::string experiment =
      contents(source("docs/tutorials/03_your_own_file") / (std::string(GetParam().experiment) + ".toml"));
  const std::size_t line = experiment.find("window_s");
  experiment.erase(line, experiment.find('\n', line) - line);
  const Workplace place;
  place.write("whole.toml", experiment);
  const Outcome outcome = place.run("identify '" + record.string() + "' --config whole.toml --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found.at("status"), "converged");
  EXPECT_NEAR(found.at("frequency_hz").at("estimate").get<double>(), GetParam().frequency_hz,
              0.01 * GetParam().frequency_hz);
  EXPECT_NEAR(found.at("damping_ratio").at("estimate").get<double>(), GetParam().damping_ratio,
              0.20 * GetParam().damping_ratio);
}

INSTANTIATE_TEST_SUITE_P(UnbTipMass, NoWindow,
                         testing::Values(Measured{"massa1", "massa1_test1-1", 11.223, 0.0128},
                                         Measured{"massa2", "massa2_test1-2", 14.40, 0.0139},
                                         Measured{"massa3", "massa3_test2-3", 19.86, 0.0176},
                                         Measured{"massa4_test1-4", "massa4_test1-4", 22.77, 0.0295},
                                         Measured{"massa4_test2-4", "massa4_test2-4", 22.66, 0.027}),
                         [](const auto& tested) {
                           std::string name = tested.param.experiment;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// Two windows of massa1, whose frequency and damping depend on amplitude (11.166 Hz and 1.45 %, 11.223 Hz and
// 1.28 % by the independent fit): the command says that they disagree, and its intervals hold both.
TEST(TwoWindows, OfARecordWhoseDampingDependsOnAmplitudeDisagree) {
  const fs::path record = source("../shared/data/unb-tip-mass/massa1_test1-1.txt");
  if (!fs::exists(record)) GTEST_SKIP() << "the measured records are not here";
  const std::string file = "'" + record.string() + "' ";
  const Outcome outcome = Workplace().run("identify " + file + file + "--config '" +
                                          source("docs/tutorials/03_your_own_file/massa1.toml").string() +
                                          "' --window 0.308 0.708 0.808 1.608 --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_FALSE(found.at("agreement").at("agree").get<bool>());
  const auto holds = [&](const char* key, double value) {
    return found.at(key).at("lower_95").get<double>() < value &&
           value < found.at(key).at("upper_95").get<double>();
  };
  EXPECT_TRUE(holds("frequency_hz", 11.166) && holds("frequency_hz", 11.223));
  EXPECT_TRUE(holds("damping_ratio", 0.0145) && holds("damping_ratio", 0.0128));
}

class TwoModes : public MeasuredRecord {};

// One mode cannot follow two: the frequency stays good, the damping ratio does not, and the command says why.
TEST_P(TwoModes, AreFoundByTheModalAnalysis) {
  const json results = identify();
  if (results.is_null()) GTEST_SKIP() << "the measured records are not here";
  EXPECT_NEAR(results.at("frequency_hz").at("estimate").get<double>(), GetParam().frequency_hz,
              0.005 * GetParam().frequency_hz);
  EXPECT_NEAR(results.at("damping_ratio").at("modal_analysis").get<double>(), GetParam().damping_ratio,
              0.15 * GetParam().damping_ratio);
  const json& companions = results.at("modal_analysis").at("companions");
  ASSERT_EQ(companions.size(), 1u);
  EXPECT_NEAR(companions[0].at("frequency_hz").get<double>(), 28.35, 0.2);
  EXPECT_NEAR(companions[0].at("relative_amplitude").get<double>(), 0.3, 0.05);
  EXPECT_LT(results.at("innovations").at("whiteness_p_value").get<double>(), 0.001);
}

INSTANTIATE_TEST_SUITE_P(UnbTipMass, TwoModes,
                         testing::Values(Measured{"massa4_test2-4", "massa4_test2-4", 22.66, 0.027},
                                         Measured{"massa4_test1-4", "massa4_test1-4", 22.77, 0.0295}),
                         [](const auto& tested) {
                           return tested.index == 0 ? std::string("Test2") : std::string("Test1");
                         });

}  // namespace
}  // namespace beamid::apps::measured_records_test
