// A simulated record that a logger has spoiled is analysed as a measured one is. Oracle: the beam simulated.
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"

namespace beamid::experiments::logged_record_test {
namespace {

using testing::Contains, testing::HasSubstr;

const Progress silent = [](const std::string&) {};

Experiment cantilever(const std::string& sensor, const std::string& acquisition) {
  Experiment e = read_experiment(TomlTable::parse(
      "[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = 2.12e11\nmass_kg = "
      "3.055\nelements = 20\ntip_mass_kg = 0.36\n[damping]\nratio = 0.004\n[simulation]\nduration_s = "
      "8\nsampling_rate_hz = 200\nmodes = 1\n[[sensors]]\nname = \"tip\"\nnoise_m_per_s2 = 0.02\n" +
          sensor + acquisition +
          "[model]\nname = \"beam\"\n[[parameters]]\nquantity = \"bending_stiffness\"\n[[parameters]]\n"
          "quantity = \"damping_ratio\"\nguess = 0.003\n",
      "test.toml"));
  e.reductions = {parse_reduction("modal_truncation", "test")};
  e.filters = {e.filter};
  e.discretisations = {e.discretisation};
  return e;
}

TEST(LoggedRecord, IsAnalysedAsAMeasuredOne) {
  const Experiment e =
      cantilever("clipping = 0.8\n", "[acquisition]\npretrigger_s = 0.3\njitter = 0.3\nrepeated = 0.02\n");
  const Comparison found = compare(e, simulated_record(e, {}, silent), {}, silent);
  const ComparedRecord& record = found.compared;
  EXPECT_FALSE(record.record.samples.allFinite());  // what was clipped is no reading
  EXPECT_THAT(texts(record.record.objections), Contains(HasSubstr("clipped at")));
  EXPECT_THAT(record.notes, Contains(HasSubstr("The stamps are uneven.")));
  const ComparedRun& run = found.runs[0];
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  for (const ComparedParameter& p : run.parameters)
    EXPECT_LT(std::abs(p.estimate.value - *p.truth), 4.0 * p.estimate.deviation) << p.estimate.name;
}

TEST(LoggedRecord, KeepsTheForceToItselfWhereItIsAsked) {
  Experiment e = cantilever("",
                            "[acquisition]\nforce = false\n[excitation]\nkind = \"impulse\"\nmomentum_n_s "
                            "= 0.1\nduration_s = 0.05\n");
  EXPECT_EQ(simulated_record(e, {}, silent).record.channels.size(), 1u);
  e.acquisition.force = true;
  EXPECT_EQ(simulated_record(e, {}, silent).record.channels.size(), 2u);
}

}  // namespace
}  // namespace beamid::experiments::logged_record_test
