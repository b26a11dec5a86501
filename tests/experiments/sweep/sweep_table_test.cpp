// What a sweep writes and counts. Oracles: a table worked out by hand; HDF5 itself.
#include <gmock/gmock.h>
#include <hdf5.h>

#include <array>
#include <cmath>

#include "experiments/sweep/hdf5_table.hpp"
#include "experiments/sweep/statistics.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/sweep/sweep_rows.hpp"

namespace beamid::experiments::sweep_table_test {
namespace {

using testing::ElementsAre;

// By hand: errors 1, -1, 2, 0; three of four within 1.5; Wilson's intervals of 3/4 and 1/5.
TEST(Statistics, AreThoseOfATableWorkedOutByHand) {
  const SweepPlan plan = plan_with({"beam.length_m=1,2"}, 1, 6);
  const auto all =
      statistics(plan, {found_row(0, 11), found_row(1, 9), found_row(2, 12), unfound_row(3, "diverged"),
                        unfound_row(4, "failed"), found_row(5, 10), unfound_row(6, "failed")});
  ASSERT_EQ(all.size(), 2u);
  const PointStatistics& one = all[0];
  EXPECT_EQ(one.converged, 4);
  EXPECT_EQ(one.diverged, 1);
  EXPECT_EQ(one.unusable, 1);
  EXPECT_DOUBLE_EQ(one.bias, 0.5);
  EXPECT_DOUBLE_EQ(one.rms, std::sqrt(1.5));
  EXPECT_DOUBLE_EQ(one.bias_percent, 5.0);
  EXPECT_DOUBLE_EQ(one.rms_percent, 10 * std::sqrt(1.5));
  EXPECT_DOUBLE_EQ(one.bias_percent_error, std::sqrt(125.0 / 3));
  EXPECT_DOUBLE_EQ(one.rms_over_bound, std::sqrt(1.5));
  EXPECT_EQ(one.coverage.value(), 0.75);
  EXPECT_NEAR(one.coverage.lower_95, 0.3006, 1e-4);
  EXPECT_NEAR(one.coverage.upper_95, 0.9544, 1e-4);
  EXPECT_NEAR(one.divergence.lower_95, 0.0362, 1e-4);
  EXPECT_NEAR(one.divergence.upper_95, 0.6245, 1e-4);
  EXPECT_EQ(all[1].point, 1u);
  EXPECT_EQ(all[1].parameter, "");
  EXPECT_EQ(all[1].unusable, 1);
}

TEST(SweepRow, IsReadBackAsItWasWritten) {
  SweepRow row = unfound_row(7, "diverged");
  row.estimate = 1.0 / 3.0;
  const std::string line = to_line(row);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const auto back = from_line(line.substr(0, line.size() - 1), 1);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->estimate, 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(back->bound));
  EXPECT_EQ(back->reason, "a \"reason\", on two lines");
  EXPECT_EQ(to_line(*back), line);
  EXPECT_FALSE(from_line(line.substr(0, line.size() / 2), 1));
}

// Oracle: HDF5 itself, which finds members by name and converts them.
TEST(Hdf5Table, HoldsRowsAsACompoundOfNamedColumns) {
  const TemporaryFile file("cases.h5", "");
  SweepRow second = found_row(1, 9);
  second.values = {"2.5"};
  write_hdf5(plan_with({"beam.length_m=1,2.5"}), {found_row(0, 11), second}, file.path());
  const hid_t in = H5Fopen(file.path().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t set = H5Dopen2(in, "cases", H5P_DEFAULT);
  const auto column = [&](const char* name) {
    const hid_t one = H5Tcreate(H5T_COMPOUND, sizeof(double));
    H5Tinsert(one, name, 0, H5T_NATIVE_DOUBLE);
    std::vector<double> values(2, -1.0);
    EXPECT_GE(H5Dread(set, one, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
    H5Tclose(one);
    return values;
  };
  EXPECT_THAT(column("case"), ElementsAre(0.0, 1.0));
  EXPECT_THAT(column("beam.length_m"), ElementsAre(1.0, 2.5));
  EXPECT_THAT(column("error"), ElementsAre(1.0, -1.0));
  const hid_t text = H5Tcopy(H5T_C_S1), one = H5Tcreate(H5T_COMPOUND, 16);
  H5Tset_size(text, 16);
  H5Tinsert(one, "parameter", 0, text);
  std::array<char, 32> names{};
  EXPECT_GE(H5Dread(set, one, H5S_ALL, H5S_ALL, H5P_DEFAULT, names.data()), 0);
  EXPECT_STREQ(names.data() + 16, "stiffness");
  H5Tclose(one);
  H5Tclose(text);
  H5Dclose(set);
  H5Fclose(in);
}

}  // namespace
}  // namespace beamid::experiments::sweep_table_test
