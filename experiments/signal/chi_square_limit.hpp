// Points of chi-square and of Student's t.
#pragma once

namespace beamid::experiments {

/// 95 % point of chi-square, or another one. @param freedom above 0
double chi_square_limit(double freedom, double probability = 0.95);

/// 97.5 % point of Student's t over that of the normal distribution: what not knowing a noise exactly adds to
/// a 95 % interval.
double student_factor(double freedom);

}  // namespace beamid::experiments
