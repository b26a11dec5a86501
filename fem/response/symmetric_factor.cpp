#include "fem/response/symmetric_factor.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCholesky>

#include "fem/structural_system.hpp"

namespace beamid::fem {

using Eigen::Index, Eigen::VectorXd;

DiagonalProduct::DiagonalProduct(const SparseMatrix& a) {
  struct Range {
    Index first, last;  // columns
  };
  std::map<Index, Range> ranges;  // by column - row
  for (Index column = 0; column < a.cols(); ++column)
    for (SparseMatrix::InnerIterator it(a, column); it; ++it) {
      if (it.value() == 0.0) continue;
      const auto [range, is_new] = ranges.try_emplace(column - it.row(), Range{column, column});
      range->second.last = column;
    }
  Index stored = 0;
  for (const auto& [offset, range] : ranges) stored += range.last - range.first + 1;
  if (stored > 3 * a.nonZeros()) {  // the zeros in between would take longer than they save
    rest_ = a;
    return;
  }
  std::map<Index, std::size_t> place;
  for (const auto& [offset, range] : ranges) {
    place[offset] = diagonals_.size();
    diagonals_.push_back({range.first - offset, range.first, VectorXd::Zero(range.last - range.first + 1)});
  }
  for (Index column = 0; column < a.cols(); ++column)
    for (SparseMatrix::InnerIterator it(a, column); it; ++it)
      if (it.value() != 0.0) {
        Diagonal& diagonal = diagonals_[place[column - it.row()]];
        diagonal.entries[column - diagonal.column] = it.value();
      }
}

void DiagonalProduct::add(const VectorXd& x, VectorXd& y) const {
  for (const auto& [row, column, entries] : diagonals_)
    y.segment(row, entries.size()) += entries.cwiseProduct(x.segment(column, entries.size()));
  if (rest_.nonZeros() > 0) y.noalias() += rest_ * x;
}

void DiagonalProduct::subtract(const VectorXd& x, VectorXd& y) const {
  for (const auto& [row, column, entries] : diagonals_)
    y.segment(row, entries.size()) -= entries.cwiseProduct(x.segment(column, entries.size()));
  if (rest_.nonZeros() > 0) y.noalias() -= rest_ * x;
}

namespace {

// A narrow band, factored from both ends.

/// L D L^T of a symmetric positive definite band with at most `width` entries beside the diagonal. The first
/// and the last rows are eliminated side by side towards some rows in the middle: in each elimination every
/// row waits for the one before it, and two that do not wait for each other take the time of one.
template <int width>
class BandFactor {
 public:
  BandFactor(const SparseMatrix& a, const std::string& what)
      : n_(a.rows()), chain_(std::max<Eigen::Index>(0, (n_ - width) / 2)), middle_(n_ - 2 * chain_) {
    Eigen::MatrixXd middle = Eigen::MatrixXd(a.block(chain_, chain_, middle_, middle_));
    for (Half& half : halves_) eliminate(a, half, &half == &halves_[1], middle, what);
    middle_factor_.compute(middle);
    if (middle_factor_.info() != Eigen::Success) fail(what);
  }

  void solve(Eigen::VectorXd& b) const {
    double *first = b.data(), *last = b.data() + n_ - 1;
    Recent one, two;
    for (Eigen::Index i = 0; i < chain_; ++i) {
      first[i] = one.append(one.take_from(first[i], &halves_[0].lower[i * width]));
      last[-i] = two.append(two.take_from(last[-i], &halves_[1].lower[i * width]));
    }
    for (Eigen::Index i = 0; i < std::min<Eigen::Index>(middle_, width);
         ++i) {  // what both chains left to the middle
      first[chain_ + i] = one.take_from(first[chain_ + i], &halves_[0].lower[(chain_ + i) * width]);
      last[-chain_ - i] = two.take_from(last[-chain_ - i], &halves_[1].lower[(chain_ + i) * width]);
      one.append(0.0);
      two.append(0.0);
    }
    auto middle = b.segment(chain_, middle_);
    middle_factor_.solveInPlace(middle);
    if (chain_ == 0) return;
    for (int k = width; k-- > 0;) {
      one.append(first[chain_ + k]);
      two.append(last[-chain_ - k]);
    }
    for (Eigen::Index i = chain_; i-- > 0;) {
      first[i] = one.append(one.take_from(first[i] * halves_[0].inverse[i], &halves_[0].upper[i * width]));
      last[-i] = two.append(two.take_from(last[-i] * halves_[1].inverse[i], &halves_[1].upper[i * width]));
    }
  }

 private:
  // The `width` newest entries, the newest last. What is taken off for them goes oldest first.
  struct Recent {
    std::array<double, width> values{};
    double append(double value) {
      for (std::size_t k = 0; k + 1 < width; ++k) values[k] = values[k + 1];
      return values[width - 1] = value;
    }
    double take_from(double value, const double* row) const {
      for (std::size_t k = 0; k < width; ++k) value -= row[k] * values[k];
      return value;
    }
  };
  struct Half {
    std::vector<double> lower, upper, inverse;  // L by rows, L by columns (farthest first), 1/D
  };

  // Rows are counted from the end of this half. What its elimination takes off the middle rows is taken off
  // `middle`.
  void eliminate(const SparseMatrix& a, Half& half, bool reversed, Eigen::MatrixXd& middle,
                 const std::string& what) {
    const Eigen::Index rows = chain_ + std::min<Eigen::Index>(middle_, width);
    const auto place = [&](Eigen::Index i) { return reversed ? n_ - 1 - i : i; };
    half.lower.assign(static_cast<std::size_t>(rows) * width, 0.0);
    half.upper.assign(static_cast<std::size_t>(chain_) * width, 0.0);
    half.inverse.assign(chain_, 0.0);
    std::vector<double> pivot(chain_);
    const auto lower = [&](Eigen::Index i, Eigen::Index j) -> double& {
      return half.lower[i * width + (j - i + width)];
    };
    for (Eigen::Index i = 0; i < rows; ++i) {
      std::array<double, width + 1> row{};
      for (SparseMatrix::InnerIterator it(a, place(i)); it; ++it)
        if (const Eigen::Index j = place(it.row()); j <= i && i - j <= width) row[j - i + width] = it.value();
      for (Eigen::Index j = std::max<Eigen::Index>(0, i - width); j < std::min(i, chain_); ++j) {
        for (Eigen::Index k = std::max<Eigen::Index>(0, i - width); k < j; ++k)
          if (j - k <= width) row[j - i + width] -= lower(i, k) * pivot[k] * lower(j, k);
        lower(i, j) = row[j - i + width] / pivot[j];
        half.upper[j * width + (width - (i - j))] = lower(i, j);
      }
      const auto taken = [&](Eigen::Index j) {
        double sum = 0.0;
        for (Eigen::Index k = std::max<Eigen::Index>(0, i - width); k < std::min(j, chain_); ++k)
          if (j - k <= width) sum += lower(i, k) * pivot[k] * lower(j, k);
        return sum;
      };
      if (i < chain_) {
        pivot[i] = row[width] - taken(i);
        if (!(pivot[i] > 0.0)) fail(what);
        half.inverse[i] = 1.0 / pivot[i];
      }
      for (Eigen::Index j = chain_; j <= i; ++j) {
        const Eigen::Index r = place(i) - chain_, c = place(j) - chain_;
        middle(std::max(r, c), std::min(r, c)) -= taken(j);
      }
    }
  }

  [[noreturn]] static void fail(const std::string& what) {
    throw std::runtime_error(what + " is not positive definite");
  }

  Eigen::Index n_, chain_, middle_;
  std::array<Half, 2> halves_;
  Eigen::LLT<Eigen::MatrixXd> middle_factor_;  // of its lower triangle
};

}  // namespace

struct SymmetricFactor::Method {
  virtual ~Method() = default;
  virtual void solve(Eigen::VectorXd& b) const = 0;
};

namespace {

template <int width>
class Band final : public SymmetricFactor::Method {
 public:
  Band(const SparseMatrix& a, const std::string& what) : factor_(a, what) {}
  void solve(VectorXd& b) const override { factor_.solve(b); }

 private:
  BandFactor<width> factor_;
};

class Sparse final : public SymmetricFactor::Method {
 public:
  Sparse(const SparseMatrix& a, const std::string& what) : factor_(a) {
    if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0.0))
      throw std::runtime_error(what + " is not positive definite");
  }
  void solve(VectorXd& b) const override { b = factor_.solve(b); }

 private:
  Eigen::SimplicialLDLT<SparseMatrix> factor_;
};

Index half_bandwidth(const SparseMatrix& a) {
  Index width = 0;
  for (Index column = 0; column < a.outerSize(); ++column)
    for (SparseMatrix::InnerIterator it(a, column); it; ++it)
      if (it.value() != 0.0) width = std::max(width, std::abs(it.row() - column));
  return width;
}

}  // namespace

SymmetricFactor::SymmetricFactor(const SparseMatrix& a, const std::string& what) {
  const Index width = half_bandwidth(a);
  if (width <= 3)
    method_ = std::make_unique<Band<3>>(a, what);
  else if (width <= 8)
    method_ = std::make_unique<Band<8>>(a, what);
  else
    method_ = std::make_unique<Sparse>(a, what);
}
SymmetricFactor::~SymmetricFactor() = default;
SymmetricFactor::SymmetricFactor(SymmetricFactor&&) noexcept = default;

void SymmetricFactor::solve_in_place(VectorXd& b) const {
  method_->solve(b);
}

}  // namespace beamid::fem
