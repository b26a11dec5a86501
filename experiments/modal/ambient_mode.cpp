#include "experiments/modal/ambient_mode.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

#include "experiments/signal/toolbox.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::Vector4d, Eigen::VectorXcd, Eigen::VectorXd;

// [f / f_start - 1 in units of the damping ratio, ln zeta, ln S, ln S_e], and -ln p of them.
class BandLikelihood {
 public:
  BandLikelihood(const BandCoefficients& band, double frequency_hz, double damping_ratio, ResponseKind kind)
      : band_(band), scale_(damping_ratio), frequency_(frequency_hz), kind_(kind) {
    total_ = band.coefficients.squaredNorm();
  }

  /// ln S_e is taken as known beforehand to a factor of e^4 about this: without noise nothing else holds it.
  void expect_noise(double log_density) { noise_ = log_density; }

  double frequency(const Vector4d& at) const { return frequency_ * (1.0 + scale_ * at[0]); }
  double frequency_slope() const { return frequency_ * scale_; }

  double operator()(const Vector4d& at) const {
    const double f = frequency(at), zeta = std::exp(at[1]), s = std::exp(at[2]), se = std::exp(at[3]);
    if (!(f > 0.0)) return std::numeric_limits<double>::infinity();
    const Index n = band_.frequency_hz.size(), p = band_.coefficients.rows();
    VectorXd weight(n);
    double sum = static_cast<double>((p - 1) * n) * at[3] + std::pow(at[3] - noise_, 2) / 32.0;
    for (Index k = 0; k < n; ++k) {
      const double own = s * response(band_.frequency_hz[k] / f, zeta);
      sum += std::log(own + se);
      weight[k] = own / (own + se);
    }
    return sum + (total_ - eigenvalue(weight, nullptr)) / se;
  }

  VectorXd shape(const Vector4d& at) const {
    const double f = frequency(at), zeta = std::exp(at[1]), s = std::exp(at[2]), se = std::exp(at[3]);
    VectorXd weight(band_.frequency_hz.size()), found;
    for (Index k = 0; k < weight.size(); ++k) {
      const double own = s * response(band_.frequency_hz[k] / f, zeta);
      weight[k] = own / (own + se);
    }
    eigenvalue(weight, &found);
    return found;
  }

  double response(double b, double zeta) const { return response_to_force(b, zeta, kind_); }

 private:
  double eigenvalue(const VectorXd& weight, VectorXd* vector) const {
    const MatrixXcd weighed = band_.coefficients * weight.asDiagonal();
    const MatrixXd a = (weighed * band_.coefficients.adjoint()).real();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(
        a, vector ? Eigen::ComputeEigenvectors : Eigen::EigenvaluesOnly);
    if (vector) *vector = solver.eigenvectors().rightCols(1);
    return solver.eigenvalues().maxCoeff();
  }

  const BandCoefficients& band_;
  double scale_, frequency_, noise_ = 0.0;
  ResponseKind kind_;
  double total_ = 0.0;
};

struct Curvature {
  Vector4d gradient;
  Eigen::Matrix4d hessian;
};

Curvature curvature_at(const BandLikelihood& cost, const Vector4d& at) {
  constexpr double h = 1e-3;
  Curvature found;
  const double here = cost(at);
  const auto moved = [&](int i, double a, int j, double b) {
    Vector4d there = at;
    there[i] += a, there[j] += b;
    return cost(there);
  };
  for (int i = 0; i < 4; ++i) {
    const double above = moved(i, h, i, 0.0), below = moved(i, -h, i, 0.0);
    found.gradient[i] = (above - below) / (2.0 * h);
    found.hessian(i, i) = (above - 2.0 * here + below) / (h * h);
    for (int j = 0; j < i; ++j)
      found.hessian(i, j) = found.hessian(j, i) =
          (moved(i, h, j, h) - moved(i, h, j, -h) - moved(i, -h, j, h) + moved(i, -h, j, -h)) / (4.0 * h * h);
  }
  return found;
}

// Newton's method, damped until the value falls.
bool descend(const BandLikelihood& cost, Vector4d& at, Curvature& last) {
  double value = cost(at);
  bool moved = true;
  const auto step = [&](double damping) -> VectorXd {
    if (moved) last = curvature_at(cost, at);
    moved = false;
    const Vector4d size = last.hessian.diagonal().cwiseAbs().cwiseMax(1e-12);
    const Eigen::LLT<Eigen::Matrix4d> factor(last.hessian + damping * Eigen::Matrix4d(size.asDiagonal()));
    if (factor.info() != Eigen::Success) return {};
    return -factor.solve(last.gradient);
  };
  const auto take = [&](const VectorXd& tried) {
    if (tried.size() == 0 || tried.cwiseAbs().maxCoeff() > 2.0) return filters::TriedStep{};
    if (tried.dot(-last.gradient) < 1e-6) return filters::TriedStep{0.0, true};
    const double there = cost(at + tried);
    if (!(there < value)) return filters::TriedStep{};
    value = there, at += tried, moved = true;
    return filters::TriedStep{1.0, false};
  };
  filters::MarquardtDamping rule;
  rule.first = 1e-3, rule.lower = 1e-2, rule.most_steps = 200;
  return filters::levenberg_marquardt(rule, step, take) == filters::DescentEnd::settled;
}

}  // namespace

double response_to_force(double b, double damping_ratio, ResponseKind kind) {
  return std::pow(b, 2 * static_cast<int>(kind)) /
         (std::pow(b * b - 1.0, 2) + std::pow(2.0 * damping_ratio * b, 2));
}

BandCoefficients fourier_coefficients(const MatrixXd& outputs, double interval) {
  const Index samples = fast_length_within(outputs.cols()), half = (samples - 1) / 2;
  BandCoefficients all{
      VectorXd::LinSpaced(half, 1.0, static_cast<double>(half)) / (interval * static_cast<double>(samples)),
      MatrixXcd(outputs.rows(), half)};
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  for (Index i = 0; i < outputs.rows(); ++i) {
    const auto channel = outputs.row(i).head(samples);
    const VectorXd row = (channel.array() - channel.mean()).matrix().transpose();
    VectorXcd spectrum;
    transform.fwd(spectrum, row);
    all.coefficients.row(i) =
        std::sqrt(2.0 * interval / static_cast<double>(samples)) * spectrum.segment(1, half).transpose();
  }
  return all;
}

BandCoefficients within(const BandCoefficients& all, const std::pair<double, double>& band_hz) {
  const auto first = std::lower_bound(all.frequency_hz.begin(), all.frequency_hz.end(), band_hz.first),
             last = std::upper_bound(first, all.frequency_hz.end(), band_hz.second);
  const Index from = first - all.frequency_hz.begin(), count = last - first;
  return {all.frequency_hz.segment(from, count), all.coefficients.middleCols(from, count)};
}

BandCoefficients without(const BandCoefficients& all, double frequency_hz) {
  const Index n = all.frequency_hz.size();
  Index at = 0;
  (all.frequency_hz.array() - frequency_hz).abs().minCoeff(&at);
  std::vector<Index> kept;
  for (Index k = 0; k < n; ++k)
    if (std::abs(k - at) > 1) kept.push_back(k);
  return {all.frequency_hz(kept), all.coefficients(Eigen::all, kept)};
}

AmbientMode ambient_mode(const BandCoefficients& band, double frequency_hz, double damping_ratio,
                         ResponseKind kind) {
  const Index n = band.frequency_hz.size(), p = band.coefficients.rows();
  if (n < 8) throw std::invalid_argument("fewer than 8 frequencies in the band; expected a longer record");
  BandLikelihood cost(band, frequency_hz, damping_ratio, kind);
  // The largest part of the power is the mode's; a hundredth of the least part counts as noise at first.
  const VectorXd power = band.coefficients.colwise().squaredNorm();
  double response = 0.0;
  for (Index k = 0; k < n; ++k) response += cost.response(band.frequency_hz[k] / frequency_hz, damping_ratio);
  std::vector<double> sorted(power.begin(), power.end());
  std::sort(sorted.begin(), sorted.end());
  const double floor = sorted[sorted.size() / 10] / static_cast<double>(p);
  Vector4d at(0.0, std::log(damping_ratio), std::log(power.sum() / response), std::log(0.3 * floor + 1e-300));
  cost.expect_noise(at[3]);
  Curvature last;
  AmbientMode mode;
  mode.converged = descend(cost, at, last);
  last = curvature_at(cost, at);
  const Eigen::Matrix4d covariance = last.hessian.ldlt().solve(Eigen::Matrix4d::Identity());
  mode.frequency_hz = cost.frequency(at);
  mode.damping_ratio = std::exp(at[1]);
  mode.force_density = std::exp(at[2]);
  mode.noise_density = std::exp(at[3]);
  mode.shape = cost.shape(at);
  mode.frequency_deviation_hz = cost.frequency_slope() * std::sqrt(std::max(0.0, covariance(0, 0)));
  mode.damping_ratio_deviation = mode.damping_ratio * std::sqrt(std::max(0.0, covariance(1, 1)));
  mode.band_hz = {band.frequency_hz[0], band.frequency_hz[n - 1]};
  return mode;
}

VectorXd band_misfit(const AmbientMode& mode, const BandCoefficients& band, ResponseKind kind) {
  VectorXd misfit(band.frequency_hz.size());
  for (Index k = 0; k < misfit.size(); ++k) {
    const double own = mode.force_density *
                       response_to_force(band.frequency_hz[k] / mode.frequency_hz, mode.damping_ratio, kind);
    const double along = std::norm(mode.shape.cast<Complex>().dot(band.coefficients.col(k)));
    misfit[k] = along / (own + mode.noise_density) +
                (band.coefficients.col(k).squaredNorm() - along) / mode.noise_density;
  }
  return misfit;
}

AmbientLaw ambient_law(double damping_ratio, double periods, double kappa) {
  const double angle = std::atan(kappa), share = kappa / (kappa * kappa + 1.0);
  const double by_frequency = 2.0 / std::numbers::pi * (angle - share);
  const double by_damping = 2.0 / std::numbers::pi * (angle + share - 2.0 * angle * angle / kappa);
  return {std::sqrt(damping_ratio / (2.0 * std::numbers::pi * periods * by_frequency)),
          1.0 / std::sqrt(2.0 * std::numbers::pi * damping_ratio * periods * by_damping)};
}

}  // namespace beamid::experiments
