#include "experiments/modal/input_responses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "experiments/modal/residue_fit.hpp"
#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

/// Of every output: R = Re(X^H X) is theirs in common, S = Re(X^H Y), T = Re(Y^H Y), with Y = -H X.
struct NormalEquations {
  MatrixXd r, t;
  std::vector<MatrixXd> s;
};

NormalEquations assemble(const VectorXd& frequency_hz, const MatrixXcd& responses, Index order) {
  const double turn = std::numbers::pi / frequency_hz[frequency_hz.size() - 1];
  MatrixXcd x(frequency_hz.size(), order + 1);
  for (Index k = 0; k < x.rows(); ++k)
    for (Index j = 0; j <= order; ++j)
      x(k, j) = std::polar(1.0, -turn * frequency_hz[k] * static_cast<double>(j));
  NormalEquations normal{(x.adjoint() * x).real(), MatrixXd::Zero(order + 1, order + 1), {}};
  for (Index o = 0; o < responses.rows(); ++o) {
    const double scale = responses.row(o).norm();
    if (!(scale > 0)) continue;
    const MatrixXcd y = (responses.row(o).transpose() / -scale).asDiagonal() * x;
    normal.s.push_back((x.adjoint() * y).real());
    normal.t += (y.adjoint() * y).real();
  }
  return normal;
}

/// Roots of a_0 + a_1 x + ... + a_(n-1) x^(n-1) + x^n.
VectorXcd roots(const VectorXd& coefficients) {
  const Index n = coefficients.size();
  MatrixXd companion = MatrixXd::Zero(n, n);
  companion.bottomLeftCorner(n - 1, n - 1).setIdentity();
  companion.col(n - 1) = -coefficients;
  return companion.eigenvalues();
}

class CommonDenominatorMethod final : public ModalMethod {
 public:
  explicit CommonDenominatorMethod(std::string refusal) : refusal_(std::move(refusal)) {}

  PoleSearch search(const MatrixXd&, double, int) const override { throw std::invalid_argument(refusal_); }

  std::vector<OrderPoles> search_responses(const VectorXd& frequency_hz, const MatrixXcd& responses,
                                           double shift, int largest_order) const override {
    return common_denominator_poles(frequency_hz, responses, shift, largest_order);
  }

 private:
  std::string refusal_;
};

}  // namespace

std::vector<OrderPoles> common_denominator_poles(const VectorXd& frequency_hz, const MatrixXcd& responses,
                                                 double shift, int largest_order) {
  if (frequency_hz.size() < largest_order + 2)
    throw std::invalid_argument(
        fmt::format("{} lines in the band; expected at least {} for models of order {}", frequency_hz.size(),
                    largest_order + 2, largest_order));
  const NormalEquations normal = assemble(frequency_hz, responses, largest_order);
  const double per_radian = 2 * frequency_hz[frequency_hz.size() - 1];  // one over the sampling interval
  std::vector<OrderPoles> orders;
  for (Index n = 2; n <= largest_order; n += 2) {
    const Index size = n + 1;
    MatrixXd reduced = normal.t.topLeftCorner(size, size);
    const MatrixXd common = normal.r.topLeftCorner(size, size);
    for (const MatrixXd& s : normal.s) {
      const MatrixXd part = s.topLeftCorner(size, size);
      reduced -= part.transpose() * least_squares(common, part);
    }
    const VectorXd a = -least_squares(reduced.topLeftCorner(n, n), reduced.col(n).head(n));
    OrderPoles at{static_cast<int>(n), {}};
    for (const Complex& x : roots(a)) {
      const Complex rate = -std::log(x) * per_radian + shift;
      const double f = rate.imag() / (2 * std::numbers::pi);
      if (f > frequency_hz[0] && f < frequency_hz[frequency_hz.size() - 1] && rate.real() < 0)
        at.poles.push_back({rate, VectorXcd::Ones(responses.rows())});
    }
    std::sort(at.poles.begin(), at.poles.end(),
              [](const Pole& p, const Pole& q) { return p.frequency_hz() < q.frequency_hz(); });
    if (responses.rows() > 1 && !at.poles.empty()) {
      std::vector<Complex> rates;
      for (const Pole& pole : at.poles) rates.push_back(pole.rate);
      const ResidueFit fit = fit_residues(frequency_hz, responses, shift, 2, rates);
      for (std::size_t m = 0; m < rates.size(); ++m)
        at.poles[m].shape = fit.residues.col(static_cast<Index>(m));
    }
    orders.push_back(std::move(at));
  }
  return orders;
}

std::unique_ptr<ModalMethod> common_denominator_method(std::string refusal) {
  return std::make_unique<CommonDenominatorMethod>(std::move(refusal));
}

InputResponses input_responses(const MatrixXd& outputs, const MatrixXd& inputs, double interval) {
  constexpr Index blocks_per_input = 6, fewest_samples = 64, overlapping = 4;
  constexpr double tiny = 1e-12;  // of the largest power of the inputs
  const Index p = outputs.rows(), m = inputs.rows();
  const Index longest = 2 * outputs.cols() / (blocks_per_input * m + 1);
  if (longest < fewest_samples)
    throw std::invalid_argument(
        fmt::format("{} samples; frequency responses to {} input{} expect {} at least", outputs.cols(), m,
                    m > 1 ? "s" : "", fewest_samples * (blocks_per_input * m + 1) / 2));
  const Index length = fast_length_within(longest), lines = (length - 1) / 2;
  const VectorXd phase = VectorXd::LinSpaced(
      length, 0.0, 2.0 * std::numbers::pi * static_cast<double>(length - 1) / static_cast<double>(length));
  const VectorXd window = 0.5 * (1.0 - phase.array().cos());
  const auto block = [&](const MatrixXd& signals, Index begin) {
    const MatrixXd part = signals.middleCols(begin, length);
    return spectrum_lines((part.colwise() - part.rowwise().mean()) * window.asDiagonal(), length, lines);
  };
  std::vector<MatrixXcd> uu(static_cast<std::size_t>(lines), MatrixXcd::Zero(m, m)),
      yu(static_cast<std::size_t>(lines), MatrixXcd::Zero(p, m));
  InputResponses found;
  MatrixXd yy = MatrixXd::Zero(p, lines);
  double largest = 0.0;  // power of an input
  for (Index begin = 0; begin + length <= outputs.cols(); begin += std::max<Index>(1, length / overlapping)) {
    const MatrixXcd y = block(outputs, begin), u = block(inputs, begin);
    for (Index k = 0; k < lines; ++k) {
      uu[static_cast<std::size_t>(k)] += u.col(k) * u.col(k).adjoint();
      yu[static_cast<std::size_t>(k)] += y.col(k) * u.col(k).adjoint();
    }
    yy += y.cwiseAbs2();
    ++found.averages;
  }
  for (const MatrixXcd& power : uu) largest = std::max(largest, power.diagonal().real().maxCoeff());
  found.duration = interval * static_cast<double>(length);
  found.frequency_hz = VectorXd::LinSpaced(lines, 1.0, static_cast<double>(lines)) / found.duration;
  found.h1.resize(p * m, lines);
  found.coherence.resize(p, lines);
  const double least = tiny * largest;
  for (Index k = 0; k < lines; ++k) {
    MatrixXcd power = uu[static_cast<std::size_t>(k)];
    power.diagonal().array() += least;
    const MatrixXcd cross = yu[static_cast<std::size_t>(k)],
                    h = power.ldlt().solve(cross.adjoint()).adjoint();
    found.h1.col(k) = h.reshaped();
    for (Index i = 0; i < p; ++i)
      found.coherence(i, k) = std::clamp(
          (h.row(i) * cross.row(i).adjoint()).value().real() / std::max(yy(i, k), 1e-300), 0.0, 1.0);
  }
  return found;
}

}  // namespace beamid::experiments
