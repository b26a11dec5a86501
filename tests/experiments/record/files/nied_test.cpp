// K-NET and KiK-net records. Oracle: the numbers written into the files, by hand from the format's
// description: acceleration [gal] = counts x scale, at the sampling frequency of the header.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "experiments/record/read_record.hpp"
#include "experiments/text/input_error.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::nied_test {
namespace {

using testing::HasSubstr;

std::string record_text(const std::string& direction, const std::string& counts,
                        const std::string& begin = "2000/10/06 13:30:10") {
  return "Origin Time       2000/10/06 13:30:00\n"
         "Lat.              35.278\n"
         "Long.             133.345\n"
         "Depth. (km)       11\n"
         "Mag.              7.3\n"
         "Station Code      TTRH02\n"
         "Station Lat.      35.2302\n"
         "Station Long.     133.3875\n"
         "Station Height(m) 420\n"
         "Record Time       " +
         begin +
         "\n"
         "Sampling Freq(Hz) 200Hz\n"
         "Duration Time(s)  300\n"
         "Dir.              " +
         direction +
         "\n"
         "Scale Factor      2000(gal)/1000\n"
         "Max. Acc. (gal)   720.400\n"
         "Last Correction   2000/10/06 13:30:00\n"
         "Memo.\n" +
         counts;
}

class Nied : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path / name) << text;
    return folder_.path / name;
  }
};

TEST_F(Nied, IsReadInSiUnitsItsMeanTakenOff) {
  const Record record = read_record(write("x.NS", record_text("N-S", "  10  20\n  30  40\n")));
  ASSERT_EQ(record.size(), 4);
  EXPECT_EQ(record.channels[0].quantity, Quantity::acceleration);
  EXPECT_NEAR(record.samples(0, 0), (10 - 25) * 2.0 * 0.01, 1e-15);
  EXPECT_NEAR(record.samples(0, 3), (40 - 25) * 2.0 * 0.01, 1e-15);
  EXPECT_NEAR(record.time[1], 0.005, 1e-15);
}

TEST_F(Nied, OfABoreholeIsTheBaseOfTheSurfaceBesideIt) {
  write("x.NS1", record_text("1", "1 -1 1 -1\n"));
  for (const char* const name : {"x.NS1", "x.NS2"}) {
    const Record record = read_record(write("x.NS2", record_text("4", "3 -3 3 -3\n")).parent_path() / name);
    ASSERT_EQ(record.channels.size(), 2u) << name;
    EXPECT_EQ(record.channels[0].quantity, Quantity::base_acceleration);
    EXPECT_EQ(record.channels[1].quantity, Quantity::acceleration);
    EXPECT_NEAR(record.samples(0, 0), 0.02, 1e-15);
    EXPECT_NEAR(record.samples(1, 0), 0.06, 1e-15);
  }
}

TEST_F(Nied, LeavesOutAnotherEarthquakeAtTheOtherDepth) {
  write("x.EW1", record_text("2", "1 -1 1 -1\n", "2001/01/01 00:00:00"));
  const Record record = read_record(write("x.EW2", record_text("5", "3 -3 3 -3\n")));
  EXPECT_EQ(record.channels.size(), 1u);
  ASSERT_EQ(record.objections.size(), 1u);
  EXPECT_THAT(record.objections[0].text, HasSubstr("x.EW1 is of another record"));
}

void expect_refused(const std::filesystem::path& file, const std::string& words) {
  try {
    read_record(file);
    FAIL() << words;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
}

TEST_F(Nied, RefusesWhatIsNoCountAtItsPlace) {
  expect_refused(write("x.UD", record_text("U-D", "  10  20\n  30  4x\n")), "x.UD:19:5: '4x'");
}

TEST_F(Nied, RefusesAHeaderWithoutCounts) {
  expect_refused(write("x.UD", record_text("U-D", "")), "a header without counts");
}

TEST_F(Nied, RefusesAScaleFactorThatIsNone) {
  std::string text = record_text("U-D", "1 2 3\n");
  text.replace(text.find("(gal)/"), 6, "(mgal)");
  expect_refused(write("x.UD", text), "expected 'NUMBER(gal)/NUMBER'");
}

}  // namespace
}  // namespace beamid::experiments::nied_test
