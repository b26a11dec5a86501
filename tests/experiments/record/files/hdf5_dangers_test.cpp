// HDF5 files that lie: about units, sizes, where their numbers are; and damaged ones, on which HDF5 1.10 of
// Debian 12 itself crashes or runs for ever. Oracles: the numbers written, and that this process goes on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "experiments/record/read_apart.hpp"
#include "experiments/record/read_record.hpp"
#include "experiments/text/toml_table.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::hdf5_dangers_test {
namespace {

using testing::HasSubstr, testing::MatchesRegex, testing::StartsWith;

void attribute(hid_t object, const char* name, const char* text) {
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, H5T_VARIABLE);  // as h5py writes them
  const hid_t id = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(id, type, &text);
  H5Aclose(id), H5Sclose(space), H5Tclose(type);
}

void attribute(hid_t object, const char* name, double value) {
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t id = H5Acreate2(object, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(id, H5T_NATIVE_DOUBLE, &value);
  H5Aclose(id), H5Sclose(space);
}

/// An HDF5 file under construction.
class Hdf5File {
 public:
  explicit Hdf5File(const std::string& name)
      : file_(name, ""), id_(H5Fcreate(file_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)) {}
  ~Hdf5File() { close(); }

  void close() {
    if (id_ >= 0) H5Fclose(id_);
    id_ = -1;
  }

  /// @param created its property list, which is closed.
  hid_t dataset(const char* name, hsize_t count, const std::vector<double>& values,
                hid_t created = H5P_DEFAULT) {
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t id = H5Dcreate2(id_, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, created, H5P_DEFAULT);
    if (!values.empty()) H5Dwrite(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Sclose(space);
    if (created != H5P_DEFAULT) H5Pclose(created);
    return id;
  }

  hid_t id() const { return id_; }
  const TemporaryFile& file() const { return file_; }

 private:
  TemporaryFile file_;
  hid_t id_;
};

/// Acceleration [g] over `time`, 400 samples at this interval in the unit; the attribute dt where it is above
/// 0.
std::unique_ptr<Hdf5File> record_file(double interval, const char* unit, double stated_interval = 0.0) {
  auto made = std::make_unique<Hdf5File>("a.h5");
  std::vector<double> time(400), values(400);
  for (std::size_t k = 0; k < time.size(); ++k)
    time[k] = interval * static_cast<double>(k), values[k] = std::cos(static_cast<double>(k));
  const hid_t times = made->dataset("time", 400, time), acceleration = made->dataset("acc", 400, values);
  if (*unit) attribute(times, "units", unit);
  attribute(acceleration, "units", "g");
  if (stated_interval > 0) attribute(acceleration, "dt", stated_interval);
  H5Dclose(times), H5Dclose(acceleration);
  made->close();
  return made;
}

std::string error_of(const Hdf5File& made, const RecordFormat& format = {}) {
  return input_error_of(made.file(), [&] { read_record(made.file().path(), format); });
}

// Oracle: the same instants in another unit. Frequencies were wrong by 1000 before.
TEST(Hdf5Times, AreInTheUnitThatTheyState) {
  for (const auto& [interval, unit] : {std::pair{0.004, "s"}, std::pair{4.0, "ms"}, std::pair{4000.0, "us"},
                                       std::pair{0.004 / 60.0, "min"}}) {
    const auto made = record_file(interval, unit);
    EXPECT_NEAR(read_record(made->file().path()).interval(), 0.004, 1e-12) << unit;
  }
  const auto bare = record_file(0.004, "");
  EXPECT_THAT(read_record(bare->file().path()).remarks,
              testing::Contains("'/time' states no unit: its times are taken as seconds."));
  const auto degrees = record_file(0.004, "deg");
  EXPECT_EQ(
      error_of(*degrees),
      "a.h5: '/time' is in 'deg'; expected times in s, ms, us, or record.time or record.sampling_rate_hz in "
      "the configuration");
  RecordFormat stated;
  stated.time = ColumnDescription{Quantity::acceleration, "/time", 0, 60.0};
  EXPECT_NEAR(read_record(degrees->file().path(), stated).interval(), 0.24, 1e-12);
}

TEST(Hdf5Times, MayNotContradictAStatedInterval) {
  EXPECT_EQ(error_of(*record_file(0.004, "s", 0.001)),
            "a.h5: /acc/dt means an interval of 0.001 s, and '/time' has one of 0.004 s; expected them to "
            "agree, or "
            "record.time or record.sampling_rate_hz in the configuration");
  EXPECT_EQ(error_of(*record_file(4.0, "ms", 0.004)), "no error");
}

/// The file with bytes behind the first "GCOL", its heap of texts, replaced.
std::string damaged(const Hdf5File& made, std::initializer_list<std::pair<std::size_t, char>> changes) {
  std::string bytes = read_bytes(made.file().path(), "a file");
  const std::size_t heap = bytes.find("GCOL");
  EXPECT_NE(heap, std::string::npos);
  for (const auto& [offset, byte] : changes) bytes[heap + offset] = byte;
  return bytes;
}

TEST(Hdf5Damage, ThatCrashesTheLibraryIsOneMessage) {
  const auto made = record_file(0.004, "s");
  const TemporaryFile file("segv.h5", damaged(*made, {{31, 3}}));
  const std::string crashes = "segv.h5: HDF5 crashes on it .*; expected an undamaged file";
  EXPECT_THAT(input_error_of(file, [&] { read_record(file.path()); }),  // 1.14 reads past what is damaged
              MatchesRegex(H5_VERSION_GE(1, 12, 0) ? "no error|" + crashes : crashes));
}

TEST(Hdf5Damage, ThatNeverEndsIsOneMessage) {
  const auto made = record_file(0.004, "");
  const TemporaryFile file("hang.h5", damaged(*made, {{31, 0}, {49, 0}}));
  EXPECT_EQ(input_error_of(file, [&] { read_record(file.path()); }),
            "hang.h5: HDF5 has not come to an end with it in 2 s; expected an undamaged file");
}

TEST(ReadApart, BringsBackWhatWasCollectedAndEndsWhatDoesHarm) {
  const ReadingLimits limits{1000, 1.0, std::size_t{64} << 20};
  const CollectedSignals found = read_apart("a.x", "libx", limits, [](CollectedSignals& signals) {
    signals.add("tip", "g", {1.0, -2.5, 3e-300}, 7);
    signals.add("root", "", {4.0, 5.0}, 15);
    signals.set("fs", 250.0);
  });
  ASSERT_EQ(found.signals().size(), 2u);
  EXPECT_EQ(found.signals()[0].name, "tip");
  EXPECT_EQ(found.signals()[0].unit, "g");
  EXPECT_EQ(found.signals()[0].values, (std::vector<double>{1.0, -2.5, 3e-300}));
  EXPECT_EQ(found.signals()[0].digits, 7);
  ASSERT_EQ(found.statements().size(), 1u);
  EXPECT_EQ(found.statements()[0].interval, 0.004);
  EXPECT_EQ(found.statements()[0].name, "fs");

  const auto error = [&](const std::function<void(CollectedSignals&)>& read) {
    try {
      read_apart("a.x", "libx", limits, read);
    } catch (const InputError& refused) {
      return std::string(refused.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(error([](CollectedSignals&) { throw InputError({"a.x"}, "no numbers"); }), "a.x: no numbers");
  EXPECT_THAT(error([](CollectedSignals&) { std::abort(); }), StartsWith("a.x: libx crashes on it"));
  EXPECT_EQ(error([](CollectedSignals&) {
              volatile bool going_on = true;
              while (going_on) {
              }
            }),
            "a.x: libx has not come to an end with it in 1 s; expected an undamaged file");
  EXPECT_THAT(  // sanitizers end a process that runs out of memory
      error([](CollectedSignals&) { std::vector<double>(std::size_t{1} << 30, 1.0).front() = 0.0; }),
      testing::AnyOf(StartsWith("a.x: libx needs more than 64 MB of memory for it; expected"),
                     StartsWith("a.x: libx crashes on it")));
  EXPECT_THAT(error([](CollectedSignals& signals) {
                signals.announce("a", {600});
                signals.announce("b", {20, 30});
              }),
              HasSubstr("'b' claims 20 x 30 numbers, 1.2e+03 with those before it; expected at most 1e+03"));
}

// 30 datasets of 2e7 numbers that were never written took 7.8 GB: each alone was within its limit.
TEST(Hdf5Sizes, AreLimitedInAll) {
  Hdf5File made("never_written.h5");
  for (int k = 0; k < 30; ++k) H5Dclose(made.dataset(std::to_string(k).c_str(), 1000000, {}));
  made.close();
  EXPECT_THAT(error_of(made), HasSubstr("' claims 1000000 numbers, "));
}

TEST(Hdf5Groups, NestedWithoutEndAreRefused) {
  Hdf5File made("deep.h5");
  std::vector<hid_t> groups{made.id()};
  for (int k = 0; k < 300; ++k)
    groups.push_back(H5Gcreate2(groups.back(), "g", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  for (std::size_t k = groups.size(); k-- > 1;) H5Gclose(groups[k]);
  made.close();
  EXPECT_EQ(error_of(made), "deep.h5: groups within groups, more than 64; expected fewer");
}

// A record that somebody sends put the bytes of any readable file into the results.
TEST(Hdf5Storage, InOtherFilesIsRefused) {
  const TemporaryFile secret("secret.bin", std::string(4000, 'x'));
  Hdf5File external("external.h5");
  const hid_t outside = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(outside, secret.path().c_str(), 0, 400 * sizeof(double));
  H5Dclose(external.dataset("acc", 400, {}, outside));
  external.close();
  EXPECT_EQ(error_of(external),
            "external.h5: '/acc' takes its numbers from another file; expected them in this one");

  const auto source = record_file(0.004, "s");
  Hdf5File virtual_file("virtual.h5");
  const hsize_t count = 400;
  const hid_t space = H5Screate_simple(1, &count, nullptr), mapped = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_virtual(mapped, space, source->file().path().c_str(), "acc", space);
  H5Dclose(virtual_file.dataset("acc", 400, {}, mapped));
  H5Sclose(space);
  virtual_file.close();
  EXPECT_EQ(error_of(virtual_file),
            "virtual.h5: '/acc' takes its numbers from another file; expected them in this one");
}

// Oracle: the format's own words. MATLAB's files of level 7.3 are HDF5, with 512 bytes before it.
TEST(MatlabStorage, InOtherFilesIsRefused) {
  const TemporaryFile secret("secret.bin", std::string(4000, 'x'));
  const TemporaryFile made("external.mat", "");
  const hid_t created = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_userblock(created, 512);
  const hid_t file = H5Fcreate(made.path().c_str(), H5F_ACC_TRUNC, created, H5P_DEFAULT);
  const hsize_t count = 400;
  const hid_t space = H5Screate_simple(1, &count, nullptr), outside = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(outside, secret.path().c_str(), 0, 400 * sizeof(double));
  H5Dclose(H5Dcreate2(file, "acc", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, outside, H5P_DEFAULT));
  H5Pclose(outside), H5Sclose(space), H5Pclose(created), H5Fclose(file);
  std::fstream stream(made.path(), std::ios::binary | std::ios::in | std::ios::out);
  std::string head = "MATLAB 7.3 MAT-file, by hand";
  head.resize(124, ' ');
  stream << head << '\0' << '\2' << "IM";
  stream.close();
  EXPECT_EQ(input_error_of(made, [&] { read_record(made.path()); }),
            "external.mat: 'acc' takes its numbers from another file; expected them in this one");
}

}  // namespace
}  // namespace beamid::experiments::hdf5_dangers_test
