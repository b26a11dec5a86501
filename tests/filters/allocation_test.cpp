// No filter step of the dense Gaussian filters asks for memory.
#include <gtest/gtest.h>

#include <cstdlib>

#include "beamid/testing/oscillator.hpp"
#include "filters/filter.hpp"

// Eigen's matrices take their memory from malloc, not from operator new, so malloc is what is counted: the
// program's own replaces the C library's. A sanitizer has replaced it already.
#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define BEAMID_COUNTS_MALLOC 1
namespace {
thread_local long allocations = 0;
}
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
#endif

namespace beamid::allocation_test {
namespace {

#ifdef BEAMID_COUNTS_MALLOC

using Eigen::Matrix2d, Eigen::Matrix4d, Eigen::Vector4d, Eigen::VectorXd;

TEST(Allocation, IsCounted) {
  const long before = allocations;
  const auto made = std::make_unique<Eigen::VectorXd>(20);
  EXPECT_EQ(allocations - before, 2) << made->size();  // operator new and the vector's own
}

class Steps : public testing::TestWithParam<const char*> {};

TEST_P(Steps, AskForNoMemory) {
  const Matrix4d process = Vector4d(1e-16, 1e-14, 1e-6, 1e-8).asDiagonal();
  const Matrix2d noise = 1e-8 * Matrix2d::Identity();
  const auto filter = filters::filter_registry().make(
      GetParam(), {},
      filters::discretise(std::make_shared<test::Oscillator>(3.0, 2), 1e-3, "exponential", {process, noise}));
  const Vector4d start(0.012, 0.0, 500.0, 8.0), variance(1e-6, 1e-4, 1e2, 1.0);
  filter->reset({start, variance.asDiagonal()});
  const VectorXd input, output = VectorXd::Constant(2, 0.01);
  for (int k = 0; k < 2; ++k) filter->correct(output, input), filter->predict(input);  // sizes its work space
  const long before = allocations;
  for (int k = 0; k < 50; ++k) filter->correct(output, input), filter->predict(input);
  EXPECT_EQ(allocations - before, 0);
}

INSTANTIATE_TEST_SUITE_P(Dense, Steps, testing::Values("ekf", "ukf", "ckf", "srukf", "srckf"),
                         [](const auto& tested) { return std::string(tested.param); });

#endif

}  // namespace
}  // namespace beamid::allocation_test
