// S of a step, factored in the storage that suits its structure.
#pragma once

#include <variant>
#include <vector>

#include "experiments/models/banded/banded_factor.hpp"
#include "experiments/models/banded/sparse_factor.hpp"

namespace beamid::experiments::banded {

/// L D L^T of a complex symmetric matrix with positive definite imaginary part: a band where node follows
/// node as along a beam (narrow_band), else sparse.
class StepFactor {
 public:
  explicit StepFactor(const SymmetricPattern& pattern);

  bool is_band() const { return std::holds_alternative<Band>(kind_); }

  /// @param entries S on the pattern
  /// @throws std::runtime_error when a pivot is zero or not a number.
  void factor(const std::vector<Complex>& entries);
  void solve(Complex* b) const;       ///< S x = b in place, b (n)
  void solve(ComplexLanes* b) const;  ///< the same for four columns at a time
  /// The real part of S^-1 b, b real (n).
  Eigen::VectorXd real_part_solved(const Eigen::VectorXd& b) const;
  /// The largest entry that elimination met over the largest of S.
  double growth(const std::vector<Complex>& entries) const;

 private:
  struct Band {
    BandedFactor factor;
    std::vector<std::size_t> places;  // of the pattern's entries
  };
  static std::variant<Band, SparseFactor> made_for(const SymmetricPattern& pattern);

  std::variant<Band, SparseFactor> kind_;
};

}  // namespace beamid::experiments::banded
