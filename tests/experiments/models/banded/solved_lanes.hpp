// Systems solved four at a time and one by one, as tests of factors ask for them.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "experiments/models/banded/banded_lanes.hpp"

namespace beamid::test {

/// The factor of a matrix (n x n) solves four random systems side by side to rounding, and one by itself to
/// the same bits: columns do not know of each other. Oracle: the residual.
/// @returns the right sides and the solutions (n x 4)
template <class Factor>
std::pair<Eigen::MatrixXcd, Eigen::MatrixXcd> expect_solved(const Eigen::MatrixXcd& matrix,
                                                            const Factor& factor, const std::string& which) {
  using Eigen::Index, Eigen::MatrixXcd;
  using experiments::banded::Complex, experiments::banded::ComplexLanes;
  const Index size = matrix.rows();
  const MatrixXcd right = MatrixXcd::Random(size, 4);
  std::vector<ComplexLanes> block(static_cast<std::size_t>(size));
  std::vector<Complex> single(static_cast<std::size_t>(size));
  for (Index i = 0; i < size; ++i) {
    for (int k = 0; k < 4; ++k) {
      block[i].re.values[k] = right(i, k).real();
      block[i].im.values[k] = right(i, k).imag();
    }
    single[i] = {right(i, 2).real(), right(i, 2).imag()};
  }
  factor.solve(block.data());
  factor.solve(single.data());
  MatrixXcd found(size, 4);
  for (Index i = 0; i < size; ++i) {
    for (int k = 0; k < 4; ++k) found(i, k) = {block[i].re.values[k], block[i].im.values[k]};
    EXPECT_EQ(single[i].re, found(i, 2).real());
    EXPECT_EQ(single[i].im, found(i, 2).imag());
  }
  EXPECT_LT((matrix * found - right).norm(), 1e-14 * matrix.norm() * found.norm()) << which;
  return {right, found};
}

}  // namespace beamid::test
