// Free decays of real cantilevers, identified through the filter. Oracle: the independent fits in the data's
// README, over the same windows.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/studies/identify/report.hpp"
#include "fem/beam.hpp"

namespace beamid::experiments::measured_record_test {
namespace {

constexpr double standard_gravity = 9.80665;  // m/s2

struct MeasuredWindow {
  const char* file;
  double tip_mass;  // kg, without the accelerometer
  double from, to;  // s
  double frequency_hz, damping_ratio;
};

std::filesystem::path folder() {
  return std::filesystem::path(BEAMID_SOURCE_DIR) / "../shared/data/unb-tip-mass";
}

// Catalogue values: 350 mm x 25 mm x 6 mm, 210 GPa, 0.445 kg; an accelerometer of 0.054 kg on the tip.
Experiment cantilever(double tip_mass) {
  Experiment experiment;
  experiment.structure = fem::Beam(fem::Cantilever{0.350, 210e9 * fem::rectangle_second_moment(0.025, 0.006),
                                                   0.445 / 0.350, tip_mass + 0.054});
  return experiment;
}

// Tip acceleration [g] in the third column; the printed times are rounded, the rate is known.
Record read(const MeasuredWindow& window) {
  RecordFormat format;
  format.time = ColumnDescription{Quantity::acceleration, "", 1, 1.0};
  format.sampling_rate = 51200.0 / 31.0;
  format.channels = {{Quantity::acceleration, "", 3, standard_gravity}};
  format.window = {window.from, window.to};
  return read_record(folder() / window.file, format);
}

class MeasuredRecord : public testing::TestWithParam<MeasuredWindow> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder())) GTEST_SKIP() << "no measured records in " << folder();
  }
};

class CleanDecay : public MeasuredRecord {};

TEST_P(CleanDecay, IsIdentifiedAsByTheIndependentFit) {
  const MeasuredWindow& window = GetParam();
  const RecordIdentification r = identify_record(cantilever(window.tip_mass), read(window));
  ASSERT_FALSE(r.identification.run.failure);
  const Oscillator& found = r.identification.found;
  RecordProperty("frequency_hz", std::to_string(found.frequency_hz()));
  RecordProperty("damping_ratio", std::to_string(found.damping_ratio()));
  EXPECT_NEAR(found.frequency_hz() / window.frequency_hz, 1.0, 0.005);
  EXPECT_NEAR(found.damping_ratio() / window.damping_ratio, 1.0, 0.15);
  EXPECT_NEAR(r.modal.frequency_hz / window.frequency_hz, 1.0, 0.005);
  EXPECT_TRUE(r.modal.companions.empty());
  EXPECT_GE(r.interval_factor, 1.0);
  // The catalogue's beam is wrong by up to 9 % in frequency; what was measured overrules it.
  EXPECT_GT(std::abs(r.beam_frequency_hz / window.frequency_hz - 1.0), 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    UnbTipMass, CleanDecay,
    testing::Values(MeasuredWindow{"massa1_test1-1.txt", 1.437, 0.308, 0.708, 11.166, 0.0145},
                    MeasuredWindow{"massa1_test1-1.txt", 1.437, 0.808, 1.608, 11.223, 0.0128},
                    MeasuredWindow{"massa2_test1-2.txt", 0.712, 0.808, 1.608, 14.40, 0.0139},
                    MeasuredWindow{"massa3_test2-3.txt", 0.270, 0.707, 1.307, 19.86, 0.0176}));

class DoubleHit : public MeasuredRecord {};

TEST_P(DoubleHit, IsIdentifiedInFrequencyAndItsSecondModeReported) {
  // The hammer hit twice and the tip rings in another mode near 28.3 Hz, which a single degree of freedom
  // takes for damping: the frequency holds, the damping ratio is not asked for, and the report says why.
  const MeasuredWindow& window = GetParam();
  const Experiment experiment = cantilever(window.tip_mass);
  const Record record = read(window);
  const RecordIdentification r = identify_record(experiment, record);
  ASSERT_FALSE(r.identification.run.failure);
  EXPECT_NEAR(r.identification.found.frequency_hz() / window.frequency_hz, 1.0, 0.005);
  EXPECT_NEAR(r.modal.damping_ratio / window.damping_ratio, 1.0, 0.15);  // it fits both modes
  ASSERT_EQ(r.modal.companions.size(), 1u);
  EXPECT_NEAR(r.modal.companions[0].frequency_hz, 28.3, 0.3);
  const Results results = report(experiment, record, window.file, r);
  EXPECT_EQ(results.values["modal_analysis"]["companions"].size(), 1u);
  std::ostringstream printed;
  print(printed, results);
  EXPECT_NE(printed.str().find("Beside the mode there is another at 28."), std::string::npos);
  ASSERT_TRUE(r.consistency);
  EXPECT_FALSE(r.consistency->white());  // the innovations tell it too
}

INSTANTIATE_TEST_SUITE_P(
    UnbTipMass, DoubleHit,
    testing::Values(MeasuredWindow{"massa4_test2-4.txt", 0.128, 0.608, 1.008, 22.66, 0.027},
                    MeasuredWindow{"massa4_test1-4.txt", 0.128, 0.608, 1.008, 22.77, 0.0295}));

}  // namespace
}  // namespace beamid::experiments::measured_record_test
