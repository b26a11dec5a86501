// docs/study.md against the commands it quotes. Oracle of every number: what the command finds now.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::study_test {
namespace {

using nlohmann::json;

void expect_quoted(const std::string& words) {
  static const std::string document = contents(source("docs/study.md"));
  EXPECT_NE(document.find(words), std::string::npos) << "docs/study.md does not say: " << words;
}

json found_by(const std::string& command) {
  return json::parse(Workplace().run(command + " --json").out);
}

/// "+6.41411": as the document writes it.
std::string written(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

TEST(StudyDocument, QuotesWhatPaperFinds) {
  const json results = found_by("paper");
  const json& table = results.at("table2");
  for (const char* scheme : {"forward_euler", "backward_euler"})
    for (const char* error : {"stiffness_error_percent", "damping_error_percent"})
      expect_quoted("| " + written(table.at(scheme).at(error), "%+.5f") + " |");
  const json& euler = results.at("discretisation_bias").at("forward_euler");
  for (const char* error : {"stiffness_error_percent", "damping_error_percent"})
    expect_quoted(written(euler.at(error), "%+.7f") + " %");
  std::string ratios;
  for (const json& beam : results.at("beams")) {
    const json& ekf = beam.at("ekf");
    expect_quoted("| " + beam.at("name").get<std::string>() + " | " +
                  written(ekf.at("forward_euler").at("predicted_damping_error_percent"), "%+.3f") + " | " +
                  written(ekf.at("forward_euler").at("damping_error_percent"), "%+.3f") + " | " +
                  written(ekf.at("exponential").at("damping_error_percent"), "%+.3f") + " |");
    ratios += (&beam == &results.at("beams").back() ? " and "
               : ratios.empty()                     ? ""
                                                    : ", ") +
              written(beam.at("trials").at("damping_bound_ratio"), "%.3f");
  }
  expect_quoted("rms error of C is " + ratios + " times the Cramer-Rao bound");
}

// Of the five filters that are quoted the extended one; each takes as long again, and they agree to three
// digits (docs/theory/filter_table.md).
TEST(StudyDocument, QuotesWhatEfficiencyFinds) {
  double least = 1.0, largest = 1.0;
  const json found = found_by("efficiency --filter ekf --passes lengthening");
  ASSERT_EQ(found.at("cases").size(), 3u);
  for (const json& one : found.at("cases"))
    for (const char* parameter : {"stiffness", "damping"}) {
      EXPECT_EQ(one.at("runs"), 2000);
      least = std::min(least, one.at(parameter).at("rms_over_bound").get<double>());
      largest = std::max(largest, one.at(parameter).at("rms_over_bound").get<double>());
    }
  expect_quoted("Over 2,000 simulated decays");
  expect_quoted("lie between " + written(least, "%.2f") + " and " + written(largest, "%.2f") +
                " times the bound");
}

TEST(StudyDocument, QuotesWhatNoiseFinds) {
  double displaced = 0.0, accelerated = 0.0, struck = 0.0, least = 1e9, largest = 0.0;
  const json found = found_by("noise");
  for (const json& one : found.at("cases")) {
    const double error = one.at("white").at("damping_rms_error_percent");
    const std::string observed = one.at("observed");
    const bool released = one.at("blow") == "release";
    if (released && observed == "displacement") {
      displaced = std::max(displaced, error);
      least = std::min(least, 100.0 * one.at("higher_modes_over_first").get<double>());
      largest = std::max(largest, 100.0 * one.at("higher_modes_over_first").get<double>());
    }
    if (observed == "acceleration")
      (released ? accelerated : struck) = std::max(released ? accelerated : struck, error);
  }
  expect_quoted("the other modes are " + written(least, "%.1f") + " to " + written(largest, "%.1f") +
                " % of the displacement, and C errs by at most " + written(displaced, "%.2f") + " %");
  expect_quoted("up to " + written(accelerated, "%.1f") + " % of C\nafter a release, up to " +
                written(struck, "%.0f") + " % after a hammer's blow");
}

TEST(StudyDocument, QuotesWhatBudgetFinds) {
  const json beam = found_by("budget").at("beams").at(1);
  ASSERT_EQ(beam.at("name"), "S(11.8)");
  const auto percent = [](const json& one, const char* parameter) {
    return one.at(std::string(parameter) + "_percent").get<double>();
  };
  const auto of = [&](const char* cause, const char* parameter) {
    return percent(beam.at("causes").at(cause).at("in_sequence"), parameter);
  };
  expect_quoted("errs by " + written(percent(beam.at("total"), "damping"), "%+.1f") +
                " % in C. Of this the\ndiscretisation makes " +
                written(of("discretisation", "damping"), "%+.1f") + ", Rayleigh's mass " +
                written(of("reduction", "damping"), "%+.2f") + ", high-pass and integration " +
                written(of("high_pass", "damping") + of("integration", "damping"), "%+.2f") +
                ", an amplitude-dependent damping " + written(of("amplitude_damping", "damping"), "%+.2f") +
                ", everything\nelse less than 0.2. K errs by " +
                written(percent(beam.at("total"), "stiffness"), "%+.2f") +
                " %, of which Rayleigh's mass makes " + written(of("reduction", "stiffness"), "%+.2f"));
  for (const auto& [cause, shares] : beam.at("causes").items())
    if (cause != "discretisation" && cause != "reduction" && cause != "high_pass" && cause != "integration" &&
        cause != "amplitude_damping") {
      EXPECT_LT(std::abs(of(cause.c_str(), "damping")), 0.2) << cause;
    }
}

TEST(StudyDocument, QuotesWhatIdentifyFinds) {
  const fs::path records = source("../shared/data/unb-tip-mass"),
                 experiments = source("docs/tutorials/03_your_own_file");
  if (!fs::exists(records)) GTEST_SKIP() << "the measured records are not here";
  const std::vector<std::vector<std::string>> rows{
      {"massa1_early", "massa1_test1-1", "massa1, 0.308-0.708", "11.166"},
      {"massa1", "massa1_test1-1", "massa1, 0.808-1.608", "11.223"},
      {"massa2", "massa2_test1-2", "massa2, 0.808-1.608", "14.40"},
      {"massa3", "massa3_test2-3", "massa3, 0.707-1.307", "19.86"}};
  for (const auto& row : rows) {
    const json found = found_by("identify '" + (records / (row[1] + ".txt")).string() + "' --config '" +
                                (experiments / (row[0] + ".toml")).string() + "'");
    expect_quoted("| " + row[2] + " | " + written(found.at("frequency_hz").at("estimate"), "%.3f") + " | " +
                  row[3] + " | " +
                  written(100.0 * found.at("damping_ratio").at("estimate").get<double>(), "%.3f") + " | ");
  }
}

}  // namespace
}  // namespace beamid::apps::study_test
