// Keys that vary and the cases they make. Oracle: counting by hand, the laws' moments.
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/sweep/sweep_plan.hpp"
#include "tests/experiments/sweep/sweep_rows.hpp"

namespace beamid::experiments::sweep_plan_test {
namespace {

using filters::OptionValue;
using testing::ElementsAre, testing::HasSubstr, testing::ThrowsMessage;

std::vector<double> numbers(const VariedKey& key) {
  std::vector<double> found;
  for (const OptionValue& value : key.values) found.push_back(std::get<double>(value));
  return found;
}

TEST(VariedKey, IsARangeAListOrALaw) {
  EXPECT_THAT(numbers(parse_varied("beam.length_m=1:2:3")), ElementsAre(1.0, 1.5, 2.0));
  const std::vector<double> decades = numbers(parse_varied("damping.ratio=0.001:0.1:3:log"));
  EXPECT_EQ(decades[0], 0.001);
  EXPECT_NEAR(decades[1], 0.01, 1e-15);
  EXPECT_EQ(decades[2], 0.1);
  EXPECT_EQ(std::get<std::string>(parse_varied("filter.method=ekf,ukf").values[1]), "ukf");
  EXPECT_EQ(std::get<bool>(parse_varied("filter.inflate=true").values[0]), true);
  EXPECT_EQ(parse_varied("sensors[1].noise_m=normal:1:0.5").law, VariedKey::Law::normal);
}

TEST(VariedKey, RefusesWhatIsNoneOfThem) {
  const auto refuses = [](const char* text, const char* message) {
    EXPECT_THAT([&] { parse_varied(text); }, ThrowsMessage<std::invalid_argument>(HasSubstr(message)))
        << text;
  };
  refuses("ratio=1", "expected TABLE.KEY=");
  refuses("damping.ratio", "expected TABLE.KEY=");
  refuses("damping.ratio=0:1:3:log", "expected positive FROM and TO");
  refuses("damping.ratio=1:2:2.5", "expected a whole number of steps");
  refuses("damping.ratio=1:2:three", "expected a number in the place of 'three'");
  refuses("damping.ratio=uniform:2:1", "expected FROM below TO");
  refuses("damping.ratio=0.1,,0.2", "expected a value between commas");
  EXPECT_THAT([] { check_key(parse_varied("beam.lenght_m=1,2")); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("did you mean 'length_m'?")));
  const auto refuses_key = [](const char* text, const char* message) {
    EXPECT_THAT([&] { check_key(parse_varied(text)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(message)))
        << text;
  };
  refuses_key("beam.tip_mass_kg=-1,2", "sets beam.tip_mass_kg to -1; expected zero or a positive number");
  refuses_key("beam.elements=10,20.5",
              "sets beam.elements to 20.5; expected a whole number from 1 to 1000000");
  refuses_key("beam.mass_kg=light", "sets beam.mass_kg to light; expected a positive number");
  refuses_key("beam.theory=shear", "expected one of euler_bernoulli, timoshenko");
  refuses_key("filter.method=uniform:1:2", "draws numbers; expected a text in quotes between commas");
  refuses_key("record.window_s=1,2", "holds more than one value; expected a key of one");
  refuses_key("beam.springs=1", "holds more than one value");
  refuses_key("frame.bodies[1].mass_kg=1,2", "is in no table of an experiment file");
  refuses_key("sensors[1.noise_m=1", "has a bracket that is not closed");
  EXPECT_THAT(
      [] {
        plan_with({"beam.length_m=1,2", "beam.length_m=3"});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("varied twice")));
}

TEST(SweepPlan, NumbersSeedsFastestAndTheFirstKeySlowest) {
  const SweepPlan plan = plan_with({"beam.length_m=1,2", "filter.method=ekf,ukf,iekf"}, 1, 4);
  EXPECT_EQ(plan.cases(), 24u);
  EXPECT_EQ(plan.point_of(3), 0u);
  EXPECT_EQ(plan.point_of(4), 1u);
  const std::vector<OptionValue> values = values_of(plan, 17);  // point 4: second length, second filter
  EXPECT_EQ(std::get<double>(values[0]), 2.0);
  EXPECT_EQ(std::get<std::string>(values[1]), "ukf");
}

// Moments of the laws, within five standard errors of 20,000 numbers.
TEST(SweepPlan, DrawsByTheLawAndTheSampleAlone) {
  const SweepPlan plan = plan_with({"a.b=uniform:2:4", "a.c=normal:10:2", "a.d=log_uniform:1:100"}, 20000, 2);
  double uniform = 0.0, normal = 0.0, square = 0.0, logarithm = 0.0;
  for (std::size_t i = 0; i < plan.cases(); i += 2) {
    const auto values = values_of(plan, i);
    EXPECT_EQ(values, values_of(plan, i + 1));  // another seed of the same sample
    uniform += std::get<double>(values[0]) / 20000;
    normal += std::get<double>(values[1]) / 20000;
    square += std::pow(std::get<double>(values[1]) - 10.0, 2) / 20000;
    logarithm += std::log10(std::get<double>(values[2])) / 20000;
  }
  EXPECT_NEAR(uniform, 3.0, 5 * 2.0 / std::sqrt(12.0 * 20000));
  EXPECT_NEAR(normal, 10.0, 5 * 2.0 / std::sqrt(20000.0));
  EXPECT_NEAR(square, 4.0, 5 * 4.0 * std::sqrt(2.0 / 20000));
  EXPECT_NEAR(logarithm, 1.0, 5 * 2.0 / std::sqrt(12.0 * 20000));
}

}  // namespace
}  // namespace beamid::experiments::sweep_plan_test
