// Oracle: the keys that results.json promises to programs, one by one.
#include <gtest/gtest.h>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/studies/paper/report.hpp"
#include "tests/experiments/studies/paper/shared_outcome.hpp"

namespace beamid::experiments::paper::values_test {
namespace {

using Json = nlohmann::ordered_json;
using Pointer = Json::json_pointer;

const std::vector<std::string> schemes{"forward_euler", "backward_euler", "implicit_midpoint",
                                       "runge_kutta_2", "runge_kutta_4",  "exponential"};

void expect_finite_numbers(const Json& json, const std::string& place, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) {
    const Pointer pointer(place + "/" + key);
    ASSERT_TRUE(json.contains(pointer)) << pointer.to_string();
    ASSERT_TRUE(json[pointer].is_number()) << pointer.to_string();
    EXPECT_TRUE(std::isfinite(json[pointer].get<double>())) << pointer.to_string();
  }
}

TEST(PaperValues, HaveTheErrorsOfEveryScheme) {
  const Json json = values(test::outcome());
  for (const std::string& scheme : schemes) {
    expect_finite_numbers(json, "/table2/" + scheme, {"stiffness_error_percent", "damping_error_percent"});
    expect_finite_numbers(json, "/discretisation_bias/" + scheme,
                          {"stiffness_error_percent", "damping_error_percent",
                           "predicted_stiffness_error_percent", "predicted_damping_error_percent"});
  }
}

TEST(PaperValues, HaveEveryBeamWithEveryFilter) {
  const Json json = values(test::outcome());
  ASSERT_EQ(json["beams"].size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    const std::string place = "/beams/" + std::to_string(i);
    EXPECT_EQ(json[Pointer(place + "/name")], test_beams[i].name);
    expect_finite_numbers(json, place,
                          {"tip_mass_kg", "frequency_hz", "assumed_damping_ratio", "equivalent_mass_kg",
                           "modal_analysis/frequency_hz", "modal_analysis/damping_ratio"});
    for (const char* run :
         {"/ekf/forward_euler", "/ekf/exponential", "/ukf/forward_euler", "/ukf/exponential"}) {
      expect_finite_numbers(
          json, place + run,
          {"stiffness_n_per_m", "damping_n_s_per_m", "damping_ratio", "stiffness_error_percent",
           "damping_error_percent", "predicted_damping_error_percent", "stiffness_standard_deviation_n_per_m",
           "damping_standard_deviation_n_s_per_m"});
      EXPECT_EQ(json[Pointer(place + run + "/status")], "converged");
    }
    expect_finite_numbers(
        json, place,
        {"trials/count", "trials/stiffness_mean_error_percent", "trials/damping_mean_error_percent",
         "trials/damping_rms_error_percent", "trials/damping_bound_percent", "trials/damping_bound_ratio"});
  }
}

TEST(PaperValues, AreThoseOfTheOutcome) {
  // Oracle: the outcome itself; a key must not show another key's number.
  const Json json = values(test::outcome());
  for (std::size_t i = 0; i < schemes.size(); ++i) {
    const SchemeOutcome& o = test::outcome().schemes[i];
    const Oscillator& truth = test::outcome().truth;
    EXPECT_EQ(json["table2"][schemes[i]]["damping_error_percent"],
              percent(o.ekf.found.damping, truth.damping));
    EXPECT_EQ(json["discretisation_bias"][schemes[i]]["stiffness_error_percent"],
              percent(o.displacement_only.found.stiffness, truth.stiffness));
    EXPECT_EQ(json["discretisation_bias"][schemes[i]]["predicted_damping_error_percent"],
              percent(o.predicted.damping, truth.damping));
  }
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const BeamOutcome& o = test::outcome().beams[3];
    const Json& found = json["beams"][3][variants[i].filter][variants[i].scheme];
    EXPECT_EQ(found["stiffness_n_per_m"], o.identified[i].found.stiffness);
    EXPECT_EQ(found["damping_error_percent"],
              percent(o.identified[i].found.damping, o.beam.reference.damping));
    EXPECT_EQ(found["damping_standard_deviation_n_s_per_m"], o.identified[i].damping_deviation);
  }
}

TEST(PaperValues, AreTheSameForTheSameSeed) {
  // Oracle: the study run again, byte for byte.
  const Outcome again = investigate(2009, 2, [](const std::string&) {});
  EXPECT_EQ(values(again).dump(), values(test::outcome()).dump());
  EXPECT_EQ(configuration(again).dump(), configuration(test::outcome()).dump());
}

}  // namespace
}  // namespace beamid::experiments::paper::values_test
