// Bad input: one message with its place, exit code 2, nothing on standard output, nothing written.
#include <gmock/gmock.h>

#include <regex>

#include "tests/apps/run_command.hpp"

namespace beamid::apps::bad_input_test {
namespace {

/// One thing wrong with the tutorial's experiment file or its record.
struct Fault {
  const char* name;
  const char* file;         ///< to be changed: "cantilever.toml" or "tip_acceleration.csv"
  const char* pattern;      ///< a regular expression; its first match
  const char* replacement;  ///< is replaced by this
  const char* message;      ///< first line of standard error
  const char* words = "identify --config cantilever.toml";
};

void PrintTo(const Fault& fault, std::ostream* stream) {
  *stream << fault.message;
}

class BadInput : public testing::TestWithParam<Fault> {};

TEST_P(BadInput, IsRefusedWithItsPlace) {
  const Fault& fault = GetParam();
  Workplace place;
  fs::copy(source("docs/tutorials/02_identify_a_record"), place.folder(), fs::copy_options::recursive);
  place.write("taken", "a file");
  const std::string text = contents(place.folder() / fault.file),
                    changed = std::regex_replace(text, std::regex(fault.pattern), fault.replacement,
                                                 std::regex_constants::format_first_only);
  ASSERT_TRUE(*fault.pattern == 0 || text != changed);
  place.write(fault.file, changed);
  const auto before = place.files();

  const bool writes = std::string(fault.words).find("--out") != std::string::npos;
  const Outcome outcome = place.run(fault.words + std::string(writes ? "" : " --out results"));
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.first_error_line(), fault.message);
  EXPECT_THAT(outcome.out, testing::IsEmpty());
  EXPECT_EQ(place.files(), before);
}

constexpr const char* toml = "cantilever.toml";
constexpr const char* record = "tip_acceleration.csv";

std::string name_of(const testing::TestParamInfo<Fault>& tested) {
  return tested.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Experiment, BadInput,
    testing::Values(
        Fault{"Missing", toml, "", "", "no.toml: no such file; expected a TOML file",
              "identify --config no.toml"},
        Fault{"IsAFolder", toml, "", "", ".: a directory; expected a TOML file", "identify --config ."},
        Fault{"NotNamed", toml, "", "",
              "beamid: identify: which RECORD? Expected a record, --config FILE, or both", "identify"},
        Fault{"NegativeMass", toml, "mass_kg = 3.055", "mass_kg = -3.055",
              "cantilever.toml:10:11: beam.mass_kg is -3.055; expected a positive number"},
        Fault{"UnknownFilter", toml, "\"ekf\"", "\"ufk\"",
              "cantilever.toml:18:10: unknown filter 'ufk'; did you mean 'ukf'?"},
        Fault{"UnknownDiscretisation", toml, "\"exponential\"", "\"euler\"",
              "cantilever.toml:19:18: unknown discretisation 'euler'; known: backward_euler, cvode, "
              "exponential, forward_euler, implicit_midpoint, pade, runge_kutta_2, runge_kutta_4, "
              "runge_kutta_4_differences"},
        Fault{"UnknownKey", toml, "length_m", "lenght_m",
              "cantilever.toml:6:1: unknown key 'lenght_m' in beam; did you mean 'length_m'?"},
        Fault{"WrongUnit", toml, "\\[record\\]",
              "[record]\nchannels = [{ quantity = \"acceleration\", column = 2, unit = \"m/s\" }]",
              "cantilever.toml:14:61: record.channels[1].unit is the text \"m/s\"; expected a unit of "
              "acceleration: m/s2, mm/s2, g"},
        Fault{"NoUnit", toml, "\\[record\\]",
              "[record]\nchannels = [{ quantity = \"acceleration\", column = 2 }]",
              "cantilever.toml:14:13: record.channels[1].unit is missing; expected a unit of acceleration: "
              "m/s2, mm/s2, g"},
        Fault{
            "WindowOutside", toml, "10\\.0\\]", "20.0]",
            "cantilever.toml:15:12: window 2 to 20 s; expected at least 16 samples inside the record, which "
            "runs from 0 to 10 s"},
        Fault{"NoBeam", toml, "\\[beam\\]", "[reduction]",
              "cantilever.toml: beam is missing; expected a table"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Record, BadInput,
    testing::Values(
        Fault{"Missing", record, "", "", "no.csv: no such file; expected a record of numbers in columns",
              "identify no.csv --config cantilever.toml"},
        Fault{"NotANumber", record, "\n0\\.4,[^\n]*", "\n0.4,nan",
              "tip_acceleration.csv:102:5: column 2 holds 'nan'; expected a finite number within double "
              "precision"},
        Fault{"Text", record, "\n0\\.4,[^\n]*", "\n0.4,fault",
              "tip_acceleration.csv:102:5: column 2 holds 'fault'; expected a number"},
        Fault{"EmptyField", record, "\n0\\.4,[^\n]*", "\n0.4,",
              "tip_acceleration.csv:102:5: column 2 holds no entry; expected a number"},
        Fault{"MissingSample", record, "\n0\\.4,[^\n]*", "",
              "tip_acceleration.csv:102:1: time 0.404 after 0.396: 1 row is missing between them, at the "
              "median interval 0.004; expected all rows, or [record] with stamps = \"as_they_are\" (usual) "
              "and malformed = \"missing\", which takes their samples for not read, and missing_input = "
              "\"leave_out\" where an input was measured"},
        Fault{"TimeRunsBack", record, "\n0\\.4,", "\n0.3,",
              "tip_acceleration.csv:102:1: time 0.3 after 0.396; expected increasing times"},
        Fault{
            "UnknownUnit", record, "acceleration_tip_m_per_s2", "acceleration_tip_ft_per_s2",
            "tip_acceleration.csv:1: unknown column 'acceleration_tip_ft_per_s2'; expected names with units "
            "(time_s, time_ms, time_us, displacement_m, displacement_mm, displacement_um, velocity_m_per_s, "
            "velocity_mm_per_s, acceleration_m_per_s2, acceleration_mm_per_s2, acceleration_g, force_n, "
            "force_kn, strain_m_per_m, strain_um_per_m, base_acceleration_m_per_s2, "
            "base_acceleration_mm_per_s2, base_acceleration_g, support_acceleration_m_per_s2, "
            "support_acceleration_mm_per_s2, support_acceleration_g, angular_acceleration_rad_per_s2, "
            "angular_acceleration_mrad_per_s2), or --column N --quantity acceleration --unit g, or "
            "record.channels "
            "in the configuration"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Words, BadInput,
    testing::Values(
        Fault{"OutIsAFile", toml, "", "",
              "beamid: output folder 'taken' is a file; expected a folder or a new name",
              "identify --config cantilever.toml --out taken"},
        Fault{"WindowOutside", toml, "", "",
              "--window: window 2 to 20 s; expected at least 16 samples inside the record, which runs from 0 "
              "to 10 s",
              "identify --config cantilever.toml --window 2 20"},
        Fault{"HalfAWindow", toml, "", "", "beamid: identify: --window needs two times: FROM TO",
              "identify --config cantilever.toml --window 2"},
        Fault{"TwoRecords", toml, "", "", "b.csv: no such file; expected a record of numbers in columns",
              "identify tip_acceleration.csv b.csv --config cantilever.toml"}),
    name_of);

}  // namespace
}  // namespace beamid::apps::bad_input_test
