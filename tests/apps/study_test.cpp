// docs/study.md against the commands it quotes. Oracle of every number: what the command finds now.

#include <algorithm>
#include <cmath>
#include <complex>

#include "tests/apps/quoted.hpp"

namespace beamid::apps::study_test {
namespace {

using nlohmann::json;

// Oracle: the closed forms of docs/theory/discretisation_bias.md, which measured_force_test.cpp holds filters
// to.
TEST(StudyDocument, QuotesTheBiasOfAHeldForce) {
  const double p = std::acos(-1.0) / 14.0, xi = 0.02;
  expect_quoted(written(200.0 * xi * std::tan(0.5 * p), "%.2f") + " % too high, and " +
                written(100.0 * std::sqrt(1.0 - std::pow(std::cos(0.5 * p), 4)), "%.1f") +
                " % of the response");
  expect_quoted("come out " + written(100.0 * (1.0 - std::pow(std::sin(p) / p, 2)), "%.1f") +
                " % too\nsmall");
}

// Of the five filters that are quoted the extended one; each takes as long again, and they agree to three
// digits (docs/theory/filter_table.md).
TEST(StudyDocument, QuotesWhatEfficiencyFinds) {
  double least = 1.0, largest = 1.0;
  const json& found = found_by("efficiency --filter ekf --passes lengthening");
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
  const json& found = found_by("noise");
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
                " % of the first after a release, and C errs by at most " + written(displaced, "%.2f") +
                " %");
  expect_quoted("up to " + written(accelerated, "%.1f") + " % of C\nafter a release, up to " +
                written(struck, "%.0f") + " % after a hammer's blow");
}

TEST(StudyDocument, QuotesWhatBudgetFinds) {
  const json &beams = found_by("budget").at("beams"), &beam = beams.at(1), &light = beams.at(0);
  ASSERT_EQ(beam.at("name"), "S(11.8)");
  const auto percent = [](const json& one, const char* parameter) {
    return one.at(std::string(parameter) + "_percent").get<double>();
  };
  const auto of = [&](const char* cause, const char* parameter) {
    return percent(beam.at("causes").at(cause).at("in_sequence"), parameter);
  };
  const auto average = [&](const json& of_beam, const char* cause) {
    return written(percent(of_beam.at("causes").at(cause).at("average"), "damping"), "%+.1f");
  };
  expect_quoted("errs by " + written(percent(beam.at("total"), "damping"), "%+.1f") + " % in C.");
  expect_quoted("discretisation " + average(beam, "discretisation") + ", sampling rate " +
                average(beam, "sampling"));
  expect_quoted(average(light, "discretisation") + " and " + average(light, "sampling") + ".");
  expect_quoted("the discretisation makes " + written(of("discretisation", "damping"), "%+.1f") +
                ", Rayleigh's mass " + written(of("reduction", "damping"), "%+.2f") +
                ", high-pass and integration " +
                written(of("high_pass", "damping") + of("integration", "damping"), "%+.2f") +
                ", an\namplitude-dependent damping " + written(of("amplitude_damping", "damping"), "%+.2f") +
                ", everything else less than 0.2.");
  expect_quoted("K errs there by " + written(percent(beam.at("total"), "stiffness"), "%+.2f") +
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
      {"massa1_early", "massa1_test1-1", "massa1, 0.308-0.708", "11.166", "1.45"},
      {"massa1", "massa1_test1-1", "massa1, 0.808-1.608", "11.223", "1.28"},
      {"massa2", "massa2_test1-2", "massa2, 0.808-1.608", "14.40", "1.39"},
      {"massa3", "massa3_test2-3", "massa3, 0.707-1.307", "19.86", "1.76"}};
  for (const auto& row : rows) {
    const json& found = found_by("identify '" + (records / (row[1] + ".txt")).string() + "' --config '" +
                                 (experiments / (row[0] + ".toml")).string() + "'");
    const auto with_interval = [&](const char* parameter, double scale) {
      const json& one = found.at(parameter);
      return written(scale * one.at("estimate").get<double>(), "%.3f") + " (" +
             written(scale * one.at("lower_95").get<double>(), "%.3f") + " to " +
             written(scale * one.at("upper_95").get<double>(), "%.3f") + ")";
    };
    const json& innovations = found.at("innovations");
    expect_quoted("| " + row[2] + " | " + with_interval("frequency_hz", 1.0) + " | " + row[3] + " | " +
                  with_interval("damping_ratio", 100.0) + " | " + row[4] + " | " +
                  written(innovations.at("mean_normalised_square"), "%.2f") + " | " +
                  written(innovations.at("whiteness_p_value"), "%.2g") + " |");
    const double correlation = innovations.at("lag_one_correlation");
    EXPECT_GE(correlation, 0.975) << "written as 0.98 to 0.99";
    EXPECT_LT(correlation, 0.995);
  }
}

// Oracle of the predictions: lambda_f = (e^(lambda dt) - 1) / dt of what the exact scheme finds, computed
// here.
TEST(StudyDocument, QuotesTheStepsOfAMeasuredRecord) {
  const fs::path record = source("../shared/data/unb-tip-mass/massa1_test1-1.txt");
  if (!fs::exists(record)) GTEST_SKIP() << "the measured records are not here";
  const json& found = found_by("steps '" + record.string() + "' --config '" +
                               source("docs/tutorials/03_your_own_file/massa1.toml").string() +
                               "' --discretisation forward_euler");
  const json &exact = found.at("schemes").at(0), &euler = found.at("schemes").at(1);
  const auto each = [](const json& scheme, const char* pointer, double scale) {
    json values;
    for (const json& step : scheme.at("steps"))
      values.push_back(scale * step.at(json::json_pointer(pointer)).get<double>());
    return values;
  };
  expect_quoted("| dt [ms] " + row_of(each(exact, "/step_s", 1e3), "%.3f"));
  expect_quoted(R"(| $\xi$, exact [%] )" + row_of(each(exact, "/found/damping_ratio", 100.0), "%.4f"));
  expect_quoted(R"(| $\xi$, forward Euler [%] )" +
                row_of(each(euler, "/found/damping_ratio", 100.0), "%.4f"));
  for (const json* scheme : {&exact, &euler})
    expect_quoted("| mean NIS, exact and forward Euler " + row_of(each(*scheme, "/mean_nis", 1.0), "%.3f"));
  json predicted;
  for (const json& step : exact.at("steps")) {
    const json& mode = step.at("found");
    const double dt = step.at("step_s"), xi = mode.at("damping_ratio"),
                 w = 2.0 * std::acos(-1.0) * mode.at("frequency_hz").get<double>();
    const std::complex<double> lambda(-xi * w, w * std::sqrt(1.0 - xi * xi)),
        seen = (std::exp(lambda * dt) - 1.0) / dt;
    predicted.push_back(-100.0 * seen.real() / std::abs(seen));
  }
  expect_quoted("| predicted [%] " + row_of(predicted, "%.4f"));
  expect_quoted("extrapolated to dt = 0 give " +
                written(100.0 * euler.at("extrapolated").at("damping_ratio").get<double>(), "%.4f") + " %");
}

}  // namespace
}  // namespace beamid::apps::study_test
