// Every registered model keeps the contracts that users hold theirs to, and has what all of these have. A new
// one is found by itself.
#include <gtest/gtest.h>

#include "beamid/testing/model_contracts.hpp"

namespace beamid::test {
INSTANTIATE_TEST_SUITE_P(Registered, EveryModel,
                         testing::Combine(testing::ValuesIn(names_in(experiments::model_registry())),
                                          testing::Bool()),
                         by_name_and_force);
}  // namespace beamid::test

namespace beamid::experiments::conformance_test {
namespace {

TEST(Models, GiveEveryAccelerometerAnOffset) {
  for (const std::string& name : test::names_in(model_registry())) {
    const auto model =
        test::model_contracts::make({name, false}, {Quantity::acceleration, Quantity::displacement});
    ASSERT_EQ(model->offsets.size(), 1u) << name;
    EXPECT_EQ(model->offsets[0].channel, 0) << name;
  }
}

}  // namespace
}  // namespace beamid::experiments::conformance_test
