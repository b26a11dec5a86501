// docs/study.md against `beamid paper`. Oracle of every number: what the command finds now.

#include <algorithm>
#include <cmath>

#include "tests/apps/quoted.hpp"

namespace beamid::apps::study_paper_test {
namespace {

using nlohmann::json;

TEST(StudyDocument, QuotesWhatPaperFinds) {
  const json& results = found_by("paper");
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
  const json& masses = found_by("budget").at("beams");
  const json& beams = found_by("paper").at("beams");
  const double own = masses.at(1).at("mass_kg"), equivalent = beams.at(1).at("equivalent_mass_kg"),
               stiffness = beams.at(1).at("reference_stiffness_n_per_m"),
               static_stiffness = 3.0 * 2.12e11 * 0.06 * std::pow(0.006, 3) / 12.0 / std::pow(1.1, 3);
  expect_quoted(written(own, "%.6f") + " kg, where Meq is\n" + written(equivalent, "%.6f") + " kg");
  expect_quoted(R"($M_{eq} \omega_1^2$ = )" + written(stiffness, "%.3f") +
                " N/m, the reference of section 6, and " +
                written(100.0 * (stiffness / static_stiffness - 1.0), "%.3f") +
                " % off $3 EI/L^3$ = " + written(static_stiffness, "%.3f") + " N/m");
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
  const json& cases = found_by("paper").at("generator_and_filter");
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
  const json& cases = found_by("paper").at("covariances");
  for (const json& one : cases)
    expect_quoted("| " + written(one.at("damping_error_percent"), "%+.3f") + " |");
  const double truth = 2.0 * 0.1 * std::sqrt(515.8 * 3.0);
  expect_quoted(
      R"($C_f - C = K \Delta t (1 - 4 \xi^2) / 2$: )" +
      written(
          100.0 * (found_by("paper").at("step_by_step").at("damping_n_s_per_m").get<double>() / truth - 1.0),
          "%+.3f") +
      " %");
  expect_quoted("stays at " +
                written(found_by("paper").at("printed_initial_variance").at("stiffness_n_per_m"), "%.4f") +
                " N/m");
}

TEST(StudyDocument, QuotesThePredictionsThatNeedNoDampingRatio) {
  const json& list = found_by("paper").at("predictions");
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
  for (const json& one : found_by("paper").at("two_channels")) {
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
  const json& results = found_by("paper");
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
  for (const json& one : found_by("paper").at("alternatives")) {
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
  const json& step = found_by("paper").at("step_size");
  const json &first = step.at("steps").front(), &last = step.at("steps").back();
  const auto percent = [](const json& one) { return written(100.0 * one.get<double>(), "%.4f"); };
  expect_quoted(percent(first.at("forward_euler_damping_ratio")) + " to " +
                percent(last.at("forward_euler_damping_ratio")) + " % found,\n" +
                percent(first.at("predicted_damping_ratio")) + " to " +
                percent(last.at("predicted_damping_ratio")) + " % predicted, " +
                percent(step.at("extrapolated_damping_ratio")) + " % extrapolated, " +
                percent(first.at("exponential_damping_ratio")) + " % by the exact scheme");
}

}  // namespace
}  // namespace beamid::apps::study_paper_test
