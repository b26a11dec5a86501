// Two channels of one free decay by clocks of their own. Oracle: the same motion, simulated at two sampling
// rates, of which each channel takes one, so that nothing is interpolated.
#include "experiments/modal/joint_decay_fit.hpp"

#include <gmock/gmock.h>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "tests/experiments/results/temporary_folder.hpp"

namespace beamid::experiments::clock_scatter_test {
namespace {

using testing::Contains, testing::HasSubstr, testing::Not;

constexpr const char* cantilever = R"toml(
[beam]
length_m = 1.1
width_m = 0.06
height_m = 0.006
youngs_modulus_pa = 2.12e11
mass_kg = 3.055
tip_mass_kg = 0.36
[damping]
ratio = 0.004
[simulation]
duration_s = 8
sampling_rate_hz = 250
[[sensors]]
quantity = "acceleration"
noise_m_per_s2 = 0.03
[[sensors]]
quantity = "acceleration"
position_m = 0.55
noise_m_per_s2 = 0.03
)toml";

/// The channel at midspan stamps seconds that are longer by this share.
ComparedRun identified(const std::string& model, double drift, std::uint64_t seed) {
  const TemporaryFolder place;
  Experiment e = read_experiment(TomlTable::parse(
      cantilever +
          (model == "sdof" ? "" : std::string("[reduction]\nmethod = \"modal_truncation\"\nmodes = 2\n")) +
          "[model]\nname = \"" + model + "\"\n",
      "cantilever.toml"));
  e.simulation.method.options["modes"] = model == "sdof" ? 1 : 2;  // no more than the model has
  e.simulation.seed = seed;
  Record record = simulate(e, place.path, 0, unwatched).record;
  e.simulation.sampling_rate /= 1.0 + drift;
  const Record other = simulate(e, place.path, 0, unwatched).record;
  const Eigen::Index count = std::min(record.size(), other.size());
  record = record.window(record.time[0], record.time[count - 1]);
  record.samples.row(1) = other.samples.row(1).head(count);
  return identify_with_model(e, measured_record("two", record), place.path, unwatched).runs.at(0);
}

class ClockScatter : public testing::TestWithParam<const char*> {};

TEST_P(ClockScatter, ContradictsEveryModel) {
  const ComparedRun run = identified(GetParam(), 3e-4, 1);
  EXPECT_EQ(run.status, ComparedRun::Status::contradicted);
  const auto said = HasSubstr("ppm faster than");
  EXPECT_THAT(texts(run.oscillator ? run.oscillator->judgement.objections : run.objections), Contains(said));
  ASSERT_TRUE(run.clock_scatter);
  EXPECT_NEAR(run.clock_scatter->apart, 3e-4, 4.0 * run.clock_scatter->deviation);
}

TEST_P(ClockScatter, IsNoneOfOneClock) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const ComparedRun run = identified(GetParam(), 0.0, seed);
    EXPECT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
    EXPECT_FALSE(run.clock_scatter) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, ClockScatter, testing::Values("beam", "modal", "sdof"));

}  // namespace
}  // namespace beamid::experiments::clock_scatter_test
