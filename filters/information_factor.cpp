#include "filters/information_factor.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>
#include <string>

namespace beamid::filters {

using Eigen::Index, Eigen::MatrixXd;

InformationFactor::InformationFactor(Index unknowns) : rows_(MatrixXd::Zero(unknowns + block_, unknowns)) {
  if (unknowns < 1)
    throw std::invalid_argument("information about " + std::to_string(unknowns) +
                                " unknowns; expected at least 1");
}

void InformationFactor::add(const MatrixXd& whitened) {
  if (whitened.cols() != unknowns())
    throw std::invalid_argument("sensitivities to " + std::to_string(whitened.cols()) +
                                " unknowns; expected " + std::to_string(unknowns()));
  if (!whitened.allFinite()) throw std::invalid_argument("sensitivities must be finite");
  for (Index first = 0; first < whitened.rows();) {
    if (used_ == rows_.rows()) {
      rows_.topRows(unknowns()) = root();
      used_ = unknowns();
    }
    const Index count = std::min(whitened.rows() - first, rows_.rows() - used_);
    rows_.middleRows(used_, count) = whitened.middleRows(first, count);
    used_ += count;
    first += count;
  }
}

MatrixXd InformationFactor::root() const {
  const Index r = unknowns();
  MatrixXd result = MatrixXd::Zero(r, r);
  if (used_ == 0) return result;
  const Eigen::HouseholderQR<MatrixXd> qr(rows_.topRows(used_));
  const Index rank = std::min(used_, r);
  result.topRows(rank) = qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>();
  return result;
}

MatrixXd InformationFactor::information() const {
  const MatrixXd u = root();
  MatrixXd result = MatrixXd::Zero(u.cols(), u.cols());
  result.selfadjointView<Eigen::Lower>().rankUpdate(u.transpose());
  result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
  return result;
}

InformationFactor InformationFactor::without(const std::vector<Index>& nuisances) const {
  const Index r = unknowns();
  std::vector<bool> eliminated(static_cast<std::size_t>(r), false);
  for (const Index i : nuisances) {
    if (i < 0 || i >= r)
      throw std::invalid_argument("unknown " + std::to_string(i) + " does not exist; expected 0 to " +
                                  std::to_string(r - 1));
    eliminated[static_cast<std::size_t>(i)] = true;
  }
  std::vector<Index> kept, gone;
  for (Index i = 0; i < r; ++i) (eliminated[static_cast<std::size_t>(i)] ? gone : kept).push_back(i);
  if (kept.empty()) throw std::invalid_argument("all unknowns are to be eliminated; expected one to remain");
  if (gone.empty()) return *this;

  // What lies in the span of the nuisances' columns could be their doing; the rest is information.
  const MatrixXd u = root();
  MatrixXd span = u(Eigen::all, gone);
  for (auto column : span.colwise())
    if (const double size = column.norm(); size > 0.0) column /= size;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(span);
  const MatrixXd turned = qr.householderQ().transpose() * MatrixXd(u(Eigen::all, kept));
  InformationFactor result(static_cast<Index>(kept.size()));
  result.add(turned.bottomRows(r - qr.rank()));
  return result;
}

}  // namespace beamid::filters
