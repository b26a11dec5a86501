// Oracles: the values written in the files themselves, closed forms of section properties.
#include "experiments/config/readers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"

namespace beamid::experiments::read_space_frame_test {
namespace {

const std::string joints_and_members =
    "[space_frame]\n"
    "joints = [{ x_m = 0, y_m = 0, z_m = 0 }, { x_m = 0, y_m = 0, z_m = 3, name = \"knee\" }, { x_m = 2, y_m "
    "= 1, "
    "z_m = 3 }]\n"
    "[[space_frame.members]]\n"  // line 3
    "first = 1\n"
    "second = 2\n"
    "section = \"bar\"\n"
    "[[space_frame.members]]\n"  // line 7
    "first = 2\n"
    "second = 3\n"
    "section = \"pipe\"\n";
const std::string sections =
    "[[space_frame.sections]]\n"  // line 11
    "name = \"bar\"\n"
    "shape = \"rectangle\"\n"
    "width_m = 0.1\n"
    "height_m = 0.2\n"
    "youngs_modulus_pa = 2e11\n"
    "poissons_ratio = 0.25\n"
    "density_kg_per_m3 = 8000\n"
    "[[space_frame.sections]]\n"  // line 19
    "name = \"pipe\"\n"
    "shape = \"tube\"\n"
    "diameter_m = 0.1\n"
    "wall_m = 0.01\n"
    "youngs_modulus_pa = 2e11\n"
    "shear_modulus_pa = 8e10\n"
    "mass_per_length_kg_per_m = 22\n"
    "theory = \"timoshenko\"\n";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

fem::SpaceFrame frame_of(const std::string& text) {
  return read_space_frame(TomlTable::parse(text, "tower.toml").table("space_frame")).frame;
}

std::string error_of(const std::string& text) {
  try {
    frame_of(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ReadSpaceFrame, TakesSectionsByTheirShape) {
  const fem::SpaceFrame frame = frame_of(joints_and_members + sections);
  const fem::SpaceSection &bar = frame.members[0].section, &pipe = frame.members[1].section;
  EXPECT_NEAR(bar.axial_stiffness / 4e9, 1.0, 1e-14);
  EXPECT_NEAR(bar.bending_stiffness_y / (2e11 * 0.1 * 0.008 / 12), 1.0, 1e-14);  // of the height along z
  EXPECT_NEAR(bar.bending_stiffness_z / (2e11 * 0.2 * 0.001 / 12), 1.0, 1e-14);
  EXPECT_NEAR(bar.torsional_stiffness / (8e10 * 0.2287 * 0.2 * 0.001), 1.0, 1e-3);
  EXPECT_NEAR(bar.mass_per_length, 160.0, 1e-12);
  EXPECT_NEAR(bar.torsional_inertia / (8000 * (0.1 * 0.008 + 0.2 * 0.001) / 12), 1.0, 1e-14);
  EXPECT_EQ(bar.rotary_inertia_y, 0.0);
  EXPECT_FALSE(bar.shear_stiffness_y);
  const double second_moment = std::numbers::pi / 64 * (1e-4 - std::pow(0.08, 4));
  EXPECT_NEAR(pipe.torsional_stiffness / (8e10 * 2 * second_moment), 1.0, 1e-14);
  EXPECT_EQ(pipe.mass_per_length, 22.0);
  EXPECT_GT(pipe.rotary_inertia_y, 0.0);
  EXPECT_TRUE(pipe.shear_stiffness_y && pipe.shear_stiffness_z);
  EXPECT_NEAR(total_mass(fem::Structure(frame)), 3 * 160 + 22 * std::sqrt(5.0), 1e-12);
}

TEST(ReadSpaceFrame, TakesSectionsByConstants) {
  const std::string constants =
      "shape = \"constants\"\narea_m2 = 1e-3\nsecond_moment_y_m4 = 2e-6\nsecond_moment_z_m4 = 3e-7\n"
      "torsion_constant_m4 = 4e-8\n";
  const std::string text =
      joints_and_members +
      replaced(sections, "shape = \"rectangle\"\nwidth_m = 0.1\nheight_m = 0.2\n", constants);
  const fem::SpaceSection bar = frame_of(text).members[0].section;
  EXPECT_NEAR(bar.axial_stiffness / 2e8, 1.0, 1e-14);
  EXPECT_NEAR(bar.bending_stiffness_y / 4e5, 1.0, 1e-14);
  EXPECT_NEAR(bar.bending_stiffness_z / 6e4, 1.0, 1e-14);
  EXPECT_NEAR(bar.torsional_stiffness / (8e10 * 4e-8), 1.0, 1e-14);
  EXPECT_EQ(
      error_of(replaced(text, "poissons_ratio = 0.25\n", "poissons_ratio = 0.25\ntheory = \"timoshenko\"\n")),
      "tower.toml:11:1: space_frame.sections[1].shear_area_y_m2 is missing; expected a positive number "
      "beside "
      "shape = \"constants\" and theory = \"timoshenko\"");
}

TEST(ReadSpaceFrame, TakesWhatHoldsItAndWhatSitsOnIt) {
  const std::string first = replaced(joints_and_members, "section = \"pipe\"\n",
                                     "section = \"pipe\"\nroll_deg = 90\nreleased_at_second = [\"y\", "
                                     "\"z\"]\noffset_at_first_m = [0, 0.1, 0]\n"
                                     "group = \"arm\"\nstiffness_factor = 0.8\nsection_z = [1, 0, 1]\n");
  const fem::SpaceFrame frame = frame_of(
      replaced(first, "[space_frame]\n",
               "[space_frame]\nbase_direction = [0, 3, 4]\nmass_model = \"lumped\"\n") +
      sections +
      "[[space_frame.supports]]\njoint = 1\nkind = \"clamped\"\n[[space_frame.supports]]\njoint = 3\n"
      "holds = [\"z\", \"rx\"]\n[[space_frame.bodies]]\njoint = 2\nmass_kg = 7\ninertia_kg_m2 = [1, 2, 3]\n"
      "offset_m = [0, 0, 0.5]\n[[space_frame.springs]]\njoint = 2\ntranslational_n_per_m = [4, 5, 6]\n");
  EXPECT_EQ(frame.mass_model, fem::MassModel::lumped);
  EXPECT_EQ(frame.base_direction, Eigen::Vector3d(0, 3, 4));
  const fem::SpaceFrame::Member& arm = frame.members[1];
  EXPECT_NEAR(arm.roll, std::numbers::pi / 2, 1e-15);
  EXPECT_TRUE(arm.at_second.y && arm.at_second.z && !arm.at_second.x && !arm.at_first.y);
  EXPECT_EQ(arm.at_first.offset, Eigen::Vector3d(0, 0.1, 0));
  EXPECT_EQ(*arm.section_z, Eigen::Vector3d(1, 0, 1));
  EXPECT_EQ(arm.stiffness_factor, 0.8);
  EXPECT_EQ(arm.group, "arm");
  const auto &clamped = frame.supports[0], &held = frame.supports[1];
  EXPECT_TRUE(clamped.x && clamped.y && clamped.z && clamped.rx && clamped.ry && clamped.rz);
  EXPECT_TRUE(held.z && held.rx && !held.x && !held.y && !held.ry && !held.rz);
  EXPECT_EQ(held.joint, 2);
  EXPECT_EQ(frame.bodies[0].inertia, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(frame.bodies[0].offset, Eigen::Vector3d(0, 0, 0.5));
  EXPECT_EQ(frame.springs[0].translational, Eigen::Vector3d(4, 5, 6));
}

TEST(ReadSpaceFrame, TakesAxialLoadsAndDashpots) {
  const fem::SpaceFrame frame = frame_of(
      replaced(joints_and_members, "section = \"pipe\"\n", "section = \"pipe\"\naxial_load_n = -20\n") +
      sections +
      "[[space_frame.supports]]\njoint = 1\nkind = \"clamped\"\n[[space_frame.dashpots]]\njoint = 2\n"
      "translational_n_s_per_m = [4, 5, 6]\n[[space_frame.dashpots]]\njoint = 3\n"
      "rotational_n_m_s_per_rad = [1, 2, 3]\n");
  EXPECT_EQ(frame.members[0].axial_load, 0.0);
  EXPECT_EQ(frame.members[1].axial_load, -20.0);
  ASSERT_EQ(frame.dashpots.size(), 2u);
  EXPECT_EQ(frame.dashpots[0].joint, 1);
  EXPECT_EQ(frame.dashpots[0].translational, Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(frame.dashpots[1].rotational, Eigen::Vector3d(1, 2, 3));
}

TEST(ReadSpaceFrame, RefusesLoadsBeyondBuckling) {
  // Oracle: a cantilever of 5 m whose weaker E I is 2e11 0.2 0.1^3 / 12 N m2 buckles at pi^2 E I / (2 L)^2 =
  // 328,986.8 N.
  const std::string column =
      "[space_frame]\njoints = [{ x_m = 0, y_m = 0, z_m = 0 }, { x_m = 0, y_m = 0, z_m = 5 }]\n"
      "members = [{ first = 1, second = 2, section = \"bar\", axial_load_n = 4e5 }]\n"
      "supports = [{ joint = 1, kind = \"clamped\" }]\n" +
      sections;
  EXPECT_THAT(error_of(column), testing::StartsWith("tower.toml:1:"));
  EXPECT_THAT(error_of(column), testing::HasSubstr("the frame buckles at 0.822"));
  EXPECT_EQ(error_of(replaced(column, "4e5", "3.2e5")), "no error");
}

TEST(ReadSpaceFrame, RefusesWhatCannotBe) {
  const std::string good = joints_and_members + sections;
  EXPECT_EQ(error_of(good), "no error");
  const std::pair<std::string, std::string> cases[] = {
      {replaced(good, "second = 3", "second = 4"),
       "tower.toml:9:10: space_frame.members[2].second is 4; expected a whole number from 1 to 3"},
      {replaced(good, "second = 3", "second = 2"),
       "tower.toml:7:1: space_frame.members[2] goes from joint 2 to joint 2 and has no length; expected ends "
       "at "
       "different places"},
      {replaced(good, "section = \"pipe\"", "section = \"pope\""),
       "tower.toml:10:11: space_frame.members[2].section is the text \"pope\"; expected one of the sections "
       "bar, pipe"},
      {replaced(good, "section = \"bar\"\n", "section = \"bar\"\nsection_z = [0, 0, 1]\n"),
       "tower.toml:7:13: space_frame.members[1]: the direction of its section's z is along the member; "
       "expected one "
       "across it"},
      {replaced(good, "section = \"bar\"\n", "section = \"bar\"\nsection_z = [0, 1]\n"),
       "tower.toml:7:13: space_frame.members[1].section_z is an array of 2; expected three numbers, along x, "
       "y and "
       "z"},
      {replaced(good, "section = \"bar\"\n", "section = \"bar\"\nreleased_at_first = [\"w\"]\n"),
       "tower.toml:7:21: space_frame.members[1].released_at_first is an array of 1; expected texts from x, "
       "y, z"},
      {replaced(good, "wall_m = 0.01", "wall_m = 0.05"),
       "tower.toml:23:10: space_frame.sections[2].wall_m is 0.05; expected a number below 0.05, half the "
       "diameter"},
      {replaced(good, "shape = \"tube\"", "shape = \"circle\""),
       "tower.toml:23:1: space_frame.sections[2].wall_m has no use with shape = \"circle\"; of use there: "},
      {replaced(good, "name = \"pipe\"", "name = \"bar\""),
       "tower.toml:20:8: space_frame.sections[2].name is the text \"bar\"; expected a name that no other "
       "section has"},
      {good + "[[space_frame.supports]]\njoint = 1\n",
       "tower.toml:28:1: what the support holds is given by no key; expected exactly one of kind, holds"},
      {replaced(good, "second = 3", "second = 1"),
       "tower.toml:2:88: space_frame.joints[3] ends no member; expected one at least"},
      {replaced(good, "}]\n", "}, { x_m = 9, y_m = 0, z_m = 0 }, { x_m = 9, y_m = 2, z_m = 0 }]\n") +
           "[[space_frame.members]]\nfirst = 4\nsecond = 5\nsection = \"bar\"\n",
       "tower.toml:2:119: space_frame.joints[4] is not connected with the first; expected members between "
       "all parts "
       "of the frame"},
      {replaced(good, "[space_frame]\n", "[space_frame]\nbase_direction = [0, 0, 0]\n"),
       "tower.toml:2:18: space_frame.base_direction is an array of 3; expected three numbers, not all zero"}};
  for (const auto& [text, message] : cases) EXPECT_THAT(error_of(text), testing::StartsWith(message));
}

TEST(ReadExperiment, TakesASpaceFrame) {
  const Experiment experiment = read_experiment(TomlTable::parse(
      joints_and_members + sections + "[[sensors]]\nat = \"knee.z\"\nnoise_m_per_s2 = 0.01\n", "tower.toml"));
  ASSERT_NE(experiment.structure.space_frame(), nullptr);
  EXPECT_EQ(experiment.elements, 8);
  EXPECT_EQ(structure_text(experiment, 16, 102),
            "Space frame: 2 members between 3 joints, 529.193 kg; nowhere held. 8 elements per member, 102 "
            "degrees of "
            "freedom.");
  EXPECT_EQ(describe(experiment.structure, 8)["members"][0]["section_z"],
            (nlohmann::ordered_json::array({1.0, 0.0, 0.0})));
}

}  // namespace
}  // namespace beamid::experiments::read_space_frame_test
