// Oracle: what was written is what is read.
#include "experiments/record/record.hpp"

#include <gtest/gtest.h>

#include <random>

#include "experiments/record/read_record.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::write_record_test {
namespace {

Record random_record(Eigen::Index size, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Record record;
  record.time = Eigen::VectorXd::LinSpaced(size, 2, 2 + 1e-3 * static_cast<double>(size - 1));
  record.samples = Eigen::MatrixXd::NullaryExpr(
      3, size, [&] { return std::exp(20 * normal(generator)) * normal(generator); });
  record.channels = {{Quantity::acceleration, "Tip acceleration"},
                     {Quantity::displacement, "displacement"},
                     {Quantity::acceleration, "tip"}};
  return record;
}

TEST(WriteRecord, ReadsBackToTheLastBit) {
  const Record written = random_record(500, 1);
  const TemporaryFile file("round_trip.csv", "");
  write_record(written, file.path());
  const Record read = read_record(file.path());
  EXPECT_EQ(read.time, written.time);
  EXPECT_EQ(read.samples, written.samples);
  ASSERT_EQ(read.channels.size(), 3u);
  EXPECT_EQ(read.channels[0].name, "tip");
  EXPECT_EQ(read.channels[1].quantity, Quantity::displacement);
  EXPECT_EQ(to_csv(read), to_csv(written));
}

TEST(WriteRecord, NamesUnitsAndTellsChannelsApart) {
  const std::string text = to_csv(random_record(2, 2));
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "time_s,acceleration_tip_m_per_s2,displacement_m,acceleration_tip_2_m_per_s2");
}

TEST(WriteRecord, WritesAsManyDigitsAsItIsAskedFor) {
  Record record;
  record.time = Eigen::Vector2d(0, 1.0 / 3);
  record.samples = Eigen::RowVector2d(-0.1, 12345.678);
  record.channels = {{Quantity::force, ""}};
  EXPECT_EQ(to_csv(record, 4), "time_s,force_n\n0,-0.1\n0.3333,1.235e+04\n");
  EXPECT_EQ(to_csv(record), "time_s,force_n\n0,-0.1\n0.3333333333333333,12345.678\n");
}

TEST(WriteRecord, RefusesWhatCannotBeReadBack) {
  Record record = random_record(4, 3);
  record.samples(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(to_csv(record), std::invalid_argument);
  record = random_record(4, 3);
  record.channels.pop_back();
  EXPECT_THROW(to_csv(record), std::invalid_argument);
}

TEST(WriteRecord, LeavesNothingBehindWhereItCannotWrite) {
  const TemporaryFile file("plain.csv", "0");
  EXPECT_THROW(write_record(random_record(4, 4), file.path() / "below.csv"), std::runtime_error);
  EXPECT_THROW(write_record(random_record(4, 4), file.path().parent_path()), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(file.path().parent_path().string() + ".part"));
}

}  // namespace
}  // namespace beamid::experiments::write_record_test
