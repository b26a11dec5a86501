#include "experiments/modal/stochastic_subspace.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "experiments/modal/subspace_scatter.hpp"
#include "reduction/bdc_svd.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

void check_stochastic_subspace(const MatrixXd& y, double interval, Index rows, Index segments) {
  std::ostringstream message;
  if (!(interval > 0))
    message << "sampling interval " << interval << " s; expected a positive value";
  else if (!y.allFinite())
    message << "record holds a value that is not a finite number";
  else if (rows < 2)
    message << rows << " block rows; expected at least 2 (the record has " << y.cols() << " samples)";
  else if (segments < 2)
    message << segments << " segments; expected at least 2";
  else if (y.cols() < segments * 2 * rows)
    message << "record of " << y.cols() << " samples; expected at least " << segments * 2 * rows << " for "
            << segments << " segments of the " << 2 * rows << " lags of " << rows
            << " block rows (options segments, rows)";
  else if (!(y.cwiseAbs().rowwise().maxCoeff().minCoeff() > 0))
    message << "record holds a channel of zeros";
  if (const std::string text = message.str(); !text.empty()) throw std::invalid_argument(text);
}

/// R_1 ... R_lags (p x p lags) from the instants [begin, end) of the earlier factor.
MatrixXd correlations(const MatrixXd& y, Index begin, Index end, Index lags) {
  const Index p = y.rows();
  MatrixXd result(p, p * lags);
  for (Index k = 1; k <= lags; ++k) {
    const Index count = std::min(end, y.cols() - k) - begin;
    result.middleCols((k - 1) * p, p) =
        y.middleCols(begin + k, count) * y.middleCols(begin, count).transpose() / static_cast<double>(count);
  }
  return result;
}

/// q + 1 by q blocks R_(i+j-1).
MatrixXd hankel_of(const MatrixXd& correlations, Index rows) {
  const Index p = correlations.rows();
  MatrixXd hankel((rows + 1) * p, rows * p);
  for (Index i = 0; i <= rows; ++i) hankel.middleRows(i * p, p) = correlations.middleCols(i * p, rows * p);
  return hankel;
}

}  // namespace

StochasticSubspace stochastic_subspace(const MatrixXd& outputs, double interval, int largest_order,
                                       const StochasticSettings& settings) {
  const Index p = outputs.rows(), count = outputs.cols(), segments = settings.segments;
  constexpr Index most_rows = 100;
  const Index rows = settings.rows > 0 ? settings.rows
                                       : std::min(most_rows / std::max<Index>(p, 1),
                                                  count / (2 * std::max<Index>(segments, 1)));
  check_stochastic_subspace(outputs, interval, rows, segments);
  const MatrixXd y = outputs.colwise() - outputs.rowwise().mean();
  std::vector<MatrixXd> parts;
  MatrixXd mean = MatrixXd::Zero(p, 2 * rows * p);
  for (Index j = 0; j < segments; ++j) {
    parts.push_back(correlations(y, j * count / segments, (j + 1) * count / segments, 2 * rows));
    mean += parts.back() / static_cast<double>(segments);
  }
  const Eigen::BDCSVD<MatrixXd> svd(hankel_of(mean, rows), Eigen::ComputeFullU | Eigen::ComputeFullV);

  ScatteredHankel hankel;
  const Index size = (rows + 1) * p;
  hankel.outputs = p;
  hankel.left = svd.matrixU();
  hankel.singular_values = VectorXd::Zero(size);
  hankel.singular_values.head(rows * p) = svd.singularValues();
  const double scale = std::sqrt(static_cast<double>(segments * (segments - 1)));
  for (const MatrixXd& part : parts) {
    MatrixXd change = MatrixXd::Zero(size, size);
    change.leftCols(rows * p) =
        svd.matrixU().transpose() * hankel_of((part - mean) / scale, rows) * svd.matrixV();
    hankel.changes.push_back(std::move(change));
  }

  StochasticSubspace found;
  found.singular_values = svd.singularValues();
  found.autocorrelations.resize(p, 2 * rows);
  for (Index k = 0; k < 2 * rows; ++k) found.autocorrelations.col(k) = mean.middleCols(k * p, p).diagonal();
  for (int order = 2; order <= std::min<Index>(largest_order, rows * p); order += 2)
    found.orders.push_back({order, scattered_poles(hankel, order, interval)});
  return found;
}

}  // namespace beamid::experiments
