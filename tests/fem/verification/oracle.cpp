#include "tests/fem/verification/oracle.hpp"

#include <utility>

namespace beamid::test {

fem::Beam uniform_beam(std::vector<fem::Support> supports) {
  fem::Beam beam;
  beam.segments = {{1.3, {7.3, 0.9, 0.0, {}, {}, {}}}};
  beam.supports = std::move(supports);
  return beam;
}

double angular_frequency(double b) {
  return b * b / (length * length) * std::sqrt(bending_stiffness / mass_per_length);
}

void record(const std::string& key, double error) {
  static std::map<std::string, double> largest;
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  double& worst = largest[std::string(test.test_suite_name()) + "." + test.name() + "." + key];
  worst = std::max(worst, std::abs(error));
  std::ostringstream text;
  text.precision(2);
  text << worst;
  testing::Test::RecordProperty(key, text.str());
}

void expect_frequencies(const fem::Beam& beam, const std::vector<double>& known, const Tolerance& tolerance) {
  const auto count = static_cast<Eigen::Index>(known.size());
  const auto exact = fem::exact_modes(beam, count, {});
  const auto modes = fem::modes(fem::assemble(beam, tolerance.elements, {}), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto expect_near = [&](const char* key, double omega, double limit) {
      if (known[i] == 0.0) {
        EXPECT_EQ(omega, 0.0) << key << ", mode " << i + 1;
        return;
      }
      EXPECT_NEAR(omega / known[i], 1.0, limit) << key << ", mode " << i + 1;
      record(key, omega / known[i] - 1.0);
    };
    if (exact) expect_near("exact_modes", exact->angular_frequency[i], tolerance.exact);
    expect_near("finite_elements", modes.angular_frequency[i], tolerance.finite_elements);
  }
}

}  // namespace beamid::test
