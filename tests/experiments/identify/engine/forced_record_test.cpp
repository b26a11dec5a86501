// A record that a measured force drives throughout is no free decay, and no fit of one may end its
// identification. Oracle: the oscillator that the force was put on, exactly; what the force does between
// samples is worth some per cent of K and M here.
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/identify/engine/comparison.hpp"
#include "fem/beam.hpp"
#include "fem/exact/exact_cantilever.hpp"
#include "tests/experiments/forced_oscillator.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::experiments::forced_record_test {
namespace {

struct Case {
  const char* model;
  double rate;  // [Hz]
  bool noise, prior;
};

void PrintTo(const Case& tested, std::ostream* stream) {
  *stream << tested.model << " at " << tested.rate << " Hz";
}

class DrivenThroughout : public testing::TestWithParam<Case> {};

TEST_P(DrivenThroughout, IsIdentified) {
  const Case& tested = GetParam();
  const fem::Cantilever beam = test::steel_beam(0.360490);
  const double omega = fem::ExactMode(beam, 1).angular_frequency();
  const Oscillator truth = Oscillator::from_frequency(33.0 / 140.0 * beam.mass() + 0.360490, omega, 0.02);
  Experiment experiment;
  fem::Cantilever described = beam;
  described.bending_stiffness *= 1.05;
  experiment.structure = fem::Beam(described);
  experiment.model.name = tested.model;
  if (tested.noise) experiment.noise[Quantity::acceleration] = 0.05;
  if (tested.prior) experiment.prior = {1.05 * truth.stiffness, 0.1 * truth.stiffness, 0.01, 0.01};
  experiment.reductions = {experiment.reduction};
  experiment.filters = {experiment.filter};
  experiment.discretisations = {experiment.discretisation};
  ComparedRecord compared;
  compared.name = "driven";
  compared.record = test::driven_throughout(truth, 39, tested.rate, 0.02, 5);
  const Comparison found = compare(experiment, compared, {}, [](const std::string&) {});
  const ComparedRun& run = found.runs.at(0);
  ASSERT_EQ(run.status, ComparedRun::Status::converged) << run.reason;
  EXPECT_NEAR(*run.frequency_hz / truth.frequency_hz(), 1.0, 0.02);
  EXPECT_LT(run.response_error_percent, 50.0);
}

INSTANTIATE_TEST_SUITE_P(Models, DrivenThroughout,
                         testing::Values(Case{"sdof", 50, false, false}, Case{"sdof", 50, true, true},
                                         Case{"sdof", 400, false, false}, Case{"beam", 50, false, false},
                                         Case{"beam", 50, true, true}, Case{"beam", 100, true, false}));

}  // namespace
}  // namespace beamid::experiments::forced_record_test
