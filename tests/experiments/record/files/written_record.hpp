// Two signals that tests write into files of every kind and expect back.
#pragma once

#include <string>
#include <vector>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

inline constexpr int written_samples = 40;

double first_signal(int k);
double second_signal(int k);
std::vector<double> values_of(double (*signal)(int));

/// Acceleration [g] and force [N], forty samples at 100 Hz.
void expect_both(const Record& record, double tolerance);

std::string printed(const char* format, double value);

}  // namespace beamid::experiments
