#include "tests/experiments/record/files/written_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace beamid::experiments {

double first_signal(int k) {
  return std::sin(0.7 * k) + 0.25;
}
double second_signal(int k) {
  return 3.0 * std::cos(0.2 * k);
}

void expect_both(const Record& record, double tolerance) {
  ASSERT_EQ(record.size(), written_samples);
  ASSERT_EQ(record.channels.size(), 2u);
  EXPECT_EQ(record.channels[0].quantity, Quantity::acceleration);
  EXPECT_EQ(record.channels[1].quantity, Quantity::force);
  for (int k = 0; k < written_samples; ++k) {
    EXPECT_NEAR(record.time[k], 0.01 * k, 1e-6);
    EXPECT_NEAR(record.samples(0, k), 9.80665 * first_signal(k), 10 * tolerance);
    EXPECT_NEAR(record.samples(1, k), second_signal(k), tolerance);
  }
}

std::string printed(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof(buffer), format, value);
  return buffer;
}

std::vector<double> values_of(double (*signal)(int)) {
  std::vector<double> values(written_samples);
  for (int k = 0; k < written_samples; ++k) values[static_cast<std::size_t>(k)] = signal(k);
  return values;
}

}  // namespace beamid::experiments
