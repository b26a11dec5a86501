// Oracle: the same test read by perfect instruments.
#include "experiments/rig/logged_test.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "experiments/text/input_error.hpp"
#include "tests/fem/five_beams.hpp"

namespace beamid::experiments::logged_test_test {
namespace {

using Eigen::Index;
using testing::Contains, testing::HasSubstr, testing::ThrowsMessage;

Experiment rig() {
  Experiment experiment;
  experiment.structure = fem::Beam(test::steel_beam(0.360490));
  experiment.damping = fem::ModalDamping{{0.005}};
  experiment.excitation.deflection = 0.012;
  Sensor sensor;
  sensor.quantity = Quantity::displacement;
  sensor.noise = 1e-6;
  experiment.sensors = {sensor};
  experiment.simulation.duration = 5;
  experiment.simulation.sampling_rate = 250;
  experiment.simulation.method.options["modes"] = 2.0;
  return experiment;
}

SimulatedTest logged(const Experiment& experiment) {
  return logged_test(experiment, ".", "simulated", [](auto&&...) {});
}

const Record& perfect() {
  static const Record record = simulate(rig(), ".", 0, [](auto&&...) {}).record;
  return record;
}

TEST(LoggedTest, OfPerfectInstrumentsIsTheTestItself) {
  EXPECT_EQ(logged(rig()).record.samples, perfect().samples);
  EXPECT_TRUE(logged(rig()).record.objections.empty());
}

TEST(LoggedTest, MissesWhatIsClippedAndSaysSo) {
  Experiment experiment = rig();
  experiment.acquisition.sensors = {{}};
  experiment.acquisition.sensors[0].clipping = 0.6;
  const Record record = logged(experiment).record;
  const double limit = 0.6 * perfect().samples.cwiseAbs().maxCoeff();
  ASSERT_EQ(record.size(), perfect().size());
  for (Index k = 0; k < record.size(); ++k) {
    if (std::abs(perfect().samples(0, k)) > 1.001 * limit) {
      EXPECT_TRUE(std::isnan(record.samples(0, k))) << k;
    }
    if (std::abs(perfect().samples(0, k)) < 0.99 * limit) {
      EXPECT_EQ(record.samples(0, k), perfect().samples(0, k)) << k;
    }
  }
  EXPECT_THAT(texts(record.objections), Contains(HasSubstr("clipped at")));
}

TEST(LoggedTest, BeginsWithTheExcitation) {
  Experiment experiment = rig();
  experiment.simulation.method.options["modes"] = 2.0;
  for (Sensor& sensor : experiment.sensors) sensor.noise = 0.0;
  const Record exact = logged(experiment).record;
  experiment.acquisition.pretrigger = 0.5;
  const SimulatedTest test = logged(experiment);
  ASSERT_EQ(test.record.size(), exact.size());
  EXPECT_NEAR(test.record.time[0], 0.5, 1e-12);
  EXPECT_LT((test.record.samples - exact.samples).norm(), 1e-12 * exact.samples.norm());
  EXPECT_THAT(test.notes, Contains(HasSubstr("0.5 s recorded before the excitation are omitted")));
}

TEST(LoggedTest, KeepsUnevenStampsAndNoneBeforeTheExcitation) {
  Experiment experiment = rig();
  experiment.acquisition.pretrigger = 0.5;
  experiment.acquisition.jitter = 0.3;
  experiment.acquisition.gaps = 2;
  const Record record = logged(experiment).record;
  EXPECT_GE(record.time[0], 0.5 - 1e-9);
  EXPECT_LT(record.time[0], 0.5 + 3.0 / 250);
  EXPECT_THAT(texts(record.objections), Contains(HasSubstr("2 gaps between the stamps")));
}

TEST(LoggedTest, RefusesADeadChannel) {
  Experiment experiment = rig();
  experiment.acquisition.sensors = {{}};
  experiment.acquisition.sensors[0].dead = true;
  EXPECT_THAT([&] { logged(experiment); }, ThrowsMessage<InputError>(HasSubstr("is dead")));
}

}  // namespace
}  // namespace beamid::experiments::logged_test_test
