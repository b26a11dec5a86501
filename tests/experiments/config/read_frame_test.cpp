// Oracles: the values written in the files themselves, closed forms of section properties.
#include "experiments/config/readers.hpp"

#include <gmock/gmock.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_experiment.hpp"
#include "experiments/config/structure_description.hpp"

#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::read_frame_test {
namespace {

const std::string joints =
    "[frame]\n"
    "joints = [{ x_m = 0, y_m = 0 }, { x_m = 3, y_m = 4, name = \"ridge\" }, { x_m = 6, y_m = 0 }]\n";
const std::string members =
    "[[frame.members]]\n"  // line 3
    "first = 1\n"
    "second = 2\n"
    "width_m = 0.1\n"
    "height_m = 0.2\n"
    "youngs_modulus_pa = 2e11\n"
    "density_kg_per_m3 = 8000\n"
    "[[frame.members]]\n"  // line 10
    "first = 3\n"
    "second = 2\n"
    "bending_stiffness_n_m2 = 100\n"
    "axial_stiffness_n = 1e6\n"
    "mass_kg = 10\n"
    "hinged_at_second = true\n";

FrameExperiment frame_of(const std::string& text) {
  const TomlTable root = TomlTable::parse(text, "frame.toml");
  refuse_unknown_keys(root);
  check_values(root);
  return read_frame(root.table("frame"));
}

std::string error_of(const std::string& text) {
  try {
    frame_of(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ReadFrame, TakesAxialLoadsAndDashpots) {
  const FrameExperiment read = frame_of(joints + members +
                                        "axial_load_n = -20\n"
                                        "[[frame.supports]]\njoint = 1\nkind = \"clamped\"\n"
                                        "[[frame.dashpots]]\njoint = 2\ntranslational_x_n_s_per_m = 15\n");
  EXPECT_EQ(read.frame.members[1].axial_load, -20.0);
  ASSERT_EQ(read.frame.dashpots.size(), 1u);
  EXPECT_EQ(read.frame.dashpots[0].joint, 1);
  EXPECT_EQ(read.frame.dashpots[0].x, 15.0);
}

TEST(ReadFrame, RefusesLoadsBeyondBuckling) {
  // Oracle: a cantilever of 5 m and 100 N m2 buckles at pi^2 E I / (2 L)^2 = 9.8696 N.
  const std::string column =
      "[frame]\njoints = [{ x_m = 0, y_m = 0 }, { x_m = 0, y_m = 5 }]\n"
      "[[frame.members]]\nfirst = 1\nsecond = 2\nbending_stiffness_n_m2 = 100\naxial_stiffness_n = 1e6\n"
      "mass_kg = 10\naxial_load_n = 20\n"
      "[[frame.supports]]\njoint = 1\nkind = \"clamped\"\n";
  EXPECT_THAT(error_of(column), testing::HasSubstr("buckles at 0.4934"));
  EXPECT_THAT(error_of(column), testing::StartsWith("frame.toml:1:"));
}

TEST(ReadFrame, TakesMembersByDimensionsAndByStiffness) {
  const FrameExperiment read = frame_of(joints + members);
  EXPECT_EQ(read.elements_per_member, 20);
  const fem::Frame& frame = read.frame;
  EXPECT_EQ(frame.joints[1].name, "ridge");
  ASSERT_EQ(frame.members.size(), 2u);
  EXPECT_EQ(frame.members[0].first, 0);
  EXPECT_EQ(frame.members[1].first, 2);
  EXPECT_EQ(frame.length(1), 5.0);
  EXPECT_NEAR((*frame.members[0].section.axial_stiffness)(0) / 4e9, 1.0, 1e-15);
  EXPECT_NEAR(frame.members[0].section.bending_stiffness(0) / (2e11 * 0.1 * 0.008 / 12), 1.0, 1e-15);
  EXPECT_EQ((*frame.members[1].section.axial_stiffness)(0), 1e6);
  EXPECT_EQ(frame.members[1].section.mass_per_length(0), 2.0);  // 10 kg over the 5 m between its joints
  EXPECT_FALSE(frame.members[0].hinged_at_second);
  EXPECT_TRUE(frame.members[1].hinged_at_second);
  EXPECT_NEAR(total_mass(frame), 5 * 160 + 10, 1e-12);
}

TEST(ReadFrame, TakesWhatHoldsItAndWhatSitsOnIt) {
  const fem::Frame frame =
      frame_of("[frame]\nmass_model = \"lumped\"\n" + joints.substr(8) + members +
               "[[frame.supports]]\njoint = 1\nkind = \"clamped\"\n[[frame.supports]]\njoint = 3\n"
               "kind = \"rolling_x\"\n[[frame.bodies]]\njoint = 2\nmass_kg = 7\nrotary_inertia_kg_m2 = 0.5\n"
               "[[frame.springs]]\njoint = 2\ntranslational_x_n_per_m = 1\ntranslational_y_n_per_m = 2\n"
               "rotational_n_m_per_rad = 3\n")
          .frame;
  EXPECT_EQ(frame.mass_model, fem::MassModel::lumped);
  ASSERT_EQ(frame.supports.size(), 2u);
  EXPECT_TRUE(frame.supports[0].x && frame.supports[0].y && frame.supports[0].rotation);
  EXPECT_EQ(frame.supports[1].joint, 2);
  EXPECT_TRUE(frame.supports[1].y && !frame.supports[1].x && !frame.supports[1].rotation);
  EXPECT_EQ(frame.bodies.at(0).joint, 1);
  EXPECT_EQ(frame.bodies.at(0).mass, 7.0);
  EXPECT_EQ(frame.bodies.at(0).rotary_inertia, 0.5);
  EXPECT_EQ(frame.springs.at(0).x, 1.0);
  EXPECT_EQ(frame.springs.at(0).y, 2.0);
  EXPECT_EQ(frame.springs.at(0).rotational, 3.0);
}

TEST(ReadFrame, RefusesWhatCannotBe) {
  const auto replaced = [](std::string text, const std::string& what, const std::string& by) {
    return text.replace(text.find(what), what.size(), by);
  };
  const std::string good = joints + members;
  const std::pair<std::string, std::string> cases[] = {
      {"title = \"nothing\"\n", "frame.toml: frame is missing; expected a table"},
      {"[frame]\n", "frame.toml:1:1: frame.joints is missing; expected an array of at least one table"},
      {joints, "frame.toml:1:1: frame.members is missing; expected an array of at least one table"},
      {replaced(good, "second = 2", "second = 4"),
       "frame.toml:5:10: frame.members[1].second is 4; expected a whole number from 1 to 3"},
      {replaced(good, "second = 2", "second = 1"),
       "frame.toml:3:1: frame.members[1] goes from joint 1 to joint 1 and has no length; expected joints at "
       "different places"},
      {replaced(good, "second = 2\n", ""),
       "frame.toml:3:1: frame.members[1].second is missing; expected the number of a joint, from 1 to 3"},
      {replaced(good, "axial_stiffness_n = 1e6\n", ""),
       "frame.toml:10:1: frame.members[2].axial_stiffness_n is missing; expected a positive number beside "
       "bending_stiffness_n_m2"},
      {replaced(good, "first = 3", "first = 1"),
       "frame.toml:2:71: frame.joints[3] ends no member; expected one at least"},
      {good + "[[frame.supports]]\njoint = 1\n",
       "frame.toml:17:1: frame.supports[1].kind is missing; expected one of clamped, pinned, rolling_x, "
       "rolling_y, sliding_x, sliding_y, guided"},
      {good + "[[frame.bodies]]\njoint = 1\n",
       "frame.toml:17:1: frame.bodies[1] has no effect; expected at least one of mass_kg, "
       "rotary_inertia_kg_m2"},
      {replaced(good, "[frame]", "[frame]\nelements_per_member = 500001"),
       "frame.toml:2:23: frame.elements_per_member is 500001; expected a whole number from 1 to 500000"},
      {replaced(joints, "}]\n", "}, { x_m = 9, y_m = 0 }, { x_m = 9, y_m = 2 }]\n") + members +
           "[[frame.members]]\nfirst = 4\nsecond = 5\nbending_stiffness_n_m2 = 2\n"
           "axial_stiffness_n = 1e6\nmass_per_length_kg_per_m = 1\n",
       "frame.toml:2:93: frame.joints[4] is not connected with the first; expected members between all parts "
       "of the frame"}};
  for (const auto& [text, message] : cases) EXPECT_EQ(error_of(text), message);
}

TEST(ReadFrame, RefusesMisspeltKeysAndALength) {
  EXPECT_EQ(error_of(joints + "[[frame.members]]\nfrist = 1\n")
                .find("frame.toml:4:1: unknown key 'frist' in "
                      "frame.members; did you mean 'first'?"),
            0u);
  EXPECT_EQ(error_of(joints + "[[frame.members]]\nlength_m = 1\n").find("frame.toml:4:1: unknown key "), 0u);
}

TEST(ReadExperiment, TakesAFrame) {
  const TemporaryFile file("frame.toml", joints + members);
  EXPECT_NE(read_experiment(file.path()).structure.frame(), nullptr);
}

TEST(ReadExperiment, TakesOneStructure) {
  const TemporaryFile file("frame.toml",
                           joints + members + "[chain]\nmasses_kg = [1]\nstiffnesses_n_per_m = [2]\n");
  EXPECT_THAT(input_error_of(file, [&] { read_experiment(file.path()); }),
              testing::HasSubstr("frame beside chain; expected one structure"));
}

}  // namespace
}  // namespace beamid::experiments::read_frame_test
