// Products of the algorithms.
#pragma once

#include "filters/algorithms/scalar.hpp"

namespace beamid::filters::algorithms {

enum class Form { plain, transposed };
enum class Into { new_sum, old_sum };

/// Rows entries of one column of A B: sum_k A_k b_k, A of leading dimension `lead`, b with `step` between
/// entries.
template <int Rows, Into into>
void product_block(const double* a, Eigen::Index lead, const double* b, Eigen::Index step, Eigen::Index depth,
                   double* out) {
  double sum[Rows];
  for (int r = 0; r < Rows; ++r) sum[r] = into == Into::old_sum ? out[r] : 0.0;
  for (Eigen::Index k = 0; k < depth; ++k)
    for (int r = 0; r < Rows; ++r) sum[r] += a[k * lead + r] * b[k * step];
  for (int r = 0; r < Rows; ++r) out[r] = sum[r];
}

/// out = A B or A B^T, or the same added to out, which must be another matrix than A and B. Eigen's own
/// products, but where small sizes are known at run time only: those take half of its time in blocks of rows.
template <Form form = Form::plain, Into into = Into::new_sum, class A, class B, class Out>
void multiply(const A& a, const B& b, Out& out) {
  if constexpr (A::SizeAtCompileTime == Eigen::Dynamic) {
    const Eigen::Index rows = a.rows(), depth = a.cols();
    const Eigen::Index columns = form == Form::plain ? b.cols() : b.rows();
    if (rows <= 16 && columns <= 16 && depth <= 40) {
      if (into == Into::new_sum) out.resize(rows, columns);
      const Eigen::Index step = form == Form::plain ? 1 : b.rows(), next = form == Form::plain ? b.rows() : 1;
      for (Eigen::Index j = 0; j < columns; ++j) {
        const double* column = b.data() + j * next;
        Eigen::Index i = 0;
        for (; i + 4 <= rows; i += 4)
          product_block<4, into>(a.data() + i, rows, column, step, depth, &out(i, j));
        for (; i + 2 <= rows; i += 2)
          product_block<2, into>(a.data() + i, rows, column, step, depth, &out(i, j));
        for (; i < rows; ++i) product_block<1, into>(a.data() + i, rows, column, step, depth, &out(i, j));
      }
      return;
    }
  }
  if constexpr (form == Form::plain && into == Into::new_sum) out.noalias() = a * b;
  if constexpr (form == Form::transposed && into == Into::new_sum) out.noalias() = a * b.transpose();
  if constexpr (form == Form::plain && into == Into::old_sum) out.noalias() += a * b;
  if constexpr (form == Form::transposed && into == Into::old_sum) out.noalias() += a * b.transpose();
}

template <Into into = Into::new_sum, class A, class B, class Out>
void multiply_transposed(const A& a, const B& b, Out& out) {
  multiply<Form::transposed, into>(a, b, out);
}

/// Copies what is below the diagonal to where it is mirrored.
template <class Square>
void mirror(Square& a) {
  for (Eigen::Index j = 1; j < a.cols(); ++j)
    for (Eigen::Index i = 0; i < j; ++i) a(i, j) = a(j, i);
}

}  // namespace beamid::filters::algorithms
