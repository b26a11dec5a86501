// Sizes that a file or an option asks for are held against memory before anything is taken. Oracles: the
// kernel's limits, here set by `ulimit -v`, and the exit code: a process that took the memory would end by
// std::bad_alloc with 1, or by the kernel's killer.
#include <gmock/gmock.h>

#include "experiments/text/memory_need.hpp"
#include "tests/reliability/shell.hpp"

namespace beamid::reliability::memory_limits_test {
namespace {

using apps::Outcome, apps::Workplace, testing::HasSubstr, testing::MatchesRegex;
using apps::source;

TEST(MemoryNeed, IsSaidInUnitsThatPeopleRead) {
  using experiments::bytes_text;
  EXPECT_EQ(bytes_text(12), "12 B");
  EXPECT_EQ(bytes_text(2e3), "2 kB");
  EXPECT_EQ(bytes_text(6.4e10), "64 GB");
  EXPECT_EQ(bytes_text(4e15), "4 PB");
}

TEST(MemoryNeed, IsRefusedWithWhatWouldFit) {
  EXPECT_NO_THROW(experiments::require_memory(1, "element", 1));
  try {
    experiments::require_memory(5e12, "elements", 800);
    FAIL() << "no machine has 4 PB";
  } catch (const std::invalid_argument& refused) {
    EXPECT_THAT(
        refused.what(),
        MatchesRegex("5e\\+12 elements need 4 PB of memory; at most .* fit here, where .*B are free"));
  }
}

struct Asked {
  const char* name;
  const char* words;  ///< of the command
  const char* what;   ///< the message
};

class MemoryLimit : public testing::TestWithParam<Asked> {
 protected:
  MemoryLimit() {
    const auto tutorial = [](const char* file) {
      return apps::contents(source(std::string("docs/tutorials/") + file));
    };
    place_.write("cantilever.toml", tutorial("02_identify_a_record/cantilever.toml"));
    place_.write("tip_acceleration.csv", tutorial("02_identify_a_record/tip_acceleration.csv"));
    place_.write("rig.toml", tutorial("13_sweeps/rig.toml"));
    std::string particles = tutorial("02_identify_a_record/cantilever.toml");
    place_.write("particles.toml",
                 particles.replace(particles.find("\"ekf\""), 5, "\"particle\"\nparticles = 1000000"));
    std::string mesh = tutorial("13_sweeps/rig.toml");
    place_.write("mesh.toml", mesh.replace(mesh.find("elements = 20"), 13, "elements = 900000"));
    for (const char* huge : {"huge.csv", "huge.toml", "huge.json"}) {
      place_.write(huge, "a");
      apps::fs::resize_file(place_.folder() / huge, std::uintmax_t{1} << 40);  // holes: no disk is taken
    }
    place_.write("begun.uff", "    -1\n    58\n");
    apps::fs::resize_file(place_.folder() / "begun.uff", std::uintmax_t{1} << 40);
  }

  void SetUp() override {
    if (sanitized) GTEST_SKIP() << "under sanitizers";
  }

  Workplace place_;
};

/// The least of these limits under which the command starts. 160 MB are enough for each of these commands
/// with its defaults; OpenBLAS, where it is the system's BLAS, takes 128 MB of addresses while it is loaded,
/// and tries without end where it does not get them.
std::string limited(const Workplace& place) {
  static const std::string least = [&place] {
    const std::string start = "export OPENBLAS_NUM_THREADS=1; ulimit -v ";
    for (const char* kilobytes : {"160000;", "350000;"})
      if (place.run("--version", start + kilobytes + " timeout 10").code == 0) return start + kilobytes;
    throw std::runtime_error("the command does not start within 350 MB");
  }();
  return least;
}

TEST_P(MemoryLimit, IsOneMessage) {
  const Outcome outcome = place_.run(GetParam().words, limited(place_));
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().what));
  EXPECT_THAT(outcome.err, HasSubstr("of memory; at most"));
}

INSTANTIATE_TEST_SUITE_P(
    Of, MemoryLimit,
    testing::Values(
        Asked{"Elements", "modes --config cantilever.toml --elements 1000000", "1e+06 elements need 2 GB"},
        Asked{"ElementsOfAFile", "simulate --config mesh.toml",
              "mesh.toml:10:12: 900000 elements need 1.8 GB"},
        Asked{"Modes", "modes --elements 30000 --modes 1000", "30000 elements with 1000 modes need 1.98 GB"},
        Asked{"Samples", "simulate --config rig.toml --duration 1e5 --sampling-rate 100",
              "1e+07 samples of a simulated record need 1.7 GB"},
        Asked{"Cases", "sweep --config rig.toml --seeds 10000000", "5e+07 cases of a sweep need "},
        Asked{"Particles", "identify --config particles.toml", "1e+06 particles of 5 states need 160 MB"},
        Asked{"RecordFile", "inspect huge.csv", "huge.csv: 1.09951e+12 bytes of a file need 8.8 TB"},
        Asked{"ExperimentFile", "validate huge.toml", "huge.toml: 1.09951e+12 bytes of a file need"},
        Asked{"UniversalFile", "inspect begun.uff", "begun.uff: 1.09951e+12 bytes of a file need"},
        Asked{"StateFile", "stream --config cantilever.toml --resume huge.json",
              "huge.json: 1.09951e+12 bytes"},
        Asked{"SweptRecord", "sweep huge.csv --config cantilever.toml --seeds 2",
              "huge.csv: 1.09951e+12 bytes"}),
    [](const auto& asked) { return std::string(asked.param.name); });

// It was opened twice, and waited for a second writer; what a first look had taken was lost.
TEST(Pipe, IsRefusedAsARecord) {
  const Workplace place;
  const Outcome outcome = place.run("inspect pipe", "mkfifo pipe; timeout 20");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "pipe: a pipe; expected a record of numbers in columns in a file\n");
}

}  // namespace
}  // namespace beamid::reliability::memory_limits_test
