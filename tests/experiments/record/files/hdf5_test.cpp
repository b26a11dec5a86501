// HDF5 files: what is read, what is refused.
// Oracles: the numbers written into the files, by hand from the formats' descriptions or by the libraries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstring>

#include "experiments/record/read_record.hpp"
#include "experiments/text/toml_table.hpp"
#include "tests/experiments/config/temporary_file.hpp"
#include "tests/experiments/record/files/damaged_file.hpp"
#include "tests/experiments/record/files/written_record.hpp"

namespace beamid::experiments::hdf5_test {
namespace {

using testing::HasSubstr;

void attribute(hid_t object, const char* name, const char* text) {
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, std::strlen(text));
  const hid_t id = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(id, type, text);
  H5Aclose(id), H5Sclose(space), H5Tclose(type);
}

void write_hdf5(const std::filesystem::path& path) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t group = H5Gcreate2(file, "run", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t length[2] = {written_samples, 2};
  const hid_t line = H5Screate_simple(1, length, nullptr), plane = H5Screate_simple(2, length, nullptr);
  const hid_t acceleration =
      H5Dcreate2(group, "tip", H5T_NATIVE_DOUBLE, line, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(acceleration, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values_of(first_signal).data());
  attribute(acceleration, "units", "g");
  const hid_t scalar = H5Screate(H5S_SCALAR);
  const hid_t rate =
      H5Acreate2(file, "sampling_rate_hz", H5T_NATIVE_DOUBLE, scalar, H5P_DEFAULT, H5P_DEFAULT);
  const double hertz = 100;
  H5Awrite(rate, H5T_NATIVE_DOUBLE, &hertz);
  std::vector<float> rows;
  for (int k = 0; k < written_samples; ++k)
    rows.insert(rows.end(), {static_cast<float>(k), static_cast<float>(second_signal(k))});
  const hid_t both =
      H5Dcreate2(group, "both", H5T_NATIVE_FLOAT, plane, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(both, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data());
  H5Aclose(rate), H5Sclose(scalar), H5Dclose(both), H5Dclose(acceleration), H5Sclose(line), H5Sclose(plane);
  H5Gclose(group), H5Fclose(file);
}

TEST(Hdf5Reader, ReadsDatasetsByPathWithTheirAttributes) {
  const TemporaryFile file("test.h5", "");
  write_hdf5(file.path());
  const Record stated = read_record(file.path());  // the unit of one dataset is known
  ASSERT_EQ(stated.channels.size(), 1u);
  EXPECT_EQ(stated.channels[0].name, "/run/tip");
  EXPECT_THAT(stated.remarks, testing::Contains(HasSubstr("'/run/both[:,0]' [], '/run/both[:,1]' []")));
  RecordFormat format;
  format.channels = {{Quantity::acceleration, "/run/tip", 0, 9.80665},
                     {Quantity::force, "/run/both[:,1]", 0, 1}};
  expect_both(read_record(file.path(), format), 1e-6);
}

// Oracle: nanoseconds since 1970 at 100 Hz, which were taken for seconds; the unit and the rate of a group.
TEST(Hdf5Reader, ReadsInstantsByTheirSizeAndAttributesOfGroups) {
  const TemporaryFile made("group.h5", "");
  const hid_t file = H5Fcreate(made.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t group = H5Gcreate2(file, "run", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  attribute(group, "Units", "g");
  const hsize_t length = written_samples;
  const hid_t line = H5Screate_simple(1, &length, nullptr);
  std::vector<long long> instants;
  for (long long k = 0; k < written_samples; ++k)
    instants.push_back(1'795'687'200'000'000'000 + 10'000'000 * k);
  const hid_t time = H5Dcreate2(group, "time", H5T_NATIVE_INT64, line, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
              acc = H5Dcreate2(group, "acc", H5T_NATIVE_DOUBLE, line, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(time, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, instants.data());
  H5Dwrite(acc, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values_of(first_signal).data());
  H5Dclose(time), H5Dclose(acc), H5Sclose(line), H5Gclose(group), H5Fclose(file);
  const Record record = read_record(made.path());
  EXPECT_NEAR(record.interval(), 0.01, 1e-6);
  EXPECT_NEAR(record.samples(0, 3), 9.80665 * first_signal(3), 1e-12);
}

TEST(Hdf5Reader, ReadsOrRefusesDamagedFiles) {
  const TemporaryFile whole("whole.h5", "");
  write_hdf5(whole.path());
  expect_read_or_refused("fuzz.h5", read_bytes(whole.path(), "a file"), {}, 7, 200);
}

}  // namespace
}  // namespace beamid::experiments::hdf5_test
