#include "experiments/modal/stochastic_subspace.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "experiments/modal/poles.hpp"
#include "reduction/bdc_svd.hpp"

namespace beamid::experiments {
namespace {

// How the scatter of a Hankel matrix becomes that of poles and shapes.

/// H = U S V^T (a x b, a >= b) in full, and how it scatters.
struct ScatteredHankel {
  Eigen::MatrixXd left;             ///< U (a x a)
  Eigen::VectorXd singular_values;  ///< (a), the last a - b of them zero
  /// E_j = U^T dH_j V, padded by zeros to (a x a); cov(vec H) = sum_j vec(dH_j) vec(dH_j)^T.
  std::vector<Eigen::MatrixXd> changes;
  Eigen::Index outputs = 1;  ///< p rows to a block
};

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

constexpr double vanishing_pole_scatter = 1e-6;  // poles z that are over within a sample

/// W of dU_n = U_rest W.
MatrixXd turned(const ScatteredHankel& hankel, const MatrixXd& change, Index n) {
  const Index rest = hankel.left.cols() - n;
  const VectorXd& s = hankel.singular_values;
  MatrixXd turn(rest, n);
  for (Index i = 0; i < n; ++i)
    for (Index k = 0; k < rest; ++k)
      turn(k, i) = (s[i] * change(n + k, i) + s[n + k] * change(i, n + k)) /
                   std::max(s[i] * s[i] - s[n + k] * s[n + k], 1e-300);
  return turn;
}

/// The realisation of one order, and all that its derivatives need.
struct Realisation {
  Index p, n, shift;
  MatrixXd gram_inverse, inverse, remainder, rest;  ///< (O_up^T O_up)^-1, O_up^+, O_down - O_up A, U_rest
  MatrixXcd vectors, inverse_vectors;
  VectorXcd poles;
  MatrixXcd shapes;  ///< C phi (p x n)
};

Realisation realise(const ScatteredHankel& hankel, Index n) {
  Realisation r;
  const Index a = hankel.left.rows();
  r.p = hankel.outputs;
  r.n = n;
  r.shift = a - r.p;
  const MatrixXd subspace = hankel.left.leftCols(n);
  const MatrixXd up = subspace.topRows(r.shift), down = subspace.bottomRows(r.shift);
  r.gram_inverse = (up.transpose() * up).inverse();
  r.inverse = r.gram_inverse * up.transpose();
  const MatrixXd transition = r.inverse * down;
  r.remainder = down - up * transition;
  r.rest = hankel.left.rightCols(a - n);
  const Eigen::EigenSolver<MatrixXd> solver(transition);
  r.poles = solver.eigenvalues();
  r.vectors = solver.eigenvectors();
  r.inverse_vectors = r.vectors.inverse();
  r.shapes = subspace.topRows(r.p) * r.vectors;
  return r;
}

struct SubspaceChange {
  Complex pole;
  VectorXcd shape;
};

/// First-order change of pole i and its shape when U_n moves by U_rest turn.
SubspaceChange change_of(const Realisation& r, Index i, const MatrixXd& turn) {
  const VectorXcd vector = r.vectors.col(i);
  const VectorXcd moved = r.rest * (turn * vector);  // dU_n phi
  const VectorXcd left = r.rest.topRows(r.shift).transpose() * (r.remainder * vector);
  const VectorXcd transition = r.inverse * (moved.tail(r.shift) - r.poles[i] * moved.head(r.shift)) +
                               r.gram_inverse * (turn.transpose() * left);  // dA phi
  const VectorXcd parts = r.inverse_vectors * transition;
  SubspaceChange change{parts[i], moved.head(r.p)};
  for (Index m = 0; m < r.n; ++m)
    if (m != i) change.shape += r.shapes.col(m) * (parts[m] / (r.poles[i] - r.poles[m]));
  return change;
}

/// Poles of order n and their standard deviations by first-order propagation (stochastic_subspace.hpp).
std::vector<Pole> scattered_poles(const ScatteredHankel& hankel, int order, double interval) {
  const Realisation r = realise(hankel, order);
  std::vector<MatrixXd> turns;
  for (const MatrixXd& change : hankel.changes) turns.push_back(turned(hankel, change, order));
  std::vector<Pole> found;
  for (Index i = 0; i < r.n; ++i) {
    const Complex z = r.poles[i];
    if (!(z.imag() > 0 && std::abs(z) > vanishing_pole_scatter)) continue;
    Pole pole{std::log(z) / interval, r.shapes.col(i)};
    Index largest = 0;
    pole.shape.cwiseAbs().maxCoeff(&largest);
    const Complex scale = pole.shape[largest];
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    VectorXd shape_variance = VectorXd::Zero(r.p);
    for (const MatrixXd& turn : turns) {
      const SubspaceChange change = change_of(r, i, turn);
      const Complex rate = change.pole / (z * interval);
      const Eigen::Vector2d both(rate.imag(), -rate.real());
      covariance += both * both.transpose();
      const VectorXcd scaled = pole.shape / scale,
                      moved = (change.shape - scaled * change.shape[largest]) / scale;
      for (Index c = 0; c < r.p; ++c)
        if (const double size = std::abs(scaled[c]); size > 0)
          shape_variance[c] += std::pow((std::conj(scaled[c]) * moved[c]).real() / size, 2);
    }
    pole.shape /= scale;
    if (!turns.empty()) {
      pole.take_deviations(covariance);
      pole.shape_deviation = shape_variance.cwiseSqrt();
    }
    found.push_back(std::move(pole));
  }
  std::sort(found.begin(), found.end(),
            [](const Pole& a, const Pole& b) { return std::abs(a.rate) < std::abs(b.rate); });
  return found;
}

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
