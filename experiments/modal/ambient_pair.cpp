#include "experiments/modal/ambient_pair.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <Eigen/Dense>

#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index most_channels = 6;

// Unknowns: [f_1, f_2 in units of the first half width, ln zeta_1, ln zeta_2, ln l_11, ln l_22, Re l_21,
// Im l_21 (relative to l_22 at the start), ln S_e, then p - 1 coordinates of each shape about its start], S =
// L L^H.
enum Entry { f1, f2, zeta1, zeta2, l11, l22, real21, imaginary21, noise, shapes };

struct TwoStarts {
  double frequency_hz[2], damping_ratio, density;
  MatrixXd shapes;  // of unit length (p x 2)
};

using Small = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, 0, most_channels, most_channels>;
using Moved = Eigen::Matrix<Complex, Eigen::Dynamic, 2, 0, most_channels, 2>;
using Column = Eigen::Matrix<Complex, Eigen::Dynamic, 1, 0, most_channels, 1>;

/// (i b)^m.
Complex b_to_the(int power, double b) {
  return power == 0 ? Complex(1.0, 0.0) : power == 1 ? Complex(0.0, b) : Complex(-b * b, 0.0);
}

/// x conj(y).
Complex product(Complex x, Complex y) {
  return {x.real() * y.real() + x.imag() * y.imag(), x.imag() * y.real() - x.real() * y.imag()};
}

/// The entries of a Hermitian matrix as p^2 real numbers: their product is the trace of two such matrices.
template <typename Row, typename Entries>
void put_entries(Row& into, Index p, const Entries& entry) {
  Index place = 0;
  for (Index c = 0; c < p; ++c) {
    into[place++] = entry(c, c).real();
    for (Index r = c + 1; r < p; ++r) {
      const Complex below = std::numbers::sqrt2 * entry(r, c);
      into[place++] = below.real();
      into[place++] = below.imag();
    }
  }
}

/// E = M M^H + S_e I = L L^H of a line.
class WhitenedLine {
 public:
  WhitenedLine(const Moved& moved, double noise_density) {
    Small covariance = moved.lazyProduct(moved.adjoint());
    covariance.diagonal().array() += noise_density;
    const Eigen::LLT<Small> factor(covariance);
    positive_ = factor.info() == Eigen::Success;
    const Small& lower = factor.matrixLLT();
    const Index p = lower.rows();
    whitener_ = Small::Zero(p, p);
    for (Index c = 0; c < p; ++c) {  // Eigen's solve divides complex numbers where the diagonal is real
      whitener_(c, c) = 1.0 / lower(c, c).real();
      for (Index r = c + 1; r < p; ++r) {
        Complex sum = 0.0;
        for (Index j = c; j < r; ++j) sum += lower(r, j) * whitener_(j, c);
        whitener_(r, c) = -sum * (1.0 / lower(r, r).real());
      }
    }
  }

  bool is_positive() const { return positive_; }
  double log_determinant() const { return -2.0 * whitener_.diagonal().real().array().log().sum(); }
  const Small& whitener() const { return whitener_; }  ///< L^-1

 private:
  Small whitener_;
  bool positive_;
};

class PairLikelihood {
 public:
  PairLikelihood(const MatrixXcd& coefficients, const VectorXd& frequency_hz, const AmbientMode& one,
                 double beyond, Index channels_beyond, TwoStarts start, ResponseKind kind)
      : coefficients_(coefficients),
        frequency_hz_(frequency_hz),
        one_(one),
        beyond_(beyond),
        channels_beyond_(channels_beyond),
        start_(std::move(start)),
        power_(static_cast<int>(kind)) {
    const Index p = coefficients.rows();
    for (int i = 0; i < 2; ++i)  // an orthonormal basis of what is across the shape (p x p - 1)
      across_[i] = MatrixXd(start_.shapes.col(i).householderQr().householderQ()).rightCols(p - 1);
  }

  VectorXd first() const {
    VectorXd at = VectorXd::Zero(size());
    at[zeta1] = at[zeta2] = std::log(start_.damping_ratio);
    at[l11] = at[l22] = 0.5 * std::log(start_.density);
    at[noise] = std::log(one_.noise_density);
    return at;
  }

  Index size() const { return shapes + 2 * (coefficients_.rows() - 1); }
  double unit_hz() const { return start_.damping_ratio * one_.frequency_hz; }
  double frequency(const VectorXd& at, int i) const { return start_.frequency_hz[i] + unit_hz() * at[i]; }

  double force_density(const VectorXd& at, int i) const {
    const double own = std::exp(2.0 * at[l11 + i]);
    return i == 0 ? own : own + std::norm(Complex(at[real21], at[imaginary21])) * start_.density;
  }

  /// |S_12| / sqrt(S_11 S_22).
  double coherence(const VectorXd& at) const {
    return std::abs(Complex(at[real21], at[imaginary21])) * std::sqrt(start_.density / force_density(at, 1));
  }

  VectorXd unscaled_shape(const VectorXd& at, int i) const {
    const Index more = coefficients_.rows() - 1;
    return start_.shapes.col(i) + across_[i] * at.segment(shapes + i * more, more);
  }

  double operator()(const VectorXd& at) const {
    if (!(frequency(at, 0) > 0.0 && frequency(at, 1) > 0.0)) return std::numeric_limits<double>::infinity();
    const PairMotion motion(*this, at);
    double sum = own_noise(at);
    for (Index k = 0; k < frequency_hz_.size(); ++k) {
      const WhitenedLine line(motion.moved(frequency_hz_[k]), motion.noise_density);
      if (!line.is_positive()) return std::numeric_limits<double>::infinity();
      sum += line.log_determinant() + (line.whitener() * coefficients_.col(k)).squaredNorm();
    }
    return sum;
  }

  /// Slope of -ln p and Fisher's information tr(E^-1 dE_i E^-1 dE_j): with E = L L^H, S_j = L^-1 dE_j L^-H is
  /// Hermitian, and that trace is the product of the entries of S_i and S_j, as real numbers.
  void score(const VectorXd& at, VectorXd& slope, MatrixXd& information) const {
    const Index q = size(), n = frequency_hz_.size(), p = coefficients_.rows();
    const PairMotion motion(*this, at);
    slope = VectorXd::Zero(q);
    MatrixXd entries(q, p * p * n);
    std::vector<Moved> changes(static_cast<std::size_t>(q));
    for (Index k = 0; k < n; ++k) {
      const double f = frequency_hz_[k];
      const Moved read = motion.moved(f);
      const WhitenedLine line(read, motion.noise_density);
      const Small& whitener = line.whitener();
      const Moved moved = whitener * read;
      const Column left = whitener * coefficients_.col(k);
      motion.change(f, changes);
      const Eigen::RowVector2cd moved_left = left.adjoint() * moved;
      for (Index j = 0; j < q; ++j) {
        auto own = entries.row(j).segment(p * p * k, p * p);
        if (j == noise) {
          const Small scaled = motion.noise_density * whitener * whitener.adjoint();
          put_entries(own, p, [&](Index r, Index c) { return scaled(r, c); });
          slope[j] +=
              scaled.trace().real() - (whitener.adjoint() * left).squaredNorm() * motion.noise_density;
          continue;
        }
        const Moved change = whitener * changes[static_cast<std::size_t>(j)];
        put_entries(own, p, [&](Index r, Index c) {
          return product(change(r, 0), moved(c, 0)) + product(change(r, 1), moved(c, 1)) +
                 product(moved(r, 0), change(c, 0)) + product(moved(r, 1), change(c, 1));
        });
        const Eigen::RowVector2cd change_left = left.adjoint() * change;
        slope[j] += 2.0 * (moved.conjugate().cwiseProduct(change).sum().real() -
                           moved_left.conjugate().cwiseProduct(change_left).sum().real());
      }
    }
    information = entries * entries.transpose();
    const double weighed = static_cast<double>(channels_beyond_ * n);
    slope[noise] +=
        weighed - beyond_ / std::exp(at[noise]) + (at[noise] - std::log(one_.noise_density)) / 16.0;
    information(noise, noise) += weighed + 1.0 / 16.0;
  }

  VectorXd misfit(const VectorXd& at) const {
    const PairMotion motion(*this, at);
    VectorXd found(frequency_hz_.size());
    for (Index k = 0; k < found.size(); ++k) {
      const WhitenedLine line(motion.moved(frequency_hz_[k]), motion.noise_density);
      found[k] = (line.whitener() * coefficients_.col(k)).squaredNorm();
    }
    return found;
  }

 private:
  // Of the channels beyond, which hold noise alone, and of what is assumed of S_e: a factor of e^4.
  double own_noise(const VectorXd& at) const {
    return static_cast<double>(channels_beyond_ * frequency_hz_.size()) * at[noise] +
           beyond_ / std::exp(at[noise]) + std::pow(at[noise] - std::log(one_.noise_density), 2) / 32.0;
  }

  /// M = Phi diag(h) L of the lines, and its slopes: E = M M^H + S_e I.
  struct PairMotion {
    PairMotion(const PairLikelihood& likelihood, const VectorXd& at)
        : of(likelihood), noise_density(std::exp(at[noise])), shapes(likelihood.coefficients_.rows(), 2) {
      for (int i = 0; i < 2; ++i) {
        frequency_hz[i] = of.frequency(at, i);
        damping_ratio[i] = std::exp(at[zeta1 + i]);
        // s = v / |v|: ds = (dv - s (s^T dv)) / |v|
        const VectorXd v = of.unscaled_shape(at, i);
        shapes.col(i) = v.normalized();
        across[i] = (of.across_[i] - shapes.col(i) * (shapes.col(i).transpose() * of.across_[i])) / v.norm();
      }
      forces << std::exp(at[l11]), 0.0, Complex(at[real21], at[imaginary21]) * std::sqrt(of.start_.density),
          std::exp(at[l22]);
    }

    /// h of mode i, its slope to its unknown frequency and to ln zeta.
    std::array<Complex, 3> response(double f, int i) const {
      const double b = f / frequency_hz[i], z = damping_ratio[i];
      const Complex numerator = b_to_the(of.power_, b), pole = 1.0 / Complex(1.0 - b * b, 2.0 * z * b);
      const Complex h = numerator * pole;
      // d ln h / d b = m / b - (-2 b + 2 i z) / (1 - b^2 + 2 i z b)
      const Complex by_b = h * (of.power_ / b - Complex(-2.0 * b, 2.0 * z) * pole);
      return {h, by_b * (-b / frequency_hz[i] * of.unit_hz()), -h * Complex(0.0, 2.0 * z * b) * pole};
    }

    Moved moved(double f) const {
      const Eigen::Vector2cd h(response(f, 0)[0], response(f, 1)[0]);
      return shapes * (h.asDiagonal() * forces);
    }

    /// dM of each unknown but S_e.
    void change(double f, std::vector<Moved>& changes) const {
      const double unit = std::sqrt(of.start_.density);
      std::array<Complex, 3> h[2] = {response(f, 0), response(f, 1)};
      for (int i = 0; i < 2; ++i) {
        changes[static_cast<std::size_t>(f1 + i)] = shapes.col(i) * (h[i][1] * forces.row(i));
        changes[static_cast<std::size_t>(zeta1 + i)] = shapes.col(i) * (h[i][2] * forces.row(i));
        Eigen::RowVector2cd own = Eigen::RowVector2cd::Zero();
        own[i] = h[i][0] * forces(i, i);
        changes[static_cast<std::size_t>(l11 + i)] = shapes.col(i) * own;
        for (Index j = 0; j < across[i].cols(); ++j)
          changes[static_cast<std::size_t>(Entry::shapes + i * across[i].cols() + j)] =
              across[i].col(j) * (h[i][0] * forces.row(i));
      }
      const Eigen::RowVector2cd other(h[1][0] * unit, 0.0);
      changes[real21] = shapes.col(1) * other;
      changes[imaginary21] = shapes.col(1) * (Complex(0.0, 1.0) * other);
    }

    const PairLikelihood& of;
    double noise_density, frequency_hz[2], damping_ratio[2];
    MatrixXd shapes;     // (p x 2)
    MatrixXd across[2];  // slopes of the shapes (p x p - 1)
    Eigen::Matrix2cd forces;
  };

  const MatrixXcd& coefficients_;
  const VectorXd& frequency_hz_;
  const AmbientMode& one_;
  double beyond_;
  Index channels_beyond_;
  TwoStarts start_;
  int power_;
  MatrixXd across_[2];
};

struct Descent {
  VectorXd at;
  double cost = std::numeric_limits<double>::infinity();
  MatrixXd information;
  bool settled = false;
};

Descent descend(const PairLikelihood& likelihood) {
  constexpr double close_enough = 1e-4;  // of -ln p: a hundredth of a standard deviation
  Descent now;
  now.at = likelihood.first();
  now.cost = likelihood(now.at);
  VectorXd slope;
  bool moved = true;
  const auto step = [&](double damping) -> VectorXd {
    if (std::exchange(moved, false)) likelihood.score(now.at, slope, now.information);
    return -filters::solve_damped(now.information, damping, slope);
  };
  const auto take = [&](const VectorXd& tried) {
    if (!tried.allFinite() || tried.cwiseAbs().maxCoeff() > 3.0) return filters::TriedStep{};
    if (std::abs(tried.dot(slope)) < close_enough) return filters::TriedStep{0.0, true};
    const double there = likelihood(now.at + tried);
    if (!(there < now.cost)) return filters::TriedStep{};
    now.cost = there, now.at += tried, moved = true;
    return filters::TriedStep{1.0, false};
  };
  filters::MarquardtDamping rule;
  rule.first = 1e-2, rule.most_steps = 100;
  now.settled = filters::levenberg_marquardt(rule, step, take) == filters::DescentEnd::settled;
  likelihood.score(now.at, slope, now.information);
  return now;
}

AmbientMode mode_at(const PairLikelihood& likelihood, const Descent& found, const MatrixXd& covariance, int i,
                    const MatrixXd& basis, const AmbientMode& one) {
  AmbientMode mode;
  mode.frequency_hz = likelihood.frequency(found.at, i);
  mode.damping_ratio = std::exp(found.at[zeta1 + i]);
  mode.noise_density = std::exp(found.at[noise]);
  mode.shape = basis * likelihood.unscaled_shape(found.at, i).normalized();
  mode.frequency_deviation_hz = likelihood.unit_hz() * std::sqrt(std::max(0.0, covariance(f1 + i, f1 + i)));
  mode.damping_ratio_deviation =
      mode.damping_ratio * std::sqrt(std::max(0.0, covariance(zeta1 + i, zeta1 + i)));
  mode.force_density = likelihood.force_density(found.at, i);
  mode.band_hz = one.band_hz;
  mode.converged = found.settled;
  return mode;
}

// -ln p of one mode, as PairLikelihood has that of two.
double cost_of_one(const AmbientMode& one, const BandCoefficients& band, ResponseKind kind) {
  const VectorXd misfit = band_misfit(one, band, kind);
  const auto p = static_cast<double>(band.coefficients.rows());
  double sum = misfit.sum();
  for (const double f : band.frequency_hz) {
    const double own = response_to_force(f / one.frequency_hz, one.damping_ratio, kind);
    sum += std::log(one.force_density * own + one.noise_density) + (p - 1.0) * std::log(one.noise_density);
  }
  return sum;
}

}  // namespace

AmbientPair ambient_pair(const BandCoefficients& band, const AmbientMode& one,
                         const std::vector<std::pair<double, double>>& starts, ResponseKind kind) {
  const Index n = band.frequency_hz.size(), channels = band.coefficients.rows();
  if (n < 16) throw std::invalid_argument("fewer than 16 frequencies in the band; expected a longer record");
  const MatrixXd power = (band.coefficients * band.coefficients.adjoint()).real();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> directions(power);
  const Index p = std::min(channels, most_channels);
  const MatrixXd basis = directions.eigenvectors().rightCols(p);
  const MatrixXcd kept = basis.transpose() * band.coefficients;
  const double beyond = std::max(0.0, band.coefficients.squaredNorm() - kept.squaredNorm());

  Descent best;
  AmbientPair pair;
  const auto from = [&](double below, double above, double damping_ratio, double across) {
    TwoStarts start{{below, above}, damping_ratio, 0.5 * one.force_density, MatrixXd::Ones(1, 2)};
    if (p > 1) {  // the strongest direction, and that with a share of the second strongest either way
      start.shapes = MatrixXd::Zero(p, 2);
      start.shapes.row(p - 1).setConstant(std::sqrt(1.0 - across * across));
      start.shapes(p - 2, 0) = across, start.shapes(p - 2, 1) = -across;
    }
    const PairLikelihood likelihood(kept, band.frequency_hz, one, beyond, channels - p, start, kind);
    const Descent found = descend(likelihood);
    if (!(found.cost < best.cost)) return;
    best = found;
    const MatrixXd covariance = found.information.completeOrthogonalDecomposition().pseudoInverse();
    for (int i = 0; i < 2; ++i)
      pair.modes[static_cast<std::size_t>(i)] = mode_at(likelihood, found, covariance, i, basis, one);
    pair.misfit = likelihood.misfit(found.at);
    pair.converged = found.settled;
    pair.coherence = likelihood.coherence(found.at);
    pair.more_parameters = 5 + static_cast<int>(p - 1);
  };
  for (const auto& [below, above] : starts)
    for (const double across : {0.3, 0.7})
      from(below, above, std::min(one.damping_ratio, 0.25 * (above - below) / below), across);
  for (const double apart : {0.4, 1.5})
    for (const double across : {0.3, 0.7}) {
      const double half = apart * one.damping_ratio * one.frequency_hz;
      from(one.frequency_hz - half, one.frequency_hz + half, 0.7 * one.damping_ratio, across);
      if (p == 1) break;
    }
  if (pair.modes[1].frequency_hz < pair.modes[0].frequency_hz) std::swap(pair.modes[0], pair.modes[1]);
  // What lies beyond the six combinations is noise of the pair's density.
  pair.misfit.array() += beyond / pair.modes[0].noise_density / static_cast<double>(n);
  pair.gain = 2.0 * (cost_of_one(one, band, kind) - best.cost);
  return pair;
}

double band_dispersion(const VectorXd& misfit, Index channels, Index lines) {
  const Index size = std::max<Index>(8, lines), groups = misfit.size() / size;
  if (groups < 3) return 1.0;
  double square = 0.0;
  const auto p = static_cast<double>(channels);
  for (Index g = 0; g < groups; ++g)
    square += std::pow(misfit.segment(g * size, size).sum() - p * static_cast<double>(size), 2) /
              (p * static_cast<double>(size));
  return square / static_cast<double>(groups);
}

}  // namespace beamid::experiments
