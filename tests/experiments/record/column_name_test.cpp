// Oracle: the grammar quantity[_label]_unit, by hand.
#include "experiments/record/units.hpp"

#include <gtest/gtest.h>

#include "experiments/text/spelling.hpp"

namespace beamid::experiments::column_name_test {
namespace {

TEST(ColumnName, TellsQuantityLabelAndUnit) {
  const struct {
    const char* name;
    Quantity quantity;
    const char* label;
    double factor;
  } known[] = {{"displacement_m", Quantity::displacement, "", 1},
               {"displacement_mm", Quantity::displacement, "", 1e-3},
               {"displacement_root_um", Quantity::displacement, "root", 1e-6},
               {"velocity_m_per_s", Quantity::velocity, "", 1},
               {"velocity_mm_per_s", Quantity::velocity, "", 1e-3},
               {"acceleration_tip_2_m_per_s2", Quantity::acceleration, "tip_2", 1},
               {"acceleration_g", Quantity::acceleration, "", 9.80665},
               {"acceleration_g_g", Quantity::acceleration, "g", 9.80665},
               {"force_kn", Quantity::force, "", 1e3},
               {"strain_root_um_per_m", Quantity::strain, "root", 1e-6},
               {"strain_m_per_m", Quantity::strain, "", 1}};
  for (const auto& expected : known) {
    const auto meaning = parse_column_name(expected.name);
    ASSERT_TRUE(meaning) << expected.name;
    EXPECT_EQ(meaning->quantity, expected.quantity) << expected.name;
    EXPECT_EQ(meaning->label, expected.label);
    EXPECT_EQ(meaning->factor, expected.factor);
  }
  const auto time = parse_column_name("time_ms");
  ASSERT_TRUE(time);
  EXPECT_FALSE(time->quantity);
  EXPECT_EQ(time->factor, 1e-3);
}

TEST(ColumnName, TakesNothingElse) {
  for (const char* name :
       {"", "time", "time_x_s", "acceleration", "acceleration_", "acceleration_mm", "acceleration__g",
        "accelerationx_g", "Acceleration_g", "force_g", "temperature_c", "_g", "velocity_m_per_s2"})
    EXPECT_FALSE(parse_column_name(name)) << name;
}

TEST(ColumnName, IsReadBackForEveryUnit) {
  for (const Quantity quantity : all_quantities)
    for (const Unit& unit : units(quantity)) {
      const auto meaning = parse_column_name(std::string(to_string(quantity)) + "_x_" + unit.suffix);
      ASSERT_TRUE(meaning);
      EXPECT_EQ(meaning->quantity, quantity);
      EXPECT_EQ(meaning->factor, unit.factor);
    }
}

TEST(Nearest, IsTheWordThatWasMeant) {
  const std::vector<std::string> words{"length_m", "mass_kg", "tip_mass_kg", "width_m", "ekf", "ukf"};
  EXPECT_EQ(nearest("lenght_m", words), "length_m");
  EXPECT_EQ(nearest("length", words), "length_m");
  EXPECT_EQ(nearest("mass_kg_", words), "mass_kg");
  EXPECT_EQ(nearest("ufk", words), "ukf");
  EXPECT_EQ(nearest("temperature", words), std::nullopt);
  EXPECT_EQ(nearest("", words), std::nullopt);
  EXPECT_EQ(nearest(std::string(100000, 'm'), words), std::nullopt);
}

}  // namespace
}  // namespace beamid::experiments::column_name_test
