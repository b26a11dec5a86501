// Sensors at several places, bodies beside each other. Oracles: the beam simulated; a chi-square
// distribution; the other engine.
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments::sensors_test {
namespace {

const Progress silent = [](const std::string&) {};

Experiment cantilever(const std::string& beam, const std::string& more) {
  Experiment e = read_experiment(
      TomlTable::parse("[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = "
                       "2.12e11\nmass_kg = 3.055\nelements = 20\n" +
                           beam + "[damping]\nratio = 0.005\n" + more,
                       "test.toml"));
  e.reductions = {parse_reduction("modal_truncation", "test")};
  e.reduction = e.reductions[0];
  e.filters = {e.filter};
  e.discretisations = {e.discretisation};
  return e;
}

// Only the first mode is in the record: what is left is noise alone.
const std::string two_places =
    "[simulation]\nduration_s = 6\nsampling_rate_hz = 200\nmodes = 1\nseed = 3\n"
    "[[sensors]]\nname = \"tip\"\nposition_m = 1.1\nnoise_m_per_s2 = 0.05\n"
    "[[sensors]]\nname = \"mid\"\nposition_m = 0.55\nnoise_m_per_s2 = 0.05\n";

TEST(Sdof, ReadsEverySensorWhereItSits) {
  const Experiment e =
      cantilever("tip_mass_kg = 0.36\n", two_places + "[noise]\nacceleration_m_per_s2 = 0.05\n");
  const ComparedRecord record = simulated_record(e, {}, silent);
  const Comparison found = compare(e, record, {}, silent);
  const ComparedRun& run = found.runs[0];
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  // 2400 readings: a mean of chi-squares within 1 +- 4 sqrt(2 / 2400).
  EXPECT_NEAR(run.run.normalised_squares.mean() / 2.0, 1.0, 0.12);
  for (const ComparedParameter& p : run.parameters)
    EXPECT_LT(std::abs(p.estimate.value - *p.truth), 4.0 * p.estimate.deviation) << p.estimate.name;

  const RecordIdentification other = identify_record(e, record.record);
  ASSERT_TRUE(other.consistency);
  EXPECT_NEAR(other.consistency->mean_normalised_square, 1.0, 0.06);
  EXPECT_NEAR(other.identification.found.stiffness / run.parameters[0].estimate.value, 1.0, 1e-2);
}

TEST(Sdof, IsAboutTheFirstChannelWhereverThatSits) {
  // Oracle: modal mass and frequency of the beam at that place.
  Experiment e = cantilever("tip_mass_kg = 0.36\n", two_places);
  std::swap(e.sensors[0], e.sensors[1]);
  const Comparison found = compare(e, simulated_record(e, {}, silent), {}, silent);
  ASSERT_EQ(found.runs[0].status, ComparedRun::Status::converged) << found.runs[0].reason;
  const fem::StructuralSystem system = fem::assemble(e.structure, e.elements, {{"mid", 0.55}});
  const fem::Modes modes = fem::modes(system, 1);
  const double there = (system.outputs * modes.shape.col(0))[0];
  EXPECT_NEAR(found.runs[0].parameters[0].estimate.value * std::pow(there / modes.angular_frequency[0], 2),
              1.0, 1e-3);
}

TEST(TipMass, IsTheTipsOwnBesideASensor) {
  const std::string ask =
      "[model]\nname = \"beam\"\n"
      "[[parameters]]\nquantity = \"tip_mass\"\nguess_kg = 0.28\n[[parameters]]\nquantity = "
      "\"damping_ratio\"\n";
  const Experiment e = cantilever("tip_mass_kg = 0.300\nsensor_mass_kg = 0.100\n", two_places + ask);
  const Comparison found = compare(e, simulated_record(e, {}, silent), {}, silent);
  const ComparedParameter& mass = found.runs[0].parameters[0];
  EXPECT_EQ(*mass.truth, 0.300);
  EXPECT_LT(std::abs(mass.estimate.value - 0.300), 4.0 * mass.estimate.deviation);
  EXPECT_LT(mass.estimate.deviation, 0.001);
}

TEST(BodyMass, OfAnyBodyCanBeAskedAbout) {
  const std::string ask =
      "[model]\nname = \"beam\"\n[[parameters]]\nquantity = \"body_mass\"\nfrom_m = 0.5\nto_m = 0.7\n"
      "guess_kg = 0.7\n[[parameters]]\nquantity = \"damping_ratio\"\n";
  const Experiment e = cantilever("tip_mass_kg = 0.36\n",
                                  two_places + ask + "[[beam.bodies]]\nposition_m = 0.6\nmass_kg = 0.8\n");
  const Comparison found = compare(e, simulated_record(e, {}, silent), {}, silent);
  const ComparedParameter& mass = found.runs[0].parameters[0];
  EXPECT_EQ(*mass.truth, 0.8);
  EXPECT_LT(std::abs(mass.estimate.value - 0.8), 4.0 * mass.estimate.deviation);
  EXPECT_LT(mass.estimate.deviation, 0.01);
}

TEST(BodyMass, IsRefusedWhereNoBodySits) {
  const Experiment e = cantilever("tip_mass_kg = 0.36\n",
                                  two_places +
                                      "[model]\nname = \"beam\"\n[[parameters]]\nquantity = \"body_mass\"\n"
                                      "from_m = 0.5\nto_m = 0.7\n");
  EXPECT_THAT([&] { compare(e, simulated_record(e, {}, silent), {}, silent); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("no body with mass")));
}

}  // namespace
}  // namespace beamid::experiments::sensors_test
