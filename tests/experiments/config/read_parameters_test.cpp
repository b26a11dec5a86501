#include "experiments/config/readers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/config/read_experiment.hpp"

namespace beamid::experiments::read_parameters_test {
namespace {

using testing::HasSubstr;

Experiment read(const std::string& rest) {
  return read_experiment(
      TomlTable::parse("[beam]\nlength_m = 1.1\nmass_kg = 3.055\nyoungs_modulus_pa = 2.12e11\n"
                       "width_m = 0.06\nheight_m = 0.006\n" +
                           rest,
                       "beam.toml"));
}

std::string refusal(const std::string& rest) {
  try {
    read(rest);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(ReadParameters, TakesEveryKey) {
  const auto found = read(R"([[parameters]]
quantity = "bending_stiffness"
name = "crack"
from_m = 0.2
to_m = 0.3
guess_n_m2 = 200.0
deviation_n_m2 = 20
form = "logarithmic"
[[parameters]]
quantity = "damping_ratio"
mode = 2
guess = 0.01
lower = 0
upper = 0.2
[[parameters]]
quantity = "tip_mass"
known = true
relative_deviation = 0.02
)")
                         .parameters;
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].quantity, "bending_stiffness");
  EXPECT_EQ(found[0].name, "crack");
  EXPECT_EQ(found[0].region, std::pair(0.2, 0.3));
  EXPECT_EQ(found[0].guess, 200.0);
  EXPECT_EQ(found[0].deviation, 20.0);
  EXPECT_EQ(found[0].form, Form::logarithmic);
  EXPECT_FALSE(found[0].known);
  EXPECT_EQ(found[1].mode, 2);
  EXPECT_EQ(found[1].guess, 0.01);
  EXPECT_EQ(found[1].lower, 0.0);
  EXPECT_EQ(found[1].upper, 0.2);
  EXPECT_TRUE(found[2].known);
  EXPECT_EQ(found[2].relative_deviation, 0.02);
  EXPECT_EQ(found[2].place.line, 21u);
  EXPECT_TRUE(read("").parameters.empty());
}

TEST(ReadParameters, RefusesWhatMakesNoSense) {
  const std::string begin = "[[parameters]]\nquantity = \"bending_stiffness\"\n";
  EXPECT_THAT(refusal("[[parameters]]\nname = \"a\"\n"),
              testing::AllOf(HasSubstr("beam.toml:7:1"), HasSubstr("quantity is missing")));
  EXPECT_THAT(refusal("[[parameters]]\nquantity = \"ei\"\n"),
              testing::AllOf(HasSubstr("beam.toml:8:12"), HasSubstr("bending_stiffness, tip_mass")));
  EXPECT_THAT(refusal(begin + "guess_kg = 1.0\n"),
              testing::AllOf(HasSubstr("beam.toml:9:"), HasSubstr("guess_n_m2")));
  EXPECT_THAT(refusal(begin + "from_m = 0.2\n"), HasSubstr("to_m is missing"));
  EXPECT_THAT(refusal(begin + "from_m = 0.2\nto_m = 0.1\n"), HasSubstr("above from_m"));
  EXPECT_THAT(refusal(begin + "to_m = 1.2\nfrom_m = 0\n"), HasSubstr("beam's length, 1.1"));
  EXPECT_THAT(refusal(begin + "deviation_n_m2 = 0\n"), HasSubstr("a positive number"));
  EXPECT_THAT(refusal(begin + "deviation_n_m2 = 1\nrelative_deviation = 0.1\n"), HasSubstr("one of them"));
  EXPECT_THAT(refusal(begin + "form = \"cubic\"\n"),
              HasSubstr("expected one of linear, logarithmic, bounded"));
  EXPECT_THAT(refusal(begin + "name = \"My EI\"\n"), HasSubstr("small letters"));
  EXPECT_THAT(refusal(begin + "known = 1\n"), HasSubstr("true or false"));
  EXPECT_THAT(refusal(begin + "mode = 0\n"), HasSubstr("whole number from 1"));
  EXPECT_THAT(refusal(begin + "guess = 1\n"), HasSubstr("guess_n_m2"));
}

TEST(ReadStrainGauges, SitOnTheSurfaceUnlessToldOtherwise) {
  const auto sensors = read(
                           "[[sensors]]\nquantity = \"strain\"\nposition_m = 0\nnoise_m_per_m = 1e-7\n"
                           "[[sensors]]\nquantity = \"strain\"\nposition_m = 0.4\ndistance_m = -0.002\n"
                           "[[sensors]]\nposition_m = 0.4\n")
                           .sensors;
  EXPECT_DOUBLE_EQ(sensors[0].distance, 0.003);
  EXPECT_EQ(sensors[0].noise, 1e-7);
  EXPECT_EQ(sensors[1].distance, -0.002);
  EXPECT_EQ(sensors[2].distance, 0.0);
  const auto channels = read(
                            "[record]\nchannels = [{ quantity = \"strain\", column = 2, unit = \"um/m\", "
                            "position_m = 0.1 }, { quantity = \"force\", column = 3, unit = \"N\", "
                            "position_m = 0.5 }]\n")
                            .format.channels;
  EXPECT_DOUBLE_EQ(channels[0].distance, 0.003);
  EXPECT_EQ(channels[0].position, 0.1);
  EXPECT_EQ(channels[0].factor, 1e-6);
  EXPECT_EQ(channels[1].position, 0.5);
  EXPECT_EQ(channels[1].distance, 0.0);
}

TEST(ReadStrainGauges, NeedAPlaceAndADistance) {
  const std::string gauge = "[[sensors]]\nquantity = \"strain\"\n";
  EXPECT_THAT(refusal(gauge), HasSubstr("position_m is missing"));
  EXPECT_THAT(refusal(gauge + "position_m = 0\ndistance_m = 0\n"), HasSubstr("not zero"));
  EXPECT_THAT(refusal(gauge + "position_m = 2\n"), HasSubstr("beam's length"));
  EXPECT_THAT(refusal("[[sensors]]\ndistance_m = 0.1\n"), HasSubstr("distance_m"));
  const TomlTable plain = TomlTable::parse(
      "[beam]\nlength_m = 1\nmass_kg = 1\nbending_stiffness_n_m2 = 1\n" + gauge + "position_m = 0\n",
      "beam.toml");
  EXPECT_THROW(read_experiment(plain), InputError);
}

}  // namespace
}  // namespace beamid::experiments::read_parameters_test
