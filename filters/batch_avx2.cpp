// The one file compiled for processors with AVX2 and FMA (CMakeLists.txt).
//
// Whatever template it instantiates must bear the name of Avx2: a function of any other name, compiled here,
// might be the copy that the linker gives to the whole program, and end it on older processors. A test looks.
#include "filters/batch_avx2.hpp"

namespace beamid::filters::algorithms {

#ifdef __AVX2__

namespace {
struct Avx2 {};
}  // namespace

void run_group_avx2(TrialGroup& group) {
  run_group<4, Avx2>(group);
}
void run_innovations_avx2(InnovationGroup& group) {
  run_innovations<4, Avx2>(group);
}
bool compiled_for_avx2() {
  return true;
}

#else

void run_group_avx2(TrialGroup&) {}
void run_innovations_avx2(InnovationGroup&) {}
bool compiled_for_avx2() {
  return false;
}

#endif

}  // namespace beamid::filters::algorithms
