// Oracles: a motion of the base moves all the mass of a free beam, and the order of the elements.
#include "experiments/studies/continuum/modal_summary.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fem/beam.hpp"

namespace beamid::experiments::modal_summary_test {
namespace {

const Progress silent = [](const std::string&) {};

Experiment experiment_of(const fem::Beam& beam, int elements) {
  Experiment experiment;
  experiment.structure = beam;
  experiment.elements = elements;
  return experiment;
}

TEST(ModalSummary, HasAllTheMassInAllTheModes) {
  fem::Beam beam = fem::Cantilever{1.0, 100.0, 2.0, 0.5, 0.01, 0.02};
  beam.supports.clear();
  const ModalSummary summary = summarise_modes(experiment_of(beam, 8), 1000, silent);
  EXPECT_EQ(summary.modes.size(), 18);  // cut to what the mesh has
  EXPECT_NEAR(summary.total_mass, 2.5, 1e-14);
  EXPECT_NEAR(summary.effective_mass.sum(), 2.5, 1e-10);
}

TEST(ModalSummary, SharesOutTheStaticDeflection) {
  const ModalSummary summary =
      summarise_modes(experiment_of(fem::Cantilever{1.0, 100.0, 2.0}, 8), 16, silent);
  EXPECT_NEAR(summary.release_amplitude.sum(), 1.0, 1e-12);
  EXPECT_NEAR(summary.static_stiffness, 300.0, 1e-10);
}

TEST(ModalSummary, EstimatesTheErrorOfLumpedMassToo) {
  fem::Beam beam = fem::Cantilever{1.0, 100.0, 2.0};
  beam.mass_model = fem::MassModel::lumped;
  const ModalSummary summary = summarise_modes(experiment_of(beam, 40), 3, silent);
  for (Eigen::Index i = 0; i < 3; ++i)
    EXPECT_NEAR(summary.discretisation_error[i] / std::abs(summary.exact_error()[i]), 1.0, 0.1);
}

TEST(ModalSummary, LeavesOutWhatIsNotKnown) {
  fem::Beam beam = fem::Cantilever{1.0, 100.0, 2.0};
  beam.segments[0].section.bending_stiffness = fem::Variation::linear(100, 50);
  const ModalSummary summary = summarise_modes(experiment_of(beam, 1), 1, silent);
  EXPECT_TRUE(std::isnan(summary.exact_frequency_hz[0]));  // no closed form
  EXPECT_GT(summary.discretisation_error[0], 0.0);         // a finer mesh there always is
}

}  // namespace
}  // namespace beamid::experiments::modal_summary_test
