// The contracts of beamid's own models, kept by this one, which takes no forces.
#include <beamid/testing/model_contracts.hpp>

namespace beamid::test {
INSTANTIATE_TEST_SUITE_P(Mine, EveryModel,
                         testing::Combine(testing::Values("weighing"), testing::Values(false)),
                         by_name_and_force);
}  // namespace beamid::test
