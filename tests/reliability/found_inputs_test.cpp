// The corpus of the fuzzers, and every input that once broke something, through the readers as they ship: no
// clang, no libFuzzer. An exception other than a refusal fails the test, a broken promise or a crash ends it.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/apps/run_command.hpp"
#include "tests/fuzz/targets.hpp"

namespace beamid::reliability::found_inputs_test {
namespace {

class FoundInputs : public testing::TestWithParam<fuzz::Target> {};

TEST_P(FoundInputs, AreReadOrRefused) {
  int count = 0;
  for (const char* kind : {"corpus", "found"}) {
    const auto folder = apps::source("tests/fuzz") / kind / GetParam().name;
    if (!apps::fs::exists(folder)) continue;
    for (const auto& entry : apps::fs::directory_iterator(folder)) {
      SCOPED_TRACE(entry.path());
      for (int way = 0; way < GetParam().ways; ++way)
        EXPECT_NO_THROW(GetParam().read(apps::contents(entry.path()), way));
      ++count;
    }
  }
  EXPECT_GT(count, 0);
}

INSTANTIATE_TEST_SUITE_P(Of, FoundInputs, testing::ValuesIn(fuzz::targets()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace beamid::reliability::found_inputs_test
