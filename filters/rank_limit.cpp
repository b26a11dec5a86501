#include "filters/rank_limit.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

// Lower triangle (n x n) of the same L L^T as a factor with more columns than rows.
MatrixXd triangle(const MatrixXd& factor) {
  const Index n = factor.rows();
  const MatrixXd turned = factor.transpose();
  const Eigen::HouseholderQR<MatrixXd> qr(turned);
  return MatrixXd(qr.matrixQR().topRows(n).triangularView<Eigen::Upper>()).transpose();
}

}  // namespace

RankLimit::RankLimit(double rank, const std::string& owner) : asked_(0) {
  if (!(rank >= 0.0 && rank <= 1e6) || rank != std::floor(rank))
    throw std::invalid_argument(owner + ": rank is " + std::to_string(rank) +
                                "; expected a whole number from 0");
  asked_ = static_cast<Index>(rank);
}

void RankLimit::start(MatrixXd& factor) {
  constexpr Index small = 64;
  const Index n = factor.rows();
  rank_ = asked_ > 0 ? asked_ : n <= small ? n : factor.cols();
  steps_ = 0;
  largest_share_ = dropped_ = 0.0;
  (*this)(factor);
}

void RankLimit::operator()(MatrixXd& factor) {
  if (factor.rows() <= rank_ && factor.cols() > factor.rows())
    factor = triangle(factor);
  else if (factor.cols() > rank_)
    cut(factor);
}

void RankLimit::cut(MatrixXd& factor) {
  deviation_ = factor.rowwise().norm();
  const VectorXd inverse = (deviation_.array() > 0.0).select(deviation_.cwiseInverse(), 0.0);
  scaled_ = inverse.asDiagonal() * factor;
  // V is the same for the triangle of the scaled factor, of as many rows as it has columns.
  const Index columns = factor.cols(), rows = std::min(columns, factor.rows());
  const Eigen::HouseholderQR<MatrixXd> qr(scaled_);
  const MatrixXd triangle = qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
  const Eigen::JacobiSVD<MatrixXd> svd(triangle, Eigen::ComputeFullV);
  const MatrixXd lost = scaled_ * svd.matrixV().rightCols(columns - rank_);
  factor = factor * svd.matrixV().leftCols(rank_);
  largest_share_ = std::max(largest_share_, lost.rowwise().squaredNorm().maxCoeff());
  dropped_ += lost.squaredNorm() / std::max(1.0, static_cast<double>((deviation_.array() > 0.0).count()));
  ++steps_;
}

std::vector<std::string> RankLimit::remarks() const {
  if (!(largest_share_ > 1e-14)) return {};
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the covariance was cut back to rank %lld in %lld steps: at most %.2g %% of an entry's variance "
      "in one step, %.2g %% of all in sum",
      static_cast<long long>(rank_), static_cast<long long>(steps_), 100.0 * largest_share_,
      100.0 * dropped_);
  return {text};
}

}  // namespace beamid::filters
