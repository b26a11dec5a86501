#include "experiments/modal/subspace_realisation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "experiments/modal/joint_decay_fit.hpp"
#include "experiments/modal/poles.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

namespace {

/// By the parts of waves e^(rate (t - t_m)). @param wave of a mode (N) @param origins t_m (n)
ShapeFit fitted_shapes(const MatrixXd& outputs, const std::function<VectorXcd(Index m)>& wave,
                       const VectorXd& origins, const std::vector<Complex>& rates,
                       const std::vector<bool>& oscillating) {
  const Index count = outputs.cols(), modes = static_cast<Index>(rates.size());
  MatrixXd basis(count, 2 * modes);
  Index columns = 0;
  for (Index m = 0; m < modes; ++m) {
    const VectorXcd values = wave(m);
    basis.col(columns++) = values.real();
    if (oscillating[m]) basis.col(columns++) = -values.imag();
  }
  basis.conservativeResize(Eigen::NoChange, columns);
  const MatrixXd parts = least_squares(basis, outputs.transpose());  // (columns x p)

  ShapeFit fit;
  fit.shapes.resize(outputs.rows(), modes);
  for (Index m = 0, at = 0; m < modes; ++m) {
    Eigen::VectorXcd shape = parts.row(at++).transpose().cast<Complex>();
    if (oscillating[m]) shape += Complex(0, 1) * parts.row(at++).transpose().cast<Complex>();
    fit.shapes.col(m) = shape * std::exp(-rates[m] * origins[m]);
  }
  fit.reconstruction = (basis * parts).transpose();
  const auto freedom = static_cast<double>(std::max<Index>(1, count - 2 * columns));
  fit.residual_standard_deviation =
      ((outputs - fit.reconstruction).rowwise().squaredNorm() / freedom).cwiseSqrt();
  return fit;
}

/// Waves that grow are one at the end (n) [s].
VectorXd origins_of(const std::vector<Complex>& rates, double end) {
  VectorXd origins(static_cast<Index>(rates.size()));
  for (Index m = 0; m < origins.size(); ++m) origins[m] = rates[m].real() > 0 ? end : 0.0;
  return origins;
}

}  // namespace

ShapeFit fit_shapes_at(const MatrixXd& outputs, const VectorXd& time, const std::vector<Complex>& rates,
                       const std::vector<bool>& oscillating) {
  const VectorXd origins = origins_of(rates, time[time.size() - 1]);
  const auto wave = [&](Index m) -> VectorXcd { return (rates[m] * (time.array() - origins[m])).exp(); };
  return fitted_shapes(outputs, wave, origins, rates, oscillating);
}

ShapeFit fit_shapes(const MatrixXd& outputs, double interval, const std::vector<Complex>& rates,
                    const std::vector<bool>& oscillating) {
  const Index count = outputs.cols();
  const VectorXd origins = origins_of(rates, interval * static_cast<double>(count - 1));
  const auto wave = [&](Index m) -> VectorXcd {
    if (origins[m] > 0.0) return decaying_wave(-rates[m], interval, count).reverse();
    return decaying_wave(rates[m], interval, count);
  };
  return fitted_shapes(outputs, wave, origins, rates, oscillating);
}

namespace {

using Complex = std::complex<double>;

constexpr double gram_floor = 1e-7;      // of the largest singular value: what squaring them leaves
constexpr double vanishing_pole = 1e-6;  // poles z that are over within a sample

void check_realisation(const MatrixXd& outputs, double interval, const EigensystemSettings& settings,
                       Index rows) {
  const Index p = outputs.rows(), count = outputs.cols();
  std::ostringstream message;
  if (!(interval > 0))
    message << "sampling interval " << interval << " s; expected a positive value";
  else if (p < 1 || count < 12)
    message << "free decay of " << p << " outputs and " << count << " samples; expected at least 1 and 12";
  else if (!outputs.allFinite())
    message << "free decay holds a value that is not a finite number";
  else if (rows < 2 || 2 * rows > count)
    message << rows << " block rows; expected 2 to " << count / 2 << ", half of the " << count << " samples";
  else if (settings.order < 0 || settings.order > rows * p)
    message << "order " << settings.order << "; expected 0 (automatic) to " << rows * p;
  else if (const double largest = outputs.cwiseAbs().maxCoeff(); largest == 0)
    message << "free decay of zeros only has no modes";
  else if (!(largest > 1e-100 && largest < 1e100))  // products of outputs must neither vanish nor overflow
    message << "free decay with values up to " << largest << "; expected between 1e-100 and 1e100";
  if (const std::string text = message.str(); !text.empty()) throw std::invalid_argument(text);
}

/// H H^T of the block Hankel matrix with `rows` block rows, each block from the one up left of it.
MatrixXd hankel_gram(const MatrixXd& y, Index rows) {
  const Index p = y.rows(), columns = y.cols() - rows + 1;
  MatrixXd gram(rows * p, rows * p);
  for (Index j = 0; j < rows; ++j)
    gram.block(0, j * p, p, p) = y.leftCols(columns) * y.middleCols(j, columns).transpose();
  for (Index i = 0; i + 1 < rows; ++i)
    for (Index j = i; j + 1 < rows; ++j)
      gram.block((i + 1) * p, (j + 1) * p, p, p) = gram.block(i * p, j * p, p, p) -
                                                   y.col(i) * y.col(j).transpose() +
                                                   y.col(i + columns) * y.col(j + columns).transpose();
  gram.triangularView<Eigen::StrictlyLower>() = gram.transpose();
  return gram;
}

int order_above_noise(const VectorXd& singular_values, const EigensystemSettings& settings) {
  const double median = singular_values[singular_values.size() / 2];
  const double floor = std::max(settings.noise_factor * median, gram_floor * singular_values[0]);
  const auto above = (singular_values.array() > floor).count();
  return std::clamp(static_cast<int>(above), 1, settings.largest_order);
}

/// Singular values of H(0), falling, and left singular vectors, in the opposite order.
struct Decomposition {
  VectorXd singular_values;
  MatrixXd left;
  MatrixXd shifted;  ///< H(1) H(0)^T
};

Decomposition decompose(const MatrixXd& gram, Index p) {
  const Index size = gram.rows() - p;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(gram.topLeftCorner(size, size));
  return {solver.eigenvalues().reverse().cwiseMax(0).cwiseSqrt(), solver.eigenvectors(),
          gram.bottomLeftCorner(size, size)};
}

/// Eigenvalues of A, one of each complex pair.
std::vector<Complex> discrete_poles(const Decomposition& cut, int n) {
  const MatrixXd left = cut.left.rightCols(n);
  const VectorXd root = cut.singular_values.head(n)
                            .cwiseMax(1e-12 * cut.singular_values[0])
                            .reverse()
                            .cwiseSqrt();  // S^(1/2), S rising as the solver sorts them
  const MatrixXd transition = root.cwiseInverse().asDiagonal() * (left.transpose() * cut.shifted * left) *
                              root.array().pow(-3).matrix().asDiagonal();
  const Eigen::VectorXcd eigenvalues = transition.eigenvalues();
  std::vector<Complex> poles;
  for (const Complex& z : eigenvalues)
    if (z.imag() >= 0 && std::abs(z) > vanishing_pole) poles.push_back(z);
  return poles;
}

IdentifiedMode mode_of(Complex pole, double interval) {
  IdentifiedMode mode;
  mode.rate = std::log(pole) / interval;
  const bool oscillates = pole.imag() > 0;
  mode.frequency_hz = oscillates ? std::abs(mode.rate) / (2 * std::numbers::pi) : 0;
  mode.damping_ratio = std::abs(mode.rate) > 0 ? -mode.rate.real() / std::abs(mode.rate) : 0;
  mode.spurious = !oscillates || mode.damping_ratio < 0;
  return mode;
}

/// Least-squares shapes of all modes, and what they leave.
void add_shapes(const MatrixXd& outputs, double interval, EigensystemRealisation& result) {
  std::vector<Complex> rates;
  std::vector<bool> oscillating;
  for (const IdentifiedMode& mode : result.modes) {
    rates.push_back(mode.rate);
    oscillating.push_back(mode.frequency_hz > 0);
  }
  const ShapeFit fit = fit_shapes(outputs, interval, rates, oscillating);
  for (std::size_t m = 0; m < rates.size(); ++m)
    result.modes[m].shape = fit.shapes.col(static_cast<Index>(m));
  result.reconstruction = fit.reconstruction;
  result.residual_standard_deviation = fit.residual_standard_deviation;
}

void mark_spurious(std::vector<IdentifiedMode>& modes, const EigensystemSettings& settings) {
  double strongest = 0;
  for (IdentifiedMode& mode : modes) {
    mode.spurious = mode.spurious || mode.damping_ratio > settings.largest_damping_ratio;
    if (!mode.spurious) strongest = std::max(strongest, mode.shape.norm());
  }
  for (IdentifiedMode& mode : modes)
    mode.spurious = mode.spurious || mode.shape.norm() < settings.smallest_amplitude * strongest;
}

Index block_rows(const MatrixXd& outputs, const EigensystemSettings& settings) {
  constexpr Index most_rows = 200;
  if (settings.rows > 0) return settings.rows;
  return std::min(outputs.cols() / 3, most_rows / std::max<Index>(outputs.rows(), 1));
}

EigensystemRealisation realise(const MatrixXd& outputs, double interval, const Decomposition& cut, int order,
                               const EigensystemSettings& settings) {
  EigensystemRealisation result;
  result.order = order;
  result.singular_values = cut.singular_values;
  for (const Complex& pole : discrete_poles(cut, order)) result.modes.push_back(mode_of(pole, interval));
  std::sort(result.modes.begin(), result.modes.end(),
            [](const auto& a, const auto& b) { return a.frequency_hz < b.frequency_hz; });
  add_shapes(outputs, interval, result);
  mark_spurious(result.modes, settings);
  return result;
}

}  // namespace

EigensystemRealisation eigensystem_realisation(const MatrixXd& outputs, double interval,
                                               const EigensystemSettings& settings) {
  const Index rows = block_rows(outputs, settings);
  check_realisation(outputs, interval, settings, rows);
  const Decomposition cut = decompose(hankel_gram(outputs, rows + 1), outputs.rows());
  const int order = settings.order > 0 ? settings.order : order_above_noise(cut.singular_values, settings);
  return realise(outputs, interval, cut, order, settings);
}

std::vector<EigensystemRealisation> eigensystem_realisations(const MatrixXd& outputs, double interval,
                                                             int largest_order,
                                                             const EigensystemSettings& settings) {
  const Index rows = block_rows(outputs, settings);
  EigensystemSettings any_order = settings;
  any_order.order = 0;
  check_realisation(outputs, interval, any_order, rows);
  const Decomposition cut = decompose(hankel_gram(outputs, rows + 1), outputs.rows());
  std::vector<EigensystemRealisation> found;
  for (int order = 2; order <= std::min<Index>(largest_order, rows * outputs.rows()); order += 2) {
    found.push_back(realise(outputs, interval, cut, order, settings));
    found.back().reconstruction.resize(0, 0);
  }
  return found;
}

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

/// Poles of order n and their standard deviations by first-order propagation (subspace_realisation.hpp).
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
