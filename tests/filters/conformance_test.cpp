// Every registered filter and smoother keeps the contracts that users hold theirs to. A new one is found by
// itself.
#include <gtest/gtest.h>

#include "beamid/testing/filter_contracts.hpp"
#include "beamid/testing/smoother_contracts.hpp"

namespace beamid::test {
INSTANTIATE_TEST_SUITE_P(Registered, EveryFilter, testing::ValuesIn(names_in(filters::filter_registry())),
                         by_name);
INSTANTIATE_TEST_SUITE_P(Registered, EverySmoother, testing::ValuesIn(names_in(filters::smoother_registry())),
                         by_name);
}  // namespace beamid::test

namespace beamid::test::conformance_test {
namespace {

TEST(Filters, CiteTheirSources) {
  for (const auto& [name, entry] : filters::filter_registry().entries())
    EXPECT_EQ(entry.source.front(), '[') << name;
}

}  // namespace
}  // namespace beamid::test::conformance_test
