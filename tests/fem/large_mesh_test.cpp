// Frequencies keep their digits however fine the mesh. The assembled stiffness matrix has lost them at 1e5
// coordinates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "fem/assembly.hpp"
#include "fem/modes.hpp"

namespace beamid::large_mesh_test {
namespace {

constexpr double pi = std::numbers::pi;

#if defined(__SANITIZE_ADDRESS__)
const std::vector<int> meshes{500, 5'000};  // elements; instrumented code is slow
constexpr int finest = 50'000;
#else
const std::vector<int> meshes{500, 5'000, 50'000};
constexpr int finest = 500'000;
#endif

// Root of f between a and b, by bisection to the last bit.
double root(const std::function<double(double)>& f, double a, double b) {
  const bool rising = f(b) > 0.0;
  for (double middle = 0.5 * (a + b); a < middle && middle < b; middle = 0.5 * (a + b))
    ((f(middle) > 0.0) == rising ? b : a) = middle;
  return 0.5 * (a + b);
}

// First roots b of the frequency equations, omega = b^2 sqrt(EI / (rho A L^4)), divided by cosh b.
const double clamped_free = root([](double b) { return std::cos(b) + 1.0 / std::cosh(b); }, 1.0, 3.0);
const double clamped_clamped = root([](double b) { return std::cos(b) - 1.0 / std::cosh(b); }, 4.0, 6.0);
const double clamped_pinned =
    root([](double b) { return std::sin(b) - std::tanh(b) * std::cos(b); }, 3.5, 4.5);
const double clamped_guided =
    root([](double b) { return std::sin(b) + std::tanh(b) * std::cos(b); }, 2.0, 3.0);

struct Case {
  std::string name;
  std::vector<fem::Support> supports;
  double root;
  int rigid;
};
const std::vector<Case> cases = {
    {"clamped-free", {{0.0, true, true}}, clamped_free, 0},
    {"clamped-clamped", {{0.0, true, true}, {1.0, true, true}}, clamped_clamped, 0},
    {"clamped-pinned", {{0.0, true, true}, {1.0, true, false}}, clamped_pinned, 0},
    {"clamped-guided", {{0.0, true, true}, {1.0, false, true}}, clamped_guided, 0},
    {"pinned-pinned", {{0.0, true, false}, {1.0, true, false}}, pi, 0},
    {"pinned-guided", {{0.0, true, false}, {1.0, false, true}}, 0.5 * pi, 0},
    {"free-free", {}, clamped_clamped, 2},
    {"free-pinned", {{1.0, true, false}}, clamped_pinned, 1},
    {"free-guided", {{1.0, false, true}}, clamped_guided, 1},
    {"free-clamped", {{1.0, true, true}}, clamped_free, 0},
    {"guided-guided", {{0.0, false, true}, {1.0, false, true}}, pi, 1}};

double relative_error(const Case& which, int elements) {
  fem::Beam beam;
  beam.segments = {{1.0, {1.0, 1.0, 0.0, {}, {}, {}}}};
  beam.supports = which.supports;
  const auto modes = fem::modes(assemble(beam, elements, {}), which.rigid + 1);
  EXPECT_EQ(modes.rigid, which.rigid) << which.name;
  EXPECT_GT(modes.digits(which.rigid), 8.0) << which.name << ", " << elements << " elements";
  return modes.angular_frequency[which.rigid] / (which.root * which.root) - 1.0;
}

TEST(LargeMesh, FirstFrequencyOfEverySupportErrsByTheDiscretisationAlone) {
  for (const Case& which : cases)
    for (const int elements : meshes) {
      const double discretisation = std::pow(which.root / elements, 4) / 1440.0;
      EXPECT_NEAR(relative_error(which, elements), discretisation, 1e-12) << which.name << ", " << elements;
    }
}

TEST(LargeMesh, AMillionCoordinatesLeaveAClampedBeamTwelveDigits) {
  EXPECT_NEAR(relative_error(cases[1], finest), 0.0, 1e-12);
}

}  // namespace
}  // namespace beamid::large_mesh_test
