// Every registered reduction keeps the contracts that users hold theirs to. A new one is found by itself.
#include "reduction/reduction.hpp"

#include <gtest/gtest.h>

#include "beamid/testing/reduction_contracts.hpp"

namespace beamid::test {
INSTANTIATE_TEST_SUITE_P(Registered, EveryReduction,
                         testing::ValuesIn(names_in(reduction::reduction_registry())), by_name);
}  // namespace beamid::test

namespace beamid::reduction_test {
namespace {

using reduction::reduction_registry;

TEST(Registry, NamesWhatItKnows) {
  try {
    reduction_registry().make("guian", {});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "unknown reduction 'guian'; known: balanced_truncation, craig_bampton, guyan, irs, krylov, "
                 "modal_truncation, none, pod, rayleigh, serep");
  }
}

}  // namespace
}  // namespace beamid::reduction_test
