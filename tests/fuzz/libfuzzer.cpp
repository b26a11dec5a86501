// One target of targets.hpp under libFuzzer, named by the environment: BEAMID_FUZZ=lvm fuzz_readers CORPUS...
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/fuzz/targets.hpp"

namespace {

const beamid::fuzz::Target* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* const name = std::getenv("BEAMID_FUZZ");
  for (const auto& target : beamid::fuzz::targets())
    if (name && std::strcmp(name, target.name) == 0) chosen = &target;
  if (chosen) {
    chosen->read("", 0);  // what it sets up once is no input's time
    return 0;
  }
  std::fprintf(stderr, "BEAMID_FUZZ names no target; expected one of:");
  for (const auto& target : beamid::fuzz::targets()) std::fprintf(stderr, " %s", target.name);
  std::fprintf(stderr, "\n");
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The way is part of the input: the sum of its bytes, which any mutation changes.
  unsigned sum = 0;
  for (std::size_t k = 0; k < size; ++k) sum += data[k];
  chosen->read({reinterpret_cast<const char*>(data), size},
               static_cast<int>(sum % static_cast<unsigned>(chosen->ways)));
  return 0;
}
