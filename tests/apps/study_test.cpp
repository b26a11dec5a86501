// docs/study.md against the commands it quotes. Oracle of every number: what the command finds now.
#include <algorithm>
#include <cmath>
#include <complex>
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

const json& paper_results() {
  static const json results = found_by("paper");
  return results;
}

/// "| +6.242 | 1e-7 |" of numbers, each as the document writes it.
std::string row_of(const json& numbers, const char* format) {
  std::string row = "|";
  for (const json& number : numbers)
    row += ' ' + (number.is_null() ? std::string("lost") : written(number, format)) + " |";
  return row;
}

/// A key of every entry of a list.
json column_of(const json& list, const json::json_pointer& key, double scale = 1.0) {
  json column = json::array();
  for (const json& one : list)
    column.push_back(one.at(key).is_null() ? json() : json(scale * one.at(key).get<double>()));
  return column;
}

TEST(StudyDocument, QuotesWhatPaperFinds) {
  const json& results = paper_results();
  expect_quoted("Version " + results.at("version").get<std::string>() + ",\nseed " +
                results.at("seed").dump());
  const json& table = results.at("table2");
  for (const char* scheme : {"forward_euler", "backward_euler"})
    for (const char* error : {"stiffness_error_percent", "damping_error_percent"})
      expect_quoted("| " + written(table.at(scheme).at(error), "%+.5f") + " |");
  const json& euler = results.at("discretisation_bias").at("forward_euler");
  for (const char* error : {"stiffness_error_percent", "damping_error_percent"})
    expect_quoted(written(euler.at(error), "%+.7f") + " %");
  std::string ratios;
  for (const json& beam : results.at("beams")) {
    const json &ekf = beam.at("ekf"), &wide = beam.at("wide_prior");
    expect_quoted("| " + beam.at("name").get<std::string>() + " | " +
                  written(ekf.at("forward_euler").at("predicted_damping_error_percent"), "%+.3f") + " | " +
                  written(ekf.at("forward_euler").at("damping_error_percent"), "%+.3f") + " | " +
                  written(ekf.at("exponential").at("damping_error_percent"), "%+.3f") + " | " +
                  written(wide.at("paper_processing_forward_euler").at("damping_error_percent"), "%+.3f") +
                  " | " + written(wide.at("paper_processing").at("damping_error_percent"), "%+.3f") + " |");
    ratios += (&beam == &results.at("beams").back() ? " and "
               : ratios.empty()                     ? ""
                                                    : ", ") +
              written(beam.at("trials").at("damping_bound_ratio"), "%.3f");
  }
  expect_quoted("rms error of C is " + ratios + " times the Cramer-Rao bound; such a ratio is known to " +
                written(1.0 / std::sqrt(200.0), "%.2f"));
}

// Oracle: the reference K = Meq w1^2 against 3EI/L^3, and against the mode's own mass; the shape 1 - cos has
// the mass (3/2 - 4/pi) m.
TEST(StudyDocument, MapsTheReferencesOfStiffness) {
  const json masses = found_by("budget").at("beams");
  const json& beams = paper_results().at("beams");
  const double own = masses.at(1).at("mass_kg"), equivalent = beams.at(1).at("equivalent_mass_kg"),
               stiffness = beams.at(1).at("reference_stiffness_n_per_m"),
               static_stiffness = 3.0 * 2.12e11 * 0.06 * std::pow(0.006, 3) / 12.0 / std::pow(1.1, 3);
  expect_quoted(written(own, "%.6f") + " kg, where Meq is\n" + written(equivalent, "%.6f") + " kg");
  expect_quoted("Meq w1^2 = " + written(stiffness, "%.3f") + " N/m, the reference of section 6, and " +
                written(100.0 * (stiffness / static_stiffness - 1.0), "%.3f") +
                " % off 3EI/L^3 = " + written(static_stiffness, "%.3f") + " N/m");
  double others = 0.0, lightest = 0.0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const double mass = beams.at(i).at("equivalent_mass_kg"), tip = beams.at(i).at("tip_mass_kg"),
                 by_cosine = (1.5 - 4.0 / std::acos(-1.0)) * 3.055 + tip;
    double& moved = i == 0 ? lightest : others;
    for (const double choice : {by_cosine, masses.at(i).at("mass_kg").get<double>()})
      moved = std::max(moved, 100.0 * std::abs(choice / mass - 1.0));
  }
  expect_quoted("move it by " + written(others, "%.0f") + " % at most on four beams and " +
                written(lightest, "%.0f") + " % on");
}

TEST(StudyDocument, QuotesHowSpecificTheDigitsAre) {
  const json& cases = paper_results().at("generator_and_filter");
  int printing = 0;
  for (const json& one : cases) {
    if (!one.at("prints_the_published_digits")) continue;
    ++printing;
    if (one.at("data") == "runge_kutta_4") continue;  // "(the same)"
    expect_quoted("(" + written(one.at("stiffness_error_percent"), "%.4f") + ", " +
                  written(one.at("damping_error_percent"), "%+.4f") + ")");
  }
  expect_quoted("of " + std::to_string(cases.size()) + " combinations " + std::to_string(printing) +
                " print");
}

TEST(StudyDocument, QuotesTheBiasAgainstTheCovariances) {
  const json& cases = paper_results().at("covariances");
  for (const json& one : cases)
    expect_quoted("| " + written(one.at("damping_error_percent"), "%+.3f") + " |");
  const double truth = 2.0 * 0.1 * std::sqrt(515.8 * 3.0);
  expect_quoted(
      "C_f - C = K dt (1 - 4 xi^2) / 2: " +
      written(
          100.0 * (paper_results().at("step_by_step").at("damping_n_s_per_m").get<double>() / truth - 1.0),
          "%+.3f") +
      " %");
  expect_quoted("stays at " +
                written(paper_results().at("printed_initial_variance").at("stiffness_n_per_m"), "%.4f") +
                " N/m");
}

TEST(StudyDocument, QuotesThePredictionsThatNeedNoDampingRatio) {
  const json& list = paper_results().at("predictions");
  expect_quoted(row_of(column_of(list, json::json_pointer("/damping_difference_n_s_per_m")), "%.3f"));
  expect_quoted(row_of(column_of(list, json::json_pointer("/damping_ratio_difference"), 100.0), "%.3f"));
  expect_quoted(row_of(column_of(list, json::json_pointer("/least_damping_error_percent")), "%.0f"));
  expect_quoted(row_of(column_of(list, json::json_pointer("/amplitude_ratio_after_four_cycles")), "%.3f"));
  const auto falls = [](const json& one) {
    return one.at("assumed_reproduced_drop").get<double>() / one.at("assumed_measured_drop").get<double>();
  };
  expect_quoted("falls by " + written(falls(list.at(1)), "%.1f") +
                " times what\nthe measured falls in four cycles, that of S(119.3) by " +
                written(falls(list.at(4)), "%.1f") + " times");
}

TEST(StudyDocument, QuotesWhatTheInnovationsShow) {
  for (const json& one : paper_results().at("two_channels")) {
    const json &nis = one.at("mean_nis"), &lag = one.at("lag_one_correlation");
    const double euler = nis.at("forward_euler"), exact = nis.at("exponential");
    if (one.at("observed") == "x") {
      if (one.at("motion") == "table 2")
        expect_quoted("mean NIS " + written(euler, "%.4f") + " and " + written(exact, "%.4f") + ".");
    } else if (one.at("motion") == "table 2" || one.at("assumed_variance") == 0.0) {
      expect_quoted(" | " + written(euler, "%.4f") + " | " + written(exact, "%.4f") + " | " +
                    written(lag.at("forward_euler"), "%+.3f") + " |");
    }
  }
}

TEST(StudyDocument, QuotesTheLotteryOnTheLightestBeam) {
  const json& results = paper_results();
  for (const char* scheme : {"exponential", "forward_euler"})
    expect_quoted(row_of(column_of(results.at("start_sample"),
                                   json::json_pointer(std::string("/") + scheme + "/damping_error_percent")),
                         "%+.2f"));
  double least = 1e9, largest = -1e9;
  for (const json& one : results.at("initial_estimate")) {
    const double error = one.at("exponential").at("damping_error_percent");
    least = std::min(least, error);
    largest = std::max(largest, error);
  }
  expect_quoted("gives " + written(least, "%+.0f") + " ... " + written(largest, "%+.0f") + " %");
  struct Count {
    int lost = 0, wild = 0, tame = 0;
    double least = 1e9, largest = -1e9, worst = 0.0;
  };
  const auto count = [&](const char* scheme, double frame) {
    Count found;
    for (const json& one : results.at("start_curve")) {
      const json& error = one.at(scheme).at("damping_error_percent");
      if (error.is_null()) {
        ++found.lost;
      } else if (std::abs(error.get<double>()) > frame) {
        ++found.wild;
        found.worst = error;
      } else {
        ++found.tame;
        found.least = std::min(found.least, error.get<double>());
        found.largest = std::max(found.largest, error.get<double>());
      }
    }
    return found;
  };
  const Count exact = count("exponential", 250.0), small = count("exponential", 5.0),
              euler = count("forward_euler", 1000.0);
  EXPECT_EQ(exact.wild, 1);
  EXPECT_EQ(euler.wild, 2);
  expect_quoted("Of " + std::to_string(results.at("start_curve").size()) +
                " starts within the first half second the exact filter loses the motion from " +
                std::to_string(exact.lost) + " and makes " + written(exact.worst, "%+.0f") +
                " % of C from one; from the other " + std::to_string(small.tame));
  expect_quoted("loses it from " + std::to_string(euler.lost) + ", makes more than +3500 % from " +
                std::to_string(euler.wild) + ", and ends between " + written(euler.least, "%+.1f") + " and " +
                written(euler.largest, "%+.1f") + " % from the other " + std::to_string(euler.tame));
  double spared = 0.0;
  for (std::size_t i = 1; i < 5; ++i) {
    const json& errors = results.at("beams").at(i).at("wide_prior").at("true_motion");
    spared = std::max(spared, std::abs(errors.at("damping_error_percent").get<double>()));
  }
  expect_quoted("the exact filter is within " + written(spared, "%.2f") + " % of C there");
  const json& modes = results.at("number_of_modes");
  expect_quoted("two modes instead of eight " +
                written(modes.at(1).at("exponential").at("damping_error_percent"), "%.0f") +
                " %, one of three loses");
  EXPECT_EQ(modes.at(2).at("exponential").at("status"), "diverged");
  std::string velocities;
  const char* formats[] = {"%.1f, ", "%.1f,\n", "%.1f, ", "%.1f and ", "%.1f mm/s after"};
  for (std::size_t i = 0; i < 5; ++i)
    velocities +=
        written(1e3 * results.at("beams").at(i).at("second_mode_velocity_m_per_s").get<double>(), formats[i]);
  expect_quoted(velocities);
}

TEST(StudyDocument, QuotesTheAlternatives) {
  for (const json& one : paper_results().at("alternatives")) {
    const auto values = one.at("damping_error_percent").get<std::vector<double>>(),
               noisy = one.at("with_process_noise_damping_error_percent").get<std::vector<double>>();
    const auto [least, largest] = std::minmax_element(values.begin(), values.end());
    const auto [noisy_least, noisy_largest] = std::minmax_element(noisy.begin(), noisy.end());
    const double size = std::max(std::abs(*noisy_least), std::abs(*noisy_largest));
    const auto wide = [&](double value) {  // three digits
      return written(value, size < 1.0                               ? "%+.3f"
                            : std::abs(value) < 100.0 && value > 0.0 ? "%+.1f"
                                                                     : "%+.0f");
    };
    expect_quoted("| " + written(*least, "%+.3f") + " to " + written(*largest, "%+.3f") + " | " +
                  wide(*noisy_least) + " to " + wide(*noisy_largest) + " |");
  }
}

TEST(StudyDocument, QuotesTheStepsOfASimulatedRecord) {
  const json& step = paper_results().at("step_size");
  const json &first = step.at("steps").front(), &last = step.at("steps").back();
  const auto percent = [](const json& one) { return written(100.0 * one.get<double>(), "%.4f"); };
  expect_quoted(percent(first.at("forward_euler_damping_ratio")) + " to " +
                percent(last.at("forward_euler_damping_ratio")) + " % found,\n" +
                percent(first.at("predicted_damping_ratio")) + " to " +
                percent(last.at("predicted_damping_ratio")) + " % predicted, " +
                percent(step.at("extrapolated_damping_ratio")) + " % extrapolated, " +
                percent(first.at("exponential_damping_ratio")) + " % by the exact scheme");
}

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
                " % of the first after a release, and C errs by at most " + written(displaced, "%.2f") +
                " %");
  expect_quoted("up to " + written(accelerated, "%.1f") + " % of C\nafter a release, up to " +
                written(struck, "%.0f") + " % after a hammer's blow");
}

TEST(StudyDocument, QuotesWhatBudgetFinds) {
  const json beams = found_by("budget").at("beams"), &beam = beams.at(1), &light = beams.at(0);
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
    const json found = found_by("identify '" + (records / (row[1] + ".txt")).string() + "' --config '" +
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
  const json found = found_by("steps '" + record.string() + "' --config '" +
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
  expect_quoted("| xi, exact [%] " + row_of(each(exact, "/found/damping_ratio", 100.0), "%.4f"));
  expect_quoted("| xi, forward Euler [%] " + row_of(each(euler, "/found/damping_ratio", 100.0), "%.4f"));
  for (const json* scheme : {&exact, &euler})
    expect_quoted("| mean NIS, exact and forward Euler " +
                  row_of(each(*scheme, "/mean_nis", 1.0), "%.3f"));
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
