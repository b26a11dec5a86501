// The contracts of beamid's own filters, kept by this one.
#include <beamid/testing/filter_contracts.hpp>

namespace beamid::test {
INSTANTIATE_TEST_SUITE_P(Mine, EveryFilter, testing::Values("fading_ekf"), by_name);
}  // namespace beamid::test
