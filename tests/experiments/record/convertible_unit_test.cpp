// Units beyond the own table, by UDUNITS-2. The oracles are the definitions: 1 in = 0.0254 m, 1 ft = 0.3048
// m, 1 lb = 0.45359237 kg (international yard and pound, 1959), 1 lbf = 4.4482216152605 N by standard
// gravity.
#include <dlfcn.h>
#include <gmock/gmock.h>

#include <optional>
#include <string>

#include "experiments/record/read_record.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/units.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::convertible_unit_test {
namespace {

constexpr Quantity acceleration = Quantity::acceleration, velocity = Quantity::velocity,
                   displacement = Quantity::displacement, force = Quantity::force, strain = Quantity::strain,
                   angular = Quantity::angular_acceleration;

class ConvertibleUnit : public testing::Test {
 protected:
  void SetUp() override {
    if (dlopen("libudunits2.so.0", RTLD_NOW | RTLD_LOCAL) == nullptr)
      GTEST_SKIP() << "no libudunits2.so.0: the own table of units is all there is";
  }
};

TEST_F(ConvertibleUnit, HasTheFactorOfItsDefinition) {
  const struct {
    const char* spelling;
    std::optional<Quantity> quantity;
    double factor;
  } cases[] = {{"in/s^2", acceleration, 0.0254},
               {"in/s2", acceleration, 0.0254},
               {"in/s**2", acceleration, 0.0254},
               {"in/sec/sec", acceleration, 0.0254},
               {"inch/second^2", acceleration, 0.0254},
               {"(in/sec^2)", acceleration, 0.0254},
               {"ft/s2", acceleration, 0.3048},
               {"cm s-2", acceleration, 0.01},
               {"cm/s\u00b2", acceleration, 0.01},
               {"cm/s\xb2", acceleration, 0.01},  // ISO 8859-1
               {"cm.s-2", acceleration, 0.01},
               {"Gal", Quantity::base_acceleration, 0.01},
               {"mGal", acceleration, 1e-5},
               {"N/kg", acceleration, 1.0},
               {"in/s", velocity, 0.0254},
               {"km/h", velocity, 1.0 / 3.6},
               {"cm/s", velocity, 0.01},
               {"mil", displacement, 2.54e-5},
               {"mils", displacement, 2.54e-5},
               {"in", displacement, 0.0254},
               {"inches", displacement, 0.0254},
               {"ft", displacement, 0.3048},
               {"cm", displacement, 0.01},
               {"nm", displacement, 1e-9},
               {"micron", displacement, 1e-6},
               {"lbf", force, 4.4482216152605},
               {"kip", force, 4448.2216152605},
               {"kgf", force, 9.80665},
               {"MN", force, 1e6},
               {"kg m/s2", force, 1.0},
               {"mm/m", strain, 1e-3},
               {"in/in", strain, 1.0},
               {"%", strain, 1e-2},
               {"degree/s2", angular, 3.14159265358979323846 / 180.0},
               {"hr", {}, 3600.0},
               {"days", {}, 86400.0}};
  for (const auto& [spelling, quantity, factor] : cases) {
    const auto found = convertible_unit(spelling, quantity);
    ASSERT_TRUE(found) << spelling;
    EXPECT_DOUBLE_EQ(*found, factor) << spelling;
  }
  EXPECT_EQ(*convertible_unit("in/s^2", acceleration), 0.0254);  // to the last bit
  EXPECT_EQ(*convertible_unit("lbf", force), 4.4482216152605);
}

TEST_F(ConvertibleUnit, IsOfTheQuantityAndNoWordOrNumber) {
  const struct {
    const char* spelling;
    std::optional<Quantity> quantity;
  } cases[] = {{"g", acceleration},
               {"mg", acceleration},
               {"V", acceleration},
               {"m/s", acceleration},
               {"in", acceleration},
               {"gravity", acceleration},
               {"force", acceleration},
               {"dynamic", acceleration},
               {"m/s2/V", acceleration},
               {"counts", strain},
               {"mV/V", strain},
               {"deg", strain},
               {"1", strain},
               {"dB", strain},
               {"kg", force},
               {"t", force},
               {"lb", force},
               {"N1", force},
               {"N m", force},
               {"P", force},
               {"bar", force},
               {"a", displacement},
               {"rod", displacement},
               {"pole", displacement},
               {"foot", displacement},
               {"pt", displacement},
               {"3 m", displacement},
               {"2m", displacement},
               {"m1", displacement},
               {"10 mm", displacement},
               {"kin", displacement},
               {"pin", displacement},
               {"Mm", displacement},
               {"au", displacement},
               {"left", displacement},
               {"x", displacement},
               {"m @ 5", displacement},
               {"m-1", displacement},
               {"km", velocity},
               {"1/s2", angular},
               {"Hz2", angular},
               {"Hz", {}},
               {"rpm", {}},
               {"fs", {}},
               {"sample", {}},
               {"Ms", {}},
               {"jiffy", {}},
               {"seconds since 1970-01-01", {}},
               {"degC", displacement},
               {"", displacement},
               {"(", displacement},
               {"ln(re 1 m)", displacement},
               {"\xff\xfe", displacement}};
  for (const auto& [spelling, quantity] : cases)
    EXPECT_FALSE(convertible_unit(spelling, quantity)) << "'" << spelling << "'";
}

TEST_F(ConvertibleUnit, StandsWhereAUnitStands) {
  const struct {
    const char *name, *unit;
    double factor;
    bool stated;
  } cases[] = {{"Accel (in/s^2)", "", 0.0254, true},
               {"Acceleration", "ft/s2", 0.3048, true},
               {"Force [lbf]", "", 4.4482216152605, true},
               {"Force/lbf", "", 4.4482216152605, true},
               {"Velocity in/s", "", 0.0254, true},
               {"velocity_km/h", "", 1.0 / 3.6, true},
               {"Displacement, mm/s", "", 1.0, false},
               {"disp_in", "", 1.0, false},
               {"disp in", "", 1.0, false},
               {"acc rod", "", 1.0, false},
               {"Accel [V]", "", 1.0, false},
               {"Disp (rod)", "", 1.0, false},
               {"Acc (mg)", "", 9.80665e-3, true},
               {"Acc [g]", "", 9.80665, true}};
  for (const auto& [name, unit, factor, stated] : cases) {
    const auto found = recognise_column(name, unit);
    ASSERT_TRUE(found) << name;
    EXPECT_DOUBLE_EQ(found->factor, factor) << name;
    EXPECT_EQ(found->states_unit, stated) << name;
  }
  const auto hours = recognise_column("Time [hr]", "");
  ASSERT_TRUE(hours && hours->kind == RecognisedColumn::Kind::time);
  EXPECT_EQ(hours->factor, 3600.0);
}

TEST_F(ConvertibleUnit, OfAUnitRowIsReadInSiUnits) {
  std::string text = "Time\tForce\tAcceleration\ns\tkip\tin/s^2\n";
  for (int k = 0; k < 32; ++k)
    text +=
        std::to_string(0.25 * k) + "\t" + std::to_string(1 + k % 7) + "\t" + std::to_string(1 + k % 5) + "\n";
  const TemporaryFile file("a.txt", text);
  const Record record = read_record(file.path(), {});
  ASSERT_EQ(record.samples.rows(), 2);
  EXPECT_EQ(record.channels[0].quantity, force);
  EXPECT_EQ(record.samples(0, 6), 7.0 * 4448.2216152605);
  EXPECT_EQ(record.samples(1, 4), 5.0 * 0.0254);
}

TEST_F(ConvertibleUnit, AgreesWithTheOwnTable) {
  for (const Quantity quantity : all_quantities)
    for (const Unit& unit : units(quantity)) {
      EXPECT_DOUBLE_EQ(convertible_unit(unit.symbol, quantity).value_or(unit.factor), unit.factor)
          << unit.symbol;
    }
}

}  // namespace
}  // namespace beamid::experiments::convertible_unit_test
