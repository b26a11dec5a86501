// Products with B^T D B, element by element.
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "experiments/models/banded/banded_blocks.hpp"
#include "experiments/models/banded/banded_lanes.hpp"
#include "fem/structural_system.hpp"

namespace beamid::experiments::banded {

// A sparse matrix by rows, for products with what moves.

class SparseRows {
 public:
  SparseRows() = default;
  explicit SparseRows(const fem::SparseMatrix& matrix);

  bool is_empty() const { return value_.empty(); }

  /// y = A x and y += factor A x; entries are double, Complex or Lanes.
  template <class Entry>
  void multiply(const Entry* x, Entry* y) const;
  template <class Entry>
  void add_product(const Entry* x, Entry* y, double factor = 1.0) const;

  /// total += x^T A y for four x at a time.
  void add_form(const Lanes* x, const double* y, Lanes& total) const;

  /// The values, row after row, columns ascending, to be changed.
  std::vector<double>& values() { return value_; }
  const std::vector<double>& values() const { return value_; }
  /// The entries of a matrix that has no others, among the values.
  EntryList entries_of(const fem::SparseMatrix& matrix) const;

 private:
  std::vector<int> start_, column_;
  std::vector<double> value_;
};

/// y += B^T D B x through the strains of each element. It costs what a product with the assembled matrix
/// costs, but keeps its digits: the strains of a fine mesh are small differences, which an assembled matrix
/// would take from large products.
///
/// Elements of an Euler-Bernoulli beam that follow one another, whose strains are
///
///     w_1 + a t_1 - w_2,    b t_1 + c t_2,
///
/// hand their common node on in registers; whatever else D consists of is taken row by row.
class StrainProduct {
 public:
  StrainProduct() = default;  ///< of nothing
  /// @param rigidity D (s x s), whose blocks may be smaller than those that `starts` names
  /// @param starts first strain of each block that no rigidity reaches out of, and s
  /// @throws std::invalid_argument when a block has more than `largest_block` strains.
  StrainProduct(const fem::SparseMatrix& strain, const fem::SparseMatrix& rigidity,
                const std::vector<int>& starts);
  static constexpr int largest_block = 8;

  /// D := D of another, made with the same entries.
  void take_rigidity(const StrainProduct& other);
  /// D := D + factor D_part, of a part made with the same strains and blocks all of which are here.
  void add(double factor, const StrainProduct& part);

  /// y += B^T D B x; entries are double, Complex or Lanes.
  template <class Entry>
  void operator()(const Entry* x, Entry* y) const;
  /// total += x^T B^T D B y for four x at a time, through the strains of all.
  void add_form(const Lanes* x, const double* y, Lanes& total) const;

  /// Coordinates [first, second) that it touches.
  std::pair<Eigen::Index, Eigen::Index> reach() const { return reach_; }

 private:
  struct Element {
    double a, b, c;        // of B
    double d11, d12, d22;  // of D
    int strain;            // its first
  };
  struct Run {
    int coordinate;   // w_1 of its first element
    int first, last;  // elements
  };
  struct Block {
    int strain, size;
    int rigidity;  // where its size x size entries of D begin
  };
  template <class Entry>
  void multiply(const Entry* x, Entry* y) const;
  template <class Entry>
  void strains(const Block& block, const Entry* x, Entry* e) const;
  bool add_element(const Block& block, const double* rigidity);

  std::vector<int> row_start_, column_;  // B by rows
  std::vector<double> value_;
  std::vector<Element> elements_;
  std::vector<Run> runs_;
  std::vector<Block> blocks_;
  std::vector<double> rigidity_;
  std::pair<Eigen::Index, Eigen::Index> reach_;
};

}  // namespace beamid::experiments::banded
