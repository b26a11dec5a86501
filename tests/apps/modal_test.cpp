// beamid modal, end to end: what a user gets.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "experiments/signal/toolbox.hpp"
#include "tests/apps/run_command.hpp"

namespace beamid::apps::modal_test {
namespace {

using nlohmann::json, testing::HasSubstr;

/// A decay of 5 (or as told) and 8 Hz in two channels, 4 s at 100 Hz, as a CSV file.
std::string decay(double amplitude, std::uint64_t seed, double first_hz = 5) {
  const Eigen::VectorXd noise = experiments::standard_normal(800, seed, 1);
  std::ostringstream text;
  text << "time_s,acceleration_tip_m_per_s2,acceleration_middle_m_per_s2\n";
  const auto part = [](double f, double ratio, double t) {
    const double w = 2 * std::numbers::pi * f;
    return std::exp(-ratio * w * t) * std::cos(w * std::sqrt(1 - ratio * ratio) * t);
  };
  for (int k = 0; k < 400; ++k) {
    const double t = 0.01 * k, a = amplitude * part(first_hz, 0.01, t), b = amplitude * part(8, 0.02, t);
    text << t << "," << a + 0.5 * b + 0.01 * noise[2 * k] << "," << 0.4 * a - b + 0.01 * noise[2 * k + 1]
         << "\n";
  }
  return text.str();
}

// Oracle: what the record was made of.
TEST(Modal, FindsTheModesOfADecayAndWritesTheirFigures) {
  Workplace place;
  place.write("decay.csv", decay(1, 1));
  const Outcome outcome = place.run("modal decay.csv --window 0 3.99 --out found");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* file : {"results.json", "modes.csv", "stabilisation.png", "reproduction.png",
                           "singular_values.svg", "modes.glb"})
    EXPECT_TRUE(fs::exists(place.folder() / "found" / file)) << file;
  EXPECT_THAT(contents(place.folder() / "found" / "report.html"),
              HasSubstr("class=\"motion\" data-name=\"modes\""));
  const json found = json::parse(contents(place.folder() / "found" / "results.json"))["records"][0];
  ASSERT_EQ(found["modes"].size(), 2u) << outcome.out;
  const double frequencies[] = {5, 8}, ratios[] = {0.01, 0.02}, amplitudes[][2] = {{1, 0.4}, {0.5, 1}};
  for (int m = 0; m < 2; ++m) {
    const json& mode = found["modes"][m];
    EXPECT_NEAR(mode["frequency_hz"].get<double>(), frequencies[m],
                4 * mode["frequency_standard_deviation_hz"].get<double>());
    EXPECT_NEAR(mode["damping_ratio"].get<double>(), ratios[m],
                4 * mode["damping_ratio_standard_deviation"].get<double>());
    for (int i = 0; i < 2; ++i)
      EXPECT_NEAR(mode["shape"][i]["amplitude"].get<double>(), amplitudes[m][i], 0.02);
    EXPECT_GT(mode["phase_collinearity"].get<double>(), 0.999);
  }
  EXPECT_LT(found["response_error_percent"].get<double>(), 5);
}

// Oracle: what the record was made of; of the width alone, the theory of half power on a finite record.
TEST(Modal, FindsThemModeByModeAsWell) {
  Workplace place;
  place.write("decay.csv", decay(1, 1));
  for (const std::string method :
       {"logarithmic_decrement", "hilbert_envelope", "half_power", "damped_sine"}) {
    const Outcome outcome = place.run("modal decay.csv --window 0 3.99 --json --method " + method);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json all = json::parse(outcome.out), found = all["records"][0];
    ASSERT_EQ(found["modes"].size(), 2u) << method;
    EXPECT_FALSE(found["polished"].get<bool>());
    for (int m = 0; m < 2; ++m) {
      const json& mode = found["modes"][m];
      EXPECT_NEAR(mode["frequency_hz"].get<double>(), m ? 8 : 5,
                  4 * mode["frequency_standard_deviation_hz"].get<double>() + 1e-3)
          << method;
      EXPECT_NEAR(mode["damping_ratio"].get<double>(), m ? 0.02 : 0.01,
                  4 * mode["damping_ratio_standard_deviation"].get<double>() + 1e-4)
          << method;
    }
    EXPECT_EQ(all["messages"].size(), method == "half_power" ? 2u : 0u);
  }
}

// Oracle: the file that `beamid prepare` leaves, analysed as it is.
TEST(Modal, PreparesTheRecordAsTheExperimentFileSays) {
  Workplace place;
  place.write("decay.csv", decay(1, 1));
  place.write("steps.toml",
              "[record]\nfile = \"decay.csv\"\nwindow_s = [0.5, 3.5]\n[[record.prepare]]\nstep = "
              "\"high_pass\"\ncorner_hz = 2\n");
  const Outcome outcome = place.run("modal --config steps.toml --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["preparations"][0]["steps"][0]["step"], "high_pass");
  EXPECT_THAT(found["messages"].dump(), HasSubstr("Butterworth high-pass of order 2 at 2 Hz"));
  place.write("beam.toml",
              "[beam]\nlength_m = 1\nwidth_m = 0.02\nheight_m = 0.005\n"
              "youngs_modulus_pa = 210e9\nmass_kg = 0.785\n" +
                  contents(place.folder() / "steps.toml"));
  ASSERT_EQ(place.run("prepare --config beam.toml --out prepared").code, 0);
  const Outcome again = place.run("modal prepared/prepared.csv --window 0.5 3.5 --json");
  ASSERT_EQ(again.code, 0) << again.err;
  const json modes = json::parse(again.out)["records"][0]["modes"];
  ASSERT_EQ(modes.size(), found["records"][0]["modes"].size());
  for (std::size_t m = 0; m < modes.size(); ++m)
    EXPECT_NEAR(modes[m]["damping_ratio"].get<double>(),
                found["records"][0]["modes"][m]["damping_ratio"].get<double>(), 1e-8);
}

TEST(Modal, MergesRecordsAndSaysWhereTheyDisagree) {
  Workplace place;
  place.write("one.csv", decay(1, 1));
  place.write("two.csv", decay(2, 2));
  const Outcome outcome = place.run("modal one.csv two.csv --json --band 2 12");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json merged = json::parse(outcome.out)["merged_modes"];
  ASSERT_EQ(merged.size(), 2u);
  EXPECT_EQ(merged[0]["records"], 2);
  EXPECT_NEAR(merged[0]["frequency_hz"]["mean"].get<double>(), 5, 2e-3);
  EXPECT_FALSE(merged[0]["frequency_hz"]["records_disagree"].get<bool>());
  place.write("three.csv", decay(1, 3, 5.05));
  const Outcome changed = place.run("modal one.csv three.csv --band 2 12");
  EXPECT_THAT(changed.out, HasSubstr("than their standard deviations allow"));
  EXPECT_THAT(changed.out, HasSubstr("(mode 1)"));
}

TEST(Modal, NamesWhatItRefuses) {
  Workplace place;
  place.write("decay.csv", decay(1, 1));
  place.write("other.csv", "time_s,acceleration_m_per_s2\n0,1\n0.1,0\n0.2,1\n0.3,0\n");
  const std::pair<const char*, const char*> refused[] = {
      {"decay.csv --method ear", "unknown modal method 'ear'; did you mean 'era'?"},
      {"decay.csv --method logarithmic_decrement:smallest_swing=2", "smallest_swing is 2"},
      {"decay.csv --method half_power:window_decay=-1", "window_decay is -1; expected 0 to 20"},
      {"--config nowhere.toml", "nowhere.toml"},
      {"", "modal: which RECORD?"},
      {"decay.csv --band 5 2", "--band ends at 2, before its start at 5"},
      {"decay.csv --band 5 60", "band 5 to 60 Hz; expected"},
      {"decay.csv --order 3", "--order is 3; expected a whole number from 4 to 80"},
      {"decay.csv --polish --no-polish", "--polish and --no-polish exclude each other"},
      {"decay.csv --method ssi_cov:rows=20", "segments of the"},
      {"decay.csv --method frf_lscf", "the record has no channel of force"},
      {"decay.csv --method frf_lscf:estimator=h3", "estimator is 'h3'; expected h1 or h2"},
      {"decay.csv --method frf_lscf --amplitude", "--amplitude follows a free decay"},
      {"decay.csv other.csv", "expected the same, in the same order"}};
  for (const auto& [words, message] : refused) {
    const Outcome outcome = place.run(std::string("modal ") + words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << words;
  }
}

// Oracle: the independent fits in the data's README; two damped sines by scipy for the modes of massa4.
TEST(Modal, AgreesWithIndependentFitsOfMeasuredRecords) {
  const fs::path folder = source("../shared/data/unb-tip-mass");
  if (!fs::exists(folder)) GTEST_SKIP() << "no measured records in " << folder;
  const struct {
    const char *file, *window;
    std::vector<std::pair<double, double>> modes;
  } records[] = {{"massa1_test1-1.txt", "0.308 0.708", {{11.166, 0.0145}}},
                 {"massa1_test1-1.txt", "0.808 1.608", {{11.223, 0.0128}}},
                 {"massa2_test1-2.txt", "0.808 1.608", {{14.40, 0.0139}}},
                 {"massa3_test2-3.txt", "0.707 1.307", {{19.86, 0.0176}}},
                 {"massa4_test2-4.txt", "0.608 1.008", {{22.69183, 0.0259403}, {28.38235, 0.025672}}},
                 {"massa4_test1-4.txt", "0.608 1.008", {{22.78437, 0.0272805}, {28.30980, 0.019745}}}};
  for (const auto& record : records) {
    const Outcome outcome = Workplace().run("modal '" + (folder / record.file).string() +
                                            "' --column 3 --quantity acceleration --unit g --time 1 " +
                                            "--rate 1651.6129 --json --window " + record.window);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json modes = json::parse(outcome.out)["records"][0]["modes"];
    ASSERT_GE(modes.size(), record.modes.size()) << record.file;
    for (std::size_t m = 0; m < record.modes.size(); ++m) {
      EXPECT_NEAR(modes[m]["frequency_hz"].get<double>() / record.modes[m].first, 1, 0.002) << record.file;
      EXPECT_NEAR(modes[m]["damping_ratio"].get<double>() / record.modes[m].second, 1, 0.1) << record.file;
    }
  }
}

// Oracle: the record's damping ratios, 1 % and 2 %, at every amplitude.
TEST(Modal, FollowsEveryModeAlongItsAmplitude) {
  Workplace place;
  place.write("decay.csv", decay(1, 1));
  const Outcome outcome = place.run("modal decay.csv --window 0 3.99 --amplitude --out found");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json found = json::parse(contents(place.folder() / "found" / "results.json"))["amplitude_dependence"];
  ASSERT_EQ(found.size(), 2u);
  for (int m = 0; m < 2; ++m) {
    ASSERT_GE(found[m]["points"].size(), 1u) << outcome.out;
    for (const json& point : found[m]["points"])
      EXPECT_NEAR(point["damping_ratio"].get<double>(), m == 0 ? 0.01 : 0.02,
                  5 * point["damping_ratio_standard_deviation"].get<double>() + 2e-4);
  }
}

// Oracle: the masses of the data's README: 1.596 kg from the catalogue for massa1, 0.871 kg for massa2, whose
// own impulse and velocity step weigh 0.95 kg there. Two ways that agree within their deviations:
// impulse over velocity step, and the residue.
TEST(Modal, WeighsTheTipOfMeasuredHammerTests) {
  const fs::path folder = source("../shared/data/unb-tip-mass");
  if (!fs::exists(folder)) GTEST_SKIP() << "no measured records in " << folder;
  const struct {
    const char *file, *band;
    double mass, tolerance;
  } records[] = {{"massa1_test1-1.txt", "4 18", 1.60, 0.05}, {"massa2_test1-2.txt", "6 22", 0.95, 0.06}};
  for (const auto& record : records) {
    const Outcome outcome = Workplace().run(
        "modal '" + (folder / record.file).string() +
        "' --column 3 --column 4 --quantity acceleration --quantity force --unit g --unit N --time 1 " +
        "--rate 1651.6129 --json --method frf_lscf --band " + record.band);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json found = json::parse(outcome.out);
    ASSERT_FALSE(found["modes"].empty()) << record.file;
    const double residue = found["modes"][0]["channels"][0]["modal_mass_kg"],
                 step = found["hammer_mass"][0]["mass_kg"];
    EXPECT_NEAR(residue / record.mass, 1, record.tolerance) << record.file;
    EXPECT_NEAR(step / record.mass, 1, record.tolerance) << record.file;
    const double deviation =
        std::hypot(found["modes"][0]["channels"][0]["modal_mass_standard_deviation_kg"].get<double>(),
                   found["hammer_mass"][0]["mass_standard_deviation_kg"].get<double>());
    EXPECT_NEAR(step, residue, 3 * deviation) << record.file;
    EXPECT_LT(deviation, 0.05 * residue) << record.file;
  }
}

// Both modes of massa4, whose frequencies rise by 3 and 10 % as they decay. Oracle: damped sines fitted to
// the first 0.3 s after the hit, without the force: 22.05 and 25.6 Hz. A window that leaves a hundredth
// weighs about as much; with the default, a thousandth, the lower one is where its amplitudes are
// larger, 21.4 Hz.
TEST(Modal, ResolvesTwoNearModesOfAMeasuredHammerTest) {
  const fs::path folder = source("../shared/data/unb-tip-mass");
  if (!fs::exists(folder)) GTEST_SKIP() << "no measured records in " << folder;
  for (const char* file : {"massa4_test1-4.txt", "massa4_test2-4.txt"})
    for (const char* band : {"10 40", "10 60"}) {
      const Outcome outcome = Workplace().run(
          "modal '" + (folder / file).string() +
          "' --column 3 --column 4 --quantity acceleration --quantity force --unit g --unit N --time 1 " +
          "--rate 1651.6129 --json --method frf_lscf:window_end=0.01 --band " + band);
      ASSERT_EQ(outcome.code, 0) << outcome.err;
      const json found = json::parse(outcome.out), modes = found["modes"];
      ASSERT_EQ(modes.size(), 2u) << file << " " << band;
      EXPECT_NEAR(modes[0]["frequency_hz"].get<double>(), 22.05, 0.03 * 22.05);
      EXPECT_NEAR(modes[1]["frequency_hz"].get<double>(), 25.6, 0.03 * 25.6);
      EXPECT_LT(found["response_error_percent"].get<double>(), 15);
      EXPECT_FALSE(modes[0]["frequency_standard_deviation_hz"].is_null());
      EXPECT_THAT(found["messages"].dump(), HasSubstr("no pole that is stable over the orders"));
    }
}

/// A column of one mode on a base that shakes at random, 40 s at 50 Hz, as a CSV file.
std::string event(double first_hz, double size, std::uint64_t seed) {
  constexpr int count = 2000, fine = 40;
  constexpr double step = 0.02 / fine;
  const Eigen::VectorXd draws = experiments::standard_normal(count + 1, seed, 1);
  const double w = 2 * std::numbers::pi * first_hz;
  std::ostringstream text;
  text << "time_s,base_acceleration_m_per_s2,acceleration_surface_m_per_s2\n";
  double base = 0, x = 0, v = 0;
  for (int k = 0; k < count; ++k) {
    const double next = 0.6 * base + size * draws[k] * std::sin(std::numbers::pi * k / count);
    text << 0.02 * k << "," << base << "," << base + (-base - 0.1 * w * v - w * w * x) << "\n";
    for (int i = 0; i < fine; ++i) {
      const double u = base + (next - base) * i / fine;
      v += step * (-u - 0.1 * w * v - w * w * x);
      x += step * v;
    }
    base = next;
  }
  return text.str();
}

TEST(Modal, OfADrivenRecordIsForModalAndNotForCommandsOfADecay) {
  Workplace place;
  place.write("event.csv", event(3.0, 1.0, 1));
  EXPECT_EQ(place.run("modal event.csv").code, 0);
  for (const char* command : {"track", "backbone"}) {
    const Outcome outcome = place.run(std::string(command) + " event.csv");
    EXPECT_EQ(outcome.code, 2) << command;
    EXPECT_THAT(outcome.err, HasSubstr("an input is measured that drives the motion")) << command;
  }
}

// Oracle: what the records were made of.
TEST(Modal, FollowsTheFirstModeOverThePeakAcceleration) {
  Workplace place;
  place.write("weak.csv", event(3.0, 0.02, 1));
  place.write("middle.csv", event(2.8, 0.3, 2));
  place.write("strong.csv", event(2.5, 2.0, 3));
  const Outcome outcome = place.run("modal weak.csv middle.csv strong.csv --events --out found");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("the stiffness changed by -3"));
  EXPECT_TRUE(fs::exists(place.folder() / "found" / "f1_over_pga.png"));
  const json found = json::parse(contents(place.folder() / "found" / "results.json"))["events"];
  ASSERT_EQ(found.size(), 3u);
  const double frequencies[] = {3.0, 2.8, 2.5};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[i]["frequency_hz"].get<double>(), frequencies[i], 0.015);
    EXPECT_NEAR(found[i]["damping_ratio"].get<double>(), 0.05, 0.006);
  }
}

// The record with one column of every line changed.
std::string with_second_column(const std::string& record, double factor) {
  std::istringstream lines(record);
  std::ostringstream changed;
  std::string line;
  for (bool first = true; std::getline(lines, line); first = false) {
    const std::size_t last = line.rfind(',');
    if (first)
      changed << line << "\n";
    else
      changed << line.substr(0, last) << "," << factor * std::stod(line.substr(last + 1)) << "\n";
  }
  return changed.str();
}

// Oracle: what was done to the record.
TEST(Modal, SaysThatTheSurfacePointsTheOtherWay) {
  Workplace place;
  place.write("turned.csv", with_second_column(event(2.5, 1.0, 4), -1.0));
  const Outcome outcome = place.run("modal turned.csv --events");
  EXPECT_EQ(outcome.code, 3) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("The sign of one channel is turned"));
  place.write("right.csv", with_second_column(event(2.5, 1.0, 4), 1.0));
  const Outcome right = place.run("modal right.csv --events");
  EXPECT_EQ(right.code, 0) << right.out;
}

TEST(Modal, NeedsTheMotionOfTheBaseForEvents) {
  Workplace place;
  place.write("decay.csv", decay(1, 1));
  const Outcome outcome = place.run("modal decay.csv --events");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no channel of base_acceleration"));
}

/// Samples of a signal at 200 Hz as a CSV file.
std::string accelerations(int count, const std::function<double(int)>& signal) {
  std::ostringstream text;
  text << "time_s,acceleration_m_per_s2\n";
  for (int k = 0; k < count; ++k) text << fmt::format("{:.3f},{:.7g}\n", 0.005 * k, signal(k));
  return text.str();
}

// What holds no mode gives no number with exit code 0: noise, the sine of a generator, tones that come and
// go.
TEST(Modal, OfARecordWithoutAStructureFails) {
  Workplace place;
  const Eigen::VectorXd noise = experiments::standard_normal(4000, 7, 0);
  const double w = 2 * std::numbers::pi * 0.005;
  place.write("noise.csv", accelerations(4000, [&](int k) { return noise[k]; }));
  place.write("sine.csv",
              accelerations(4000, [&](int k) { return std::sin(7.3 * w * k) + 0.01 * noise[k]; }));
  place.write("tones.csv", accelerations(4000, [&](int k) {
                const double tones[] = {5.1, 7.7, 6.4, 9.2, 5.8, 8.3, 7.1, 6.0};
                return std::sin(tones[k / 500] * w * k) + 0.01 * noise[k];
              }));
  for (const char* record : {"noise.csv", "sine.csv", "tones.csv"}) {
    const Outcome outcome = place.run(std::string("modal ") + record);
    EXPECT_EQ(outcome.code, 3) << record << "\n" << outcome.out;
  }
  EXPECT_THAT(place.run("modal sine.csv").out, HasSubstr("steady sine"));
}

// Oracle: the motion that was made, held for 2 s and then released at 3.1 Hz with 1 %.
TEST(Modal, BeginsBehindTheReleaseOfWhatWasHeld) {
  Workplace place;
  const Eigen::VectorXd noise = experiments::standard_normal(4000, 8, 0);
  const double omega = 2 * std::numbers::pi * 3.1;
  std::string text = accelerations(4000, [&](int k) {
    const double t = 0.005 * (k - 400);
    return (t < 0 ? 1.0 : std::exp(-0.01 * omega * t) * std::cos(omega * t)) + 0.005 * noise[k];
  });
  text.replace(0, text.find('\n'), "time_s,displacement_mm");
  place.write("held.csv", text);
  const Outcome outcome = place.run("modal held.csv --json");
  ASSERT_EQ(outcome.code, 0) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("the release of what was held"));
  const json mode = json::parse(outcome.out)["records"][0]["modes"][0];
  EXPECT_NEAR(mode["frequency_hz"].get<double>(), 3.1, 0.003);
  EXPECT_NEAR(mode["damping_ratio"].get<double>(), 0.01, 0.0005);
}

}  // namespace
}  // namespace beamid::apps::modal_test
