// Oracle: the beam assembled by hand, with the same points.
#include "experiments/identify/engine/model_setting.hpp"

#include <gtest/gtest.h>

#include "experiments/config/read_experiment.hpp"
#include "fem/assembly.hpp"
#include "fem/parametric_system.hpp"

namespace beamid::experiments::model_setting_test {
namespace {

using Eigen::MatrixXd;

Experiment experiment(const std::string& more = "") {
  return read_experiment(
      TomlTable::parse("[beam]\nlength_m = 1.1\nwidth_m = 0.06\nheight_m = 0.006\nyoungs_modulus_pa = "
                       "2.12e11\nmass_kg = 3.055\n"
                       "elements = 10\n" +
                           more,
                       "test.toml"));
}

Record record(const std::vector<Channel>& channels) {
  Record made;
  made.time = Eigen::VectorXd::LinSpaced(20, 0.0, 0.019);
  made.samples = MatrixXd::Random(static_cast<Eigen::Index>(channels.size()), 20);
  made.channels = channels;
  return made;
}

const Choice none{"none", {}};

TEST(ModelSetting, HasAnOutputWhereEachChannelSits) {
  const Experiment e = experiment();
  const ModelSetting setting = model_setting(
      e,
      record({{Quantity::acceleration, "a", 0.55}, {Quantity::force, "f", 0.33}, {Quantity::velocity, "v"}}),
      none);
  const fem::StructuralSystem by_hand =
      fem::assemble(e.structure, e.elements, {{"a", 0.55}, {"v", 1.1}, {"f", 0.33}});
  EXPECT_EQ((MatrixXd(setting.system.outputs) - MatrixXd(by_hand.outputs).topRows(2)).norm(), 0.0);
  ASSERT_EQ(setting.forces.size(), 1u);
  EXPECT_EQ((MatrixXd(setting.system.inputs).col(setting.forces[0]) - MatrixXd(by_hand.inputs).col(2)).norm(),
            0.0);
}

TEST(ModelSetting, ReadsStrainAlsoAtAClampedRootAndBesideRegions) {
  const Experiment e =
      experiment("[[parameters]]\nquantity = \"bending_stiffness\"\nfrom_m = 0\nto_m = 0.47\n");
  Channel gauge{Quantity::strain, "gauge", 0.0};
  gauge.distance = 0.003;
  const ModelSetting setting = model_setting(e, record({gauge, {Quantity::acceleration, "tip"}}), none);
  const fem::StructuralSystem by_hand =
      fem::assemble(fem::with_nodes(e.structure.beam(), {0.0, 0.47}), e.elements, {{"tip", 1.1}});
  const MatrixXd curvature = MatrixXd(fem::gauge_row(by_hand, e.structure.beam(), 0.0));
  EXPECT_LT((MatrixXd(setting.system.outputs).row(0) + 0.003 * curvature).norm(), 1e-14 * curvature.norm());
  const auto model = model_registry().make("beam", {}, setting);
  EXPECT_EQ(model->unknowns.size(), 1u);
}

TEST(Measurements, PartForcesFromMotion) {
  const Record made =
      record({{Quantity::acceleration, "a"}, {Quantity::force, "f"}, {Quantity::strain, "s"}});
  const filters::Measurements parted = measurements(made);
  EXPECT_EQ((parted.inputs.row(0) - made.samples.row(1)).norm(), 0.0);  // below it, how it runs on
  EXPECT_EQ((parted.outputs.row(1) - made.samples.row(2)).norm(), 0.0);
}

}  // namespace
}  // namespace beamid::experiments::model_setting_test
