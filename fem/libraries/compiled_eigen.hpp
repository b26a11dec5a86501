// Eigen's dense kernels and decompositions of plain matrices, compiled once (compiled_eigen.cpp). Without
// these declarations every unit compiles them anew: a product 2 s, LLT 3, QR 6, SelfAdjointEigenSolver 5,
// EigenSolver 9, BDCSVD 28. Each unit of the project includes this with its precompiled header, none by
// itself.
//
// Only what is no inline function is left to the other unit: products of other expressions, and wrappers in
// class bodies, are compiled where they stand. Functions, and so results, are the same.
#pragma once

#include <Eigen/Dense>

#ifndef BEAMID_COMPILED_EIGEN
#define BEAMID_COMPILED_EIGEN extern template
#endif

#if !EIGEN_VERSION_AT_LEAST(3, 4, 90)  // the names below are those of 3.4, of Debian 12 and 13

namespace Eigen {
namespace internal {

using Complex = std::complex<double>;
template <class Scalar, int Order>
using Factor = const_blas_data_mapper<Scalar, Index, Order>;
template <class Scalar>
using Result = blas_data_mapper<Scalar, Index, ColMajor, Unaligned, 1>;

// Products of matrices: a panel of the result, and the factors packed for it.
template <class L, class R>
using Panels = gebp_traits<L, R>;
#define BEAMID_PANEL_KERNEL(L, R, S)                                                                   \
  BEAMID_COMPILED_EIGEN struct gebp_kernel<L, R, Index, Result<S>, Panels<L, R>::mr, Panels<L, R>::nr, \
                                           false, false>
BEAMID_PANEL_KERNEL(double, double, double);
BEAMID_PANEL_KERNEL(Complex, Complex, Complex);
BEAMID_PANEL_KERNEL(double, Complex, Complex);
BEAMID_PANEL_KERNEL(Complex, double, Complex);
#undef BEAMID_PANEL_KERNEL

using Real = Panels<double, double>;
#define BEAMID_PACK_LEFT(MAPPER, ...)                                                            \
  BEAMID_COMPILED_EIGEN struct gemm_pack_lhs<double, Index, MAPPER, Real::mr, Real::LhsProgress, \
                                             Real::LhsPacket4Packing, __VA_ARGS__>
#define BEAMID_PACK_RIGHT(MAPPER, ...) \
  BEAMID_COMPILED_EIGEN struct gemm_pack_rhs<double, Index, MAPPER, Real::nr, __VA_ARGS__>
using Columns = Factor<double, ColMajor>;
using Rows = Factor<double, RowMajor>;
BEAMID_PACK_LEFT(Columns, ColMajor);
BEAMID_PACK_LEFT(Rows, RowMajor);
BEAMID_PACK_LEFT(Result<double>, ColMajor, false, true);
BEAMID_PACK_RIGHT(Columns, ColMajor);
BEAMID_PACK_RIGHT(Rows, RowMajor);
BEAMID_PACK_RIGHT(Result<double>, ColMajor, false, true);
#undef BEAMID_PACK_LEFT
#undef BEAMID_PACK_RIGHT

// A matrix times a vector; the orders are those of the matrix and of the vector's mapper.
#define BEAMID_TIMES_VECTOR(L, ORDER, R, VECTOR)                                                          \
  BEAMID_COMPILED_EIGEN struct general_matrix_vector_product<Index, L, Factor<L, ORDER>, ORDER, false, R, \
                                                             Factor<R, VECTOR>, false>
BEAMID_TIMES_VECTOR(double, ColMajor, double, ColMajor);
BEAMID_TIMES_VECTOR(double, ColMajor, double, RowMajor);
BEAMID_TIMES_VECTOR(double, RowMajor, double, ColMajor);
BEAMID_TIMES_VECTOR(Complex, ColMajor, Complex, ColMajor);
BEAMID_TIMES_VECTOR(Complex, ColMajor, Complex, RowMajor);
BEAMID_TIMES_VECTOR(Complex, RowMajor, Complex, ColMajor);
BEAMID_TIMES_VECTOR(double, ColMajor, Complex, ColMajor);
BEAMID_TIMES_VECTOR(double, ColMajor, Complex, RowMajor);
BEAMID_TIMES_VECTOR(double, RowMajor, Complex, ColMajor);
BEAMID_TIMES_VECTOR(Complex, ColMajor, double, ColMajor);
BEAMID_TIMES_VECTOR(Complex, RowMajor, double, ColMajor);
#undef BEAMID_TIMES_VECTOR
BEAMID_COMPILED_EIGEN struct general_matrix_vector_product<Index, double, Rows, RowMajor, false, double, Rows,
                                                           false, 1>;

// Triangular and symmetric matrices.
#define BEAMID_TRIANGULAR_SOLUTION(SIDE, MODE, ORDER) \
  BEAMID_COMPILED_EIGEN struct triangular_solve_matrix<double, Index, SIDE, MODE, false, ORDER, ColMajor, 1>
BEAMID_TRIANGULAR_SOLUTION(OnTheLeft, Lower, ColMajor);
BEAMID_TRIANGULAR_SOLUTION(OnTheLeft, Upper, ColMajor);
BEAMID_TRIANGULAR_SOLUTION(OnTheLeft, Upper, RowMajor);
BEAMID_TRIANGULAR_SOLUTION(OnTheLeft, UnitLower, ColMajor);
BEAMID_TRIANGULAR_SOLUTION(OnTheLeft, UnitUpper, RowMajor);
BEAMID_TRIANGULAR_SOLUTION(OnTheRight, Lower, ColMajor);
BEAMID_TRIANGULAR_SOLUTION(OnTheRight, Upper, RowMajor);
BEAMID_TRIANGULAR_SOLUTION(OnTheRight, UnitLower, ColMajor);
BEAMID_TRIANGULAR_SOLUTION(OnTheRight, UnitUpper, RowMajor);
#undef BEAMID_TRIANGULAR_SOLUTION
#define BEAMID_TRIANGULAR_PRODUCT(MODE, ORDER)                                                           \
  BEAMID_COMPILED_EIGEN struct product_triangular_matrix_matrix<double, Index, MODE, true, ORDER, false, \
                                                                ColMajor, false, ColMajor, 1>
BEAMID_TRIANGULAR_PRODUCT(Lower, ColMajor);
BEAMID_TRIANGULAR_PRODUCT(Upper, RowMajor);
BEAMID_TRIANGULAR_PRODUCT(UnitLower, ColMajor);
BEAMID_TRIANGULAR_PRODUCT(UnitUpper, RowMajor);
#undef BEAMID_TRIANGULAR_PRODUCT
BEAMID_COMPILED_EIGEN struct triangular_matrix_vector_product<Index, UnitUpper, double, false, double, false,
                                                              RowMajor>;
BEAMID_COMPILED_EIGEN struct general_matrix_matrix_triangular_product<Index, double, ColMajor, false, double,
                                                                      RowMajor, false, ColMajor, 1, Lower>;
BEAMID_COMPILED_EIGEN struct selfadjoint_matrix_vector_product<double, Index, ColMajor, Lower, false, false>;

BEAMID_COMPILED_EIGEN void tridiagonalization_inplace<MatrixXd, VectorXd>(MatrixXd&, VectorXd&);
BEAMID_COMPILED_EIGEN ComputationInfo
computeFromTridiagonal_impl<MatrixXd, VectorXd, VectorXd>(VectorXd&, VectorXd&, const Index, bool, MatrixXd&);

}  // namespace internal

BEAMID_COMPILED_EIGEN class LLT<MatrixXd>;
BEAMID_COMPILED_EIGEN class LDLT<MatrixXd>;
BEAMID_COMPILED_EIGEN class PartialPivLU<MatrixXd>;
BEAMID_COMPILED_EIGEN class FullPivLU<MatrixXd>;
BEAMID_COMPILED_EIGEN class HouseholderQR<MatrixXd>;
BEAMID_COMPILED_EIGEN class ColPivHouseholderQR<MatrixXd>;
BEAMID_COMPILED_EIGEN class CompleteOrthogonalDecomposition<MatrixXd>;
BEAMID_COMPILED_EIGEN class SelfAdjointEigenSolver<MatrixXd>;
BEAMID_COMPILED_EIGEN class GeneralizedSelfAdjointEigenSolver<MatrixXd>;
BEAMID_COMPILED_EIGEN class HessenbergDecomposition<MatrixXd>;
BEAMID_COMPILED_EIGEN class RealSchur<MatrixXd>;
BEAMID_COMPILED_EIGEN class EigenSolver<MatrixXd>;
BEAMID_COMPILED_EIGEN class JacobiSVD<MatrixXd>;
BEAMID_COMPILED_EIGEN class BDCSVD<MatrixXd>;

// Members that are templates of their argument are none of those that a class brings with it.
BEAMID_COMPILED_EIGEN LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
BEAMID_COMPILED_EIGEN LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
BEAMID_COMPILED_EIGEN SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);
BEAMID_COMPILED_EIGEN RealSchur<MatrixXd>& RealSchur<MatrixXd>::compute(const EigenBase<MatrixXd>&, bool);
BEAMID_COMPILED_EIGEN RealSchur<MatrixXd>& RealSchur<MatrixXd>::computeFromHessenberg(const MatrixXd&,
                                                                                      const MatrixXd&, bool);
BEAMID_COMPILED_EIGEN EigenSolver<MatrixXd>& EigenSolver<MatrixXd>::compute(const EigenBase<MatrixXd>&, bool);

#define BEAMID_SOLUTION(CLASS, SOLVE)                                                  \
  BEAMID_COMPILED_EIGEN void CLASS<MatrixXd>::SOLVE(const MatrixXd&, MatrixXd&) const; \
  BEAMID_COMPILED_EIGEN void CLASS<MatrixXd>::SOLVE(const VectorXd&, VectorXd&) const
BEAMID_SOLUTION(LLT, _solve_impl_transposed<true>);
BEAMID_SOLUTION(LDLT, _solve_impl_transposed<true>);
BEAMID_SOLUTION(HouseholderQR, _solve_impl);
BEAMID_SOLUTION(ColPivHouseholderQR, _solve_impl);
BEAMID_SOLUTION(CompleteOrthogonalDecomposition, _solve_impl);
#undef BEAMID_SOLUTION

}  // namespace Eigen

#endif
