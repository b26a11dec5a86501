#include "experiments/modal/joint_decay_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>

#include "experiments/signal/toolbox.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

Eigen::VectorXcd decaying_wave(Complex rate, double interval, Index count) {
  constexpr Index span = 64;
  constexpr double over = 700.0;  // e^-700, next to what underflows, and takes long to do so
  Eigen::VectorXcd wave = Eigen::VectorXcd::Zero(count);
  if (const double last = -over / (rate.real() * interval); last >= 0.0 && last < static_cast<double>(count))
    count = static_cast<Index>(last) + 1;
  const Index first = std::min(span, count);
  for (Index k = 0; k < first; ++k) wave[k] = std::exp(rate * (interval * static_cast<double>(k)));
  for (Index begin = span; begin < count; begin += span) {
    const Complex turn = std::exp(rate * (interval * static_cast<double>(begin)));
    const double re = turn.real(), im = turn.imag();
    const Index samples = std::min(span, count - begin);
    for (Index k = 0; k < samples; ++k) {  // by parts: the product of the library looks for infinities
      const double a = wave[k].real(), b = wave[k].imag();
      wave[begin + k] = {re * a - im * b, re * b + im * a};
    }
  }
  return wave;
}

namespace {

void check_joint_decay_fit(const MatrixXd& outputs, double interval, const std::vector<Complex>& start) {
  const std::size_t fewest = 2 * (4 * start.size() + 1);
  const bool oscillating = std::all_of(start.begin(), start.end(), [](Complex rate) {
    return rate.imag() > 0 && std::isfinite(rate.imag()) && std::isfinite(rate.real());
  });
  if (!start.empty() && oscillating && interval > 0 && outputs.allFinite() && outputs.rows() > 0 &&
      static_cast<std::size_t>(outputs.cols()) >= fewest)
    return;
  std::ostringstream message;
  message << "fit of " << start.size() << " damped sines to " << outputs.rows() << " channels of "
          << outputs.cols() << " samples; expected at least " << fewest
          << " finite samples and one or more rates of positive angular frequency";
  throw std::invalid_argument(message.str());
}

/// A mode's two numbers (w, d) as the rate -d + i w.
Complex rate_at(const VectorXd& rates, Index m) {
  return {-rates[2 * m + 1], rates[2 * m]};
}

/// The problem at given rates, with the best amplitudes. Slopes are those of a channel's motion to the rates
/// (w, d of each mode), without what amplitudes can follow.
struct JointLinearisation {
  MatrixXd parts;                    ///< (2K+1 x p) amplitudes (Re, Im) and offset
  MatrixXd residuals;                ///< (N x p)
  MatrixXd range;                    ///< Q (N x 2K+1)
  MatrixXd slopes;                   ///< P T (N x 2K)
  std::vector<MatrixXd> amplitudes;  ///< W of each channel (2K x 2K)
  std::vector<MatrixXd> squares;     ///< of each channel's slopes S: S^T S (2K x 2K)
  std::vector<VectorXd> moments;     ///< S^T r (2K)
  VectorXd variances;                ///< (p)
  MatrixXd normal;                   ///< sum of S^T S, every channel in units of its noise (2K x 2K)
  MatrixXd hessian;                  ///< second derivatives of misfit / 2, the residual's curvature included
  VectorXd gradient;                 ///< -d (misfit / 2)
  double misfit = 0;                 ///< minus twice the logarithm of the likelihood, and a constant
};

/// ((Im, Re), (Re, -Im)) of z: what is linear in z times a rate has these derivatives by the rate's (w, d)
/// and by the parts of the other factor.
Eigen::Matrix2d mirrored(Complex z) {
  return Eigen::Matrix2d{{z.imag(), z.real()}, {z.real(), -z.imag()}};
}

/// Of the rates alone, amplitudes eliminated by variable projection [golub1973]: r = P y, P without the basis
/// B = Q R of all waves and a constant. Of the squares |r|^2 / 2 the second derivatives are
///
///     S^T S - E + W^T T^T Q C^T + C Q^T T W - C C^T,   C = D R^-1,
///
/// T the waves times -t, S = P T W, W the amplitudes, D the sums of t r e^(rate t), E those of t^2 r e^(rate
/// t) times the amplitudes. Without D and E they are those of Gauss and Newton, too small in the direction of
/// a mode as weak as the noise.
JointLinearisation linearise(const MatrixXd& y, double interval, const VectorXd& rates) {
  const Index count = y.rows(), modes = rates.size() / 2;
  const VectorXd time = interval * VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  MatrixXd basis(count, 2 * modes + 1), slopes(count, 2 * modes);
  for (Index m = 0; m < modes; ++m) {
    const Eigen::VectorXcd wave = decaying_wave(rate_at(rates, m), interval, count);
    basis.col(2 * m) = wave.real();
    basis.col(2 * m + 1) = -wave.imag();
    slopes.col(2 * m) = -time.cwiseProduct(wave.real());
    slopes.col(2 * m + 1) = -time.cwiseProduct(wave.imag());
  }
  basis.col(2 * modes).setOnes();
  const Eigen::HouseholderQR<MatrixXd> qr(basis);
  JointLinearisation at;
  at.range = qr.householderQ() * MatrixXd::Identity(count, basis.cols());
  const auto triangle = qr.matrixQR().topRows(basis.cols()).triangularView<Eigen::Upper>();
  const MatrixXd projected = at.range.transpose() * y;
  at.amplitudes.assign(static_cast<std::size_t>(y.cols()), MatrixXd::Zero(2 * modes, 2 * modes));
  at.parts = triangle.solve(projected);
  at.residuals = y - at.range * projected;
  const MatrixXd first = slopes.transpose() * at.residuals;
  const MatrixXd second = slopes.transpose() * time.asDiagonal() * at.residuals;
  const MatrixXd followed = at.range.transpose() * slopes;
  slopes.noalias() -= at.range * followed;
  const MatrixXd squares = slopes.transpose() * slopes;
  const VectorXd floor = 1e-26 * y.colwise().squaredNorm().transpose().cwiseMax(1e-280);
  at.variances =
      at.residuals.colwise().squaredNorm().transpose().cwiseMax(floor) / static_cast<double>(count);
  at.misfit = static_cast<double>(count) * at.variances.array().log().sum();
  at.hessian = at.normal = MatrixXd::Zero(2 * modes, 2 * modes);
  at.gradient = VectorXd::Zero(2 * modes);
  for (Index c = 0; c < y.cols(); ++c) {
    MatrixXd& amplitudes = at.amplitudes[static_cast<std::size_t>(c)];
    MatrixXd bent = MatrixXd::Zero(2 * modes, 2 * modes), mixed = MatrixXd::Zero(2 * modes, 2 * modes + 1);
    for (Index m = 0; m < modes; ++m) {
      const Complex amplitude(at.parts(2 * m, c), at.parts(2 * m + 1, c));
      amplitudes.block<2, 2>(2 * m, 2 * m) = mirrored(amplitude);
      mixed.block<2, 2>(2 * m, 2 * m) = mirrored({first(2 * m, c), first(2 * m + 1, c)});
      bent.block<2, 2>(2 * m, 2 * m) =
          mirrored(Complex(0, 1) * amplitude * Complex(second(2 * m, c), second(2 * m + 1, c)));
    }
    const MatrixXd over = triangle.transpose().solve(mixed.transpose()).transpose();  // C (2K x 2K+1)
    const MatrixXd cross = amplitudes.transpose() * followed.transpose() * over.transpose();
    at.squares.push_back(amplitudes.transpose() * squares * amplitudes);
    at.moments.push_back(amplitudes.transpose() * first.col(c));
    const double variance = at.variances[c];
    at.normal += at.squares.back() / variance;
    at.hessian += (at.squares.back() - bent + cross + cross.transpose() - over * over.transpose()) / variance;
    at.hessian -= 2.0 / (static_cast<double>(count) * variance * variance) * at.moments.back() *
                  at.moments.back().transpose();
    at.gradient += at.moments.back() / variance;
  }
  at.slopes = std::move(slopes);
  return at;
}

/// What multiplies a rate by a factor, of (w, d).
Eigen::Matrix2d times(Complex factor) {
  return Eigen::Matrix2d{{factor.real(), -factor.imag()}, {factor.imag(), factor.real()}};
}

/// Modes less than two lines apart, each the other's nearest: what they span depends on the mean c and the
/// square q of half the difference of their rates, c + q^(1/2) and c - q^(1/2), not on its
/// sign: along the rates themselves the valley of the misfit is bent.
std::vector<std::pair<Index, Index>> close_pairs(const VectorXd& rates, double duration) {
  constexpr double lines = 2.0;
  const Index modes = rates.size() / 2;
  const auto nearest = [&](Index m) {
    Index best = -1;
    double least = lines * 2.0 * std::numbers::pi / duration;
    for (Index k = 0; k < modes; ++k)
      if (const double apart = std::abs(rate_at(rates, k) - rate_at(rates, m));
          k != m && apart > 0.0 && apart < least)
        best = k, least = apart;
    return best;
  };
  std::vector<std::pair<Index, Index>> pairs;
  for (Index m = 0; m < modes; ++m)
    if (const Index k = nearest(m); k > m && nearest(k) == m) pairs.emplace_back(m, k);
  return pairs;
}

/// Newton's problem along the rates, and along c and q (in the places of the first and the second) of pairs.
class RateDescent {
 public:
  RateDescent(const JointLinearisation& at, const VectorXd& rates, double duration)
      : rates_(rates),
        pairs_(close_pairs(rates, duration)),
        normal_(at.normal),
        hessian_(at.hessian),
        gradient_(at.gradient) {
    MatrixXd chain = MatrixXd::Identity(rates.size(), rates.size()),
             bent = MatrixXd::Zero(rates.size(), rates.size());
    for (const auto& [a, b] : pairs_) {
      const Complex half = 0.5 * (rate_at(rates, a) - rate_at(rates, b)), slope = 0.5 / half;
      chain.block<2, 2>(2 * a, 2 * b) = times(slope);
      chain.block<2, 2>(2 * b, 2 * a).setIdentity();
      chain.block<2, 2>(2 * b, 2 * b) = times(-slope);
      // Re(curvature dq^2) / 2 is what the bend of the rates adds to misfit / 2.
      const Eigen::Vector2d apart = gradient_.segment<2>(2 * a) - gradient_.segment<2>(2 * b);
      const Complex curvature = -Complex(apart[1], apart[0]) / (4.0 * half * half * half);
      bent.block<2, 2>(2 * b, 2 * b) = mirrored(Complex(0, -1) * curvature);
    }
    normal_ = (chain.transpose() * normal_ * chain).eval();
    hessian_ = (chain.transpose() * hessian_ * chain + bent).eval();
    gradient_ = (chain.transpose() * gradient_).eval();
  }

  /// A step that descends: curvatures, in units of the Gauss-Newton ones, count by their size, and a damping
  /// is added to them [greenstadt1967].
  VectorXd step(double damping) const {
    constexpr double least = 1e-9;
    const VectorXd scale = normal_.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> curvatures(scale.asDiagonal() * hessian_ *
                                                             scale.asDiagonal());
    const VectorXd size = curvatures.eigenvalues().cwiseAbs().cwiseMax(least).array() + damping;
    const MatrixXd& axes = curvatures.eigenvectors();
    return scale.cwiseProduct(axes * (axes.transpose() * scale.cwiseProduct(gradient_)).cwiseQuotient(size));
  }

  /// The rates behind a step.
  VectorXd rates_after(const VectorXd& step) const {
    VectorXd rates = rates_ + step;
    for (const auto& [a, b] : pairs_) {
      const Complex half = 0.5 * (rate_at(rates_, a) - rate_at(rates_, b)),
                    mean = 0.5 * (rate_at(rates_, a) + rate_at(rates_, b)) + rate_at(step, a);
      Complex root = std::sqrt(half * half + rate_at(step, b));
      if ((root * std::conj(half)).real() < 0.0) root = -root;
      const Complex first = mean + root, second = mean - root;
      rates.segment<2>(2 * a) << first.imag(), -first.real();
      rates.segment<2>(2 * b) << second.imag(), -second.real();
    }
    return rates;
  }

  double fall(const VectorXd& step) const { return 2.0 * gradient_.dot(step) - step.dot(hessian_ * step); }
  double length(const VectorXd& step) const { return std::sqrt(std::max(0.0, step.dot(normal_ * step))); }

 private:
  VectorXd rates_;
  std::vector<std::pair<Index, Index>> pairs_;
  MatrixXd normal_, hessian_;
  VectorXd gradient_;
};

MatrixXd inverse_of(const MatrixXd& normal) {
  return normal.ldlt().solve(MatrixXd::Identity(normal.rows(), normal.cols()));
}

/// 17 lines of a record of `count` samples around the angle `turn` of one sample, under a Hann window: real
/// and imaginary parts in turn, of the samples from `begin` on (samples x 34).
MatrixXd hann_lines(Index begin, Index samples, Index count, double turn) {
  constexpr Index bins = 8, lines = 2 * bins + 1;
  const double line = 2.0 * std::numbers::pi / static_cast<double>(count);
  MatrixXd waves(samples, 2 * lines);
  for (Index k = 0; k < samples; ++k) {
    const auto at = static_cast<double>(begin + k);
    Complex wave = std::polar(1.0 - std::cos(line * (at + 0.5)), -(turn - line * bins) * at);
    const Complex next = std::polar(1.0, -line * at);
    for (Index l = 0; l < lines; ++l, wave *= next)
      waves(k, 2 * l) = wave.real(), waves(k, 2 * l + 1) = wave.imag();
  }
  return waves;
}

/// Of white noise as dense as each residual is around each mode (p x K).
struct NoiseNearModes {
  MatrixXd variance, freedom;  ///< freedom: of the variance, in degrees
};

/// The mean power of the lines h around a mode, over the share of white noise that remains in the residual:
/// with G = h^H (I - Q Q^T - S N^-1 S^T / variance) h, tr G / h^H h. The power of white noise has
/// (tr G)^2 / |G|^2 degrees of freedom [satterthwaite1946].
NoiseNearModes noise_near_modes(const JointLinearisation& at, double interval, const VectorXd& rates) {
  constexpr Index block = 4096;
  constexpr double least_left = 0.2;
  const Index modes = rates.size() / 2, count = at.residuals.rows(), channels = at.residuals.cols();
  const MatrixXd inverse = inverse_of(at.normal);
  NoiseNearModes noise{MatrixXd(channels, modes), MatrixXd(channels, modes)};
  for (Index m = 0; m < modes; ++m) {
    MatrixXd on_lines, on_residuals, on_range, on_slopes;  // (34 x 34, p, 2K+1, 2K)
    const auto add = [](const MatrixXd& lines, const auto& rows, MatrixXd& sum) {
      if (sum.size() == 0) sum = MatrixXd::Zero(lines.cols(), rows.cols());
      sum.noalias() += lines.transpose() * rows;
    };
    for (Index begin = 0; begin < count; begin += block) {
      const Index samples = std::min(block, count - begin);
      const MatrixXd lines = hann_lines(begin, samples, count, rates[2 * m] * interval);
      add(lines, lines, on_lines);
      add(lines, at.residuals.middleRows(begin, samples), on_residuals);
      add(lines, at.range.middleRows(begin, samples), on_range);
      add(lines, at.slopes.middleRows(begin, samples), on_slopes);
    }
    for (Index c = 0; c < channels; ++c) {
      const MatrixXd moved = on_slopes * at.amplitudes[static_cast<std::size_t>(c)];
      const MatrixXd left =
          on_lines - on_range * on_range.transpose() - moved * inverse * moved.transpose() / at.variances[c];
      const double remains = std::max(least_left * on_lines.trace(), left.trace());
      noise.variance(c, m) = on_residuals.col(c).squaredNorm() / remains;
      noise.freedom(c, m) = remains * remains / std::max(left.squaredNorm(), 1e-300);
    }
  }
  return noise;
}

/// Of the sum that the channels' noise makes of a mode's variance, each by its share [satterthwaite1946].
double freedom_of(const JointLinearisation& at, const NoiseNearModes& noise, Index m) {
  double sum = 0.0, squares = 0.0;
  for (Index c = 0; c < at.residuals.cols(); ++c) {
    const double share = at.squares[static_cast<std::size_t>(c)].block<2, 2>(2 * m, 2 * m).trace() *
                         noise.variance(c, m) / (at.variances[c] * at.variances[c]);
    sum += share, squares += share * share / noise.freedom(c, m);
  }
  return sum * sum / std::max(squares, 1e-300);
}

MatrixXd covariance_of(const JointLinearisation& at, const NoiseNearModes& noise) {
  const Index modes = noise.variance.cols();
  MatrixXd middle = MatrixXd::Zero(2 * modes, 2 * modes);
  VectorXd student(2 * modes);
  for (Index m = 0; m < modes; ++m)
    student.segment<2>(2 * m).setConstant(student_factor(freedom_of(at, noise, m)));
  for (Index c = 0; c < at.residuals.cols(); ++c) {
    VectorXd density(2 * modes);
    for (Index m = 0; m < modes; ++m) density.segment<2>(2 * m).setConstant(std::sqrt(noise.variance(c, m)));
    density /= at.variances[c];
    middle += density.asDiagonal() * at.squares[static_cast<std::size_t>(c)] * density.asDiagonal();
  }
  const MatrixXd inverse = student.asDiagonal() * inverse_of(at.normal);
  return inverse * middle * inverse.transpose();
}

void take_own_shifts(const JointLinearisation& at, JointDecayFit& fit) {
  const Index modes = fit.noise_variance.cols(), channels = at.residuals.cols();
  fit.own_shift.setZero(channels, modes);
  fit.own_shift_deviation.setConstant(channels, modes, std::numeric_limits<double>::infinity());
  for (Index c = 0; c < channels; ++c)
    for (Index m = 0; m < modes; ++m) {
      const auto channel = static_cast<std::size_t>(c);
      const Eigen::Matrix2d inverse = at.squares[channel].block<2, 2>(2 * m, 2 * m).inverse();
      const double variance = fit.noise_variance(c, m) * inverse(0, 0);
      if (!std::isfinite(variance) || !(variance > 0.0)) continue;
      fit.own_shift(c, m) = (inverse * at.moments[channel].segment<2>(2 * m))[0];
      fit.own_shift_deviation(c, m) = std::sqrt(variance);
    }
}

}  // namespace

JointDecayFit fit_decays_jointly(const MatrixXd& outputs, double interval,
                                 const std::vector<Complex>& start) {
  // What leads on without an end, a pole that noise does not determine, gains next to nothing of chi-square.
  constexpr double little = 0.1;
  constexpr int most_idle = 20;
  check_joint_decay_fit(outputs, interval, start);
  const auto modes = static_cast<Index>(start.size());
  const MatrixXd y = outputs.transpose();
  VectorXd rates(2 * modes);
  for (Index m = 0; m < modes; ++m) rates.segment<2>(2 * m) << start[m].imag(), -start[m].real();
  JointLinearisation at = linearise(y, interval, rates);
  const double duration = interval * static_cast<double>(y.rows());
  RateDescent descent(at, rates, duration);
  const auto exhausted = [&](int steps) {
    return std::runtime_error("least squares of " + std::to_string(modes) +
                              " damped sines did not converge in " + std::to_string(steps) + " steps");
  };
  const auto step = [&](double damping) { return descent.step(damping); };
  int idle = 0;
  const auto take = [&](const VectorXd& tried) {
    // The last is less than 1e-5 of a standard deviation, or moves the rates by rounding only.
    const VectorXd moved = descent.rates_after(tried);
    const bool settled = descent.length(tried) < 1e-5 || (moved - rates).norm() < 1e-13 * rates.norm();
    JointLinearisation next = linearise(y, interval, moved);
    const double gained = at.misfit - next.misfit, expected = descent.fall(tried);
    idle = gained < little ? idle + 1 : 0;
    if (idle > most_idle && !settled) throw exhausted(idle);
    if (gained >= 0.0) rates = moved, at = std::move(next), descent = RateDescent(at, rates, duration);
    return filters::TriedStep{expected > 0.0 ? gained / expected : gained >= 0.0 ? 1.0 : 0.0, settled};
  };
  const filters::MarquardtDamping rule;
  if (filters::levenberg_marquardt(rule, step, take) == filters::DescentEnd::exhausted)
    throw exhausted(rule.most_steps);
  JointDecayFit fit;
  fit.shapes.resize(y.cols(), modes);
  for (Index m = 0; m < modes; ++m) {
    fit.rates.push_back(rate_at(rates, m));
    fit.shapes.col(m) = at.parts.row(2 * m).transpose().cast<Complex>() +
                        Complex(0, 1) * at.parts.row(2 * m + 1).transpose().cast<Complex>();
  }
  fit.offsets = at.parts.row(2 * modes).transpose();
  fit.reconstruction = (y - at.residuals).transpose();
  fit.residual_standard_deviation =
      at.residuals.colwise().norm().transpose() / std::sqrt(static_cast<double>(y.rows() - 4 * modes - 1));
  const NoiseNearModes noise = noise_near_modes(at, interval, rates);
  fit.noise_variance = noise.variance;
  fit.covariance = covariance_of(at, noise);
  take_own_shifts(at, fit);
  return fit;
}

}  // namespace beamid::experiments
