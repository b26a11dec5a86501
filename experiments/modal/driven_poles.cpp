#include "experiments/modal/driven_poles.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"
#include "filters/levenberg_marquardt.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using std::numbers::pi;

Complex pole_at(double frequency, double ratio) {  // [rad/s], below critical damping
  ratio = std::min(ratio, 0.999);
  return frequency * Complex(-ratio, std::sqrt(1.0 - ratio * ratio));
}

VectorXd logarithms(const std::vector<Complex>& rates) {
  VectorXd theta(2 * static_cast<Index>(rates.size()));
  for (Index m = 0; m < theta.size() / 2; ++m) {
    const Complex rate = rates[static_cast<std::size_t>(m)];
    theta[2 * m] = std::log(std::abs(rate));
    theta[2 * m + 1] = std::log(std::clamp(-rate.real() / std::abs(rate), 1e-6, 0.99));
  }
  return theta;
}

// What one mode can make of the lines (L x 2 (m + 1)): u_j / den and s u_j / den of every input, then the
// ends.
MatrixXcd mode_columns(const DrivenLines& lines, double frequency, double ratio) {
  const Index count = lines.omega.size(), m = lines.inputs.rows();
  const Complex step = std::exp(pole_at(frequency, ratio) * lines.interval);
  MatrixXcd columns(count, 2 * (m + 1));
  for (Index k = 0; k < count; ++k) {
    const Complex s(0.0, lines.omega[k]), back = std::exp(-s * lines.interval);
    const Complex one = frequency * frequency / (s * s + 2.0 * ratio * frequency * s + frequency * frequency);
    for (Index j = 0; j < m; ++j) {
      columns(k, 2 * j) = one * lines.inputs(j, k);
      columns(k, 2 * j + 1) = s / frequency * one * lines.inputs(j, k);
    }
    const Complex forth = 1.0 / (1.0 - step * back), mirrored = 1.0 / (1.0 - std::conj(step) * back);
    columns(k, 2 * m) = 0.5 * (forth + mirrored);
    columns(k, 2 * m + 1) = Complex(0.0, -0.5) * (forth - mirrored);
  }
  return columns;
}

// Modes outside the band, and the ends of the inputs (L x 3 m + 2).
MatrixXcd other_columns(const DrivenLines& lines) {
  const Index count = lines.omega.size(), m = lines.inputs.rows();
  const double highest = lines.omega[count - 1], lowest = lines.omega[0];
  MatrixXcd columns(count, 3 * m + 2);
  for (Index k = 0; k < count; ++k) {
    const double omega = lines.omega[k], up = omega / highest, down = lowest / omega;
    for (Index j = 0; j < m; ++j) {
      columns(k, 3 * j) = lines.inputs(j, k);
      columns(k, 3 * j + 1) = up * up * lines.inputs(j, k);
      columns(k, 3 * j + 2) = down * down * lines.inputs(j, k);
    }
    columns(k, 3 * m) = 1.0;
    columns(k, 3 * m + 1) = Complex(0.0, std::sin(omega * lines.interval));
  }
  return columns;
}

// The linear part solved at given poles: the same columns for all channels.
class AtPoles {
 public:
  AtPoles(const DrivenLines& lines, const VectorXd& theta)
      : lines_(&lines), modes_(theta.size() / 2), width_(2 * (lines.inputs.rows() + 1)) {
    const MatrixXcd others = other_columns(lines);
    MatrixXcd all(lines.omega.size(), modes_ * width_ + others.cols());
    for (Index m = 0; m < modes_; ++m)
      all.middleCols(m * width_, width_) =
          mode_columns(lines, std::exp(theta[2 * m]), std::exp(theta[2 * m + 1]));
    all.rightCols(others.cols()) = others;
    columns_ = line_rows(all);
    scale_ = columns_.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
    qr_.setThreshold(1e-11);
    qr_.compute(columns_ * scale_.asDiagonal());
    const MatrixXd read = line_rows(lines.outputs.transpose());
    const MatrixXd scaled = qr_.solve(read);
    left_ = read - columns_ * (scale_.asDiagonal() * scaled);
    coefficients_ = scale_.asDiagonal() * scaled;
  }

  const MatrixXd& left() const { return left_; }                  // (2L x p)
  const MatrixXd& coefficients() const { return coefficients_; }  // (c x p)
  Index rank() const { return qr_.rank(); }
  bool finite() const { return left_.allFinite(); }

  // d left / d theta of each channel (2L x 2K), after Kaufman [kaufman1975]; up to its sign.
  std::vector<MatrixXd> slopes(const VectorXd& theta) const {
    constexpr double step = 1e-6;
    std::vector<MatrixXd> found(static_cast<std::size_t>(left_.cols()), MatrixXd(left_.rows(), theta.size()));
    for (Index a = 0; a < theta.size(); ++a) {
      const Index m = a / 2;
      const auto columns = [&](double change) {
        VectorXd there = theta;
        there[a] += change;
        return mode_columns(*lines_, std::exp(there[2 * m]), std::exp(there[2 * m + 1]));
      };
      const MatrixXd change = line_rows((columns(step) - columns(-step)) / (2.0 * step));
      MatrixXd rows = change * coefficients_.middleRows(m * width_, width_);
      rows.applyOnTheLeft(qr_.householderQ().transpose());
      rows.topRows(qr_.rank()).setZero();
      rows.applyOnTheLeft(qr_.householderQ());
      for (Index o = 0; o < rows.cols(); ++o) found[static_cast<std::size_t>(o)].col(a) = rows.col(o);
    }
    return found;
  }

  // b + b' p of mode m for channel i and input j.
  Complex numerator(Index m, Index i, Index j, Complex rate) const {
    const double frequency = std::abs(rate);
    const double value = coefficients_(m * width_ + 2 * j, i),
                 slope = coefficients_(m * width_ + 2 * j + 1, i);
    return frequency * frequency * (value + slope * rate / frequency);
  }

  // What the inputs make of the outputs through mode m (2L x p).
  MatrixXd part_of_mode(Index m) const {
    const Index driven = width_ - 2;
    return columns_.middleCols(m * width_, driven) * coefficients_.middleRows(m * width_, driven);
  }

  // How much of the squares left, channels weighed, more columns would take (L x c).
  double taken_by(const MatrixXcd& more, const VectorXd& weights) const {
    MatrixXd rows = line_rows(more);
    rows = rows * VectorXd(rows.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse()).asDiagonal();
    rows.applyOnTheLeft(qr_.householderQ().transpose());
    rows.topRows(qr_.rank()).setZero();
    const MatrixXd rest = rows.bottomRows(rows.rows() - qr_.rank());
    MatrixXd left = left_ * weights.asDiagonal();
    left.applyOnTheLeft(qr_.householderQ().transpose());
    const MatrixXd below = left.bottomRows(left.rows() - qr_.rank());
    const Eigen::ColPivHouseholderQR<MatrixXd> added(rest);
    return (added.householderQ().transpose() * below).topRows(added.rank()).squaredNorm();
  }

  // What a unit of input j makes of the outputs (p x L).
  MatrixXcd transfer(const VectorXd& theta, Index j) const {
    DrivenLines unit = *lines_;
    unit.inputs.setZero();
    unit.inputs.row(j).setOnes();
    MatrixXcd sum = other_columns(unit).leftCols(3 * unit.inputs.rows()) *
                    coefficients_.middleRows(modes_ * width_, 3 * unit.inputs.rows());
    for (Index m = 0; m < modes_; ++m)
      sum += mode_columns(unit, std::exp(theta[2 * m]), std::exp(theta[2 * m + 1])).leftCols(width_ - 2) *
             coefficients_.middleRows(m * width_, width_ - 2);
    return sum.transpose();
  }

  // What is left without mode m (2L x p).
  MatrixXd left_without(Index m) const {
    MatrixXd rest(columns_.rows(), columns_.cols() - width_);
    rest << columns_.leftCols(m * width_), columns_.rightCols(columns_.cols() - (m + 1) * width_);
    const VectorXd scale = rest.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
    rest = rest * scale.asDiagonal();
    const MatrixXd read = line_rows(lines_->outputs.transpose());
    return read - rest * rest.colPivHouseholderQr().solve(read);
  }

 private:
  const DrivenLines* lines_;
  Index modes_, width_;
  MatrixXd columns_;
  VectorXd scale_;
  Eigen::ColPivHouseholderQR<MatrixXd> qr_;
  MatrixXd left_, coefficients_;
};

double cost_of(const AtPoles& at, const VectorXd& weights) {
  return (at.left() * weights.asDiagonal()).squaredNorm();
}

VectorXd sizes_of(const MatrixXcd& outputs) {
  return (outputs.cwiseAbs2().rowwise().mean()).cwiseSqrt().cwiseMax(1e-150);
}

// (p) what is left of a line, as white noise would have it.
VectorXd left_of(const AtPoles& at, const DrivenLines& lines) {
  const double rows = static_cast<double>(at.left().rows());
  const double freedom = std::max(1.0, rows - static_cast<double>(at.rank()));
  return (2.0 * at.left().colwise().squaredNorm().transpose() / freedom)
      .cwiseSqrt()
      .cwiseMax(1e-7 * sizes_of(lines.outputs));
}

struct Normal {
  MatrixXd information;  // J^T J
  VectorXd slope;        // J^T r
  MatrixXd lines;        // J^T r line by line (2K x L)
};

Normal normal_at(const AtPoles& at, const VectorXd& theta, const VectorXd& weights) {
  const Index count = at.left().rows() / 2;
  Normal found{MatrixXd::Zero(theta.size(), theta.size()), VectorXd::Zero(theta.size()),
               MatrixXd::Zero(theta.size(), count)};
  const std::vector<MatrixXd> slopes = at.slopes(theta);
  for (Index o = 0; o < weights.size(); ++o) {
    const MatrixXd& j = slopes[static_cast<std::size_t>(o)];
    const double weight = weights[o] * weights[o];
    const VectorXd left = at.left().col(o);
    found.information += weight * j.transpose() * j;
    found.lines += weight * (j.topRows(count).transpose() * left.head(count).asDiagonal() +
                             j.bottomRows(count).transpose() * left.tail(count).asDiagonal());
  }
  found.slope = found.lines.rowwise().sum();
  return found;
}

// One descent with the weights given.
VectorXd descend(const DrivenLines& lines, const VectorXd& weights, const VectorXd& start) {
  constexpr double longest = 0.5, settled = 1e-9;  // in logarithms; of the cost
  constexpr double largest_ratio = 0.9;
  VectorXd theta = start;
  AtPoles now(lines, theta);
  double cost = cost_of(now, weights);
  if (!std::isfinite(cost)) throw std::runtime_error("the lines of the record are not finite");
  Normal normal = normal_at(now, theta, weights);
  const auto step = [&](double damping) {
    VectorXd found = filters::solve_damped(normal.information, damping, normal.slope);
    const double length = found.cwiseAbs().maxCoeff();
    if (length > longest) found *= longest / length;
    return found;
  };
  const auto take = [&](const VectorXd& change) {
    filters::TriedStep tried;
    VectorXd there = theta + change;
    for (Index m = 0; m < there.size() / 2; ++m)
      there[2 * m + 1] = std::clamp(there[2 * m + 1], std::log(1e-6), std::log(largest_ratio));
    AtPoles next(lines, there);
    const double reached = next.finite() ? cost_of(next, weights) : INFINITY;
    const double expected = change.dot(2.0 * normal.slope - normal.information * change);
    if (!(reached < cost)) {
      tried.settled = expected < settled * cost;
      return tried;
    }
    tried.gain = expected > 0.0 ? (cost - reached) / expected : 1.0;
    tried.settled = cost - reached < settled * cost;
    theta = there;
    cost = reached;
    now = std::move(next);
    if (!tried.settled) normal = normal_at(now, theta, weights);
    return tried;
  };
  filters::MarquardtDamping rule;
  rule.first = 1e-3;
  rule.most_steps = 60;
  filters::levenberg_marquardt(rule, step, take);
  return theta;
}

// Squares around mode m that go with it, over those that noise would take: an F ratio.
double ratio_of(const AtPoles& at, const DrivenLines& lines, const VectorXd& weights, Index m,
                const VectorXd& theta) {
  constexpr double half_powers = 4.0;
  constexpr Index fewest = 12;
  const double frequency = std::exp(theta[2 * m]), ratio = std::exp(theta[2 * m + 1]);
  const double line = lines.omega[1] - lines.omega[0], reach = half_powers * ratio * frequency;
  const Index count = lines.omega.size(), middle = static_cast<Index>((frequency - lines.omega[0]) / line),
              half = std::max(fewest / 2, static_cast<Index>(reach / line)),
              first = std::clamp<Index>(middle - half, 0, count - 1),
              last = std::clamp<Index>(middle + half, first, count - 1), near = last - first + 1;
  const MatrixXd with = at.left() * weights.asDiagonal(), without = at.left_without(m) * weights.asDiagonal();
  const double noise =
      (with.middleRows(first, near).squaredNorm() + with.middleRows(count + first, near).squaredNorm()) /
      static_cast<double>(2 * near * with.cols());
  const double unknowns = static_cast<double>((2 * lines.inputs.rows() + 2) * with.cols() + 2);
  return (without.squaredNorm() - with.squaredNorm()) / (unknowns * std::max(noise, 1e-300));
}

}  // namespace

DrivenLines driven_lines(const MatrixXd& outputs, const MatrixXd& inputs, double interval,
                         std::pair<double, double> band_hz) {
  constexpr Index fewest = 16;
  const Index samples = fast_length_within(outputs.cols(), 5);
  const double length = interval * static_cast<double>(samples);
  const auto last = std::min<Index>(static_cast<Index>(band_hz.second * length), (samples - 1) / 2),
             first = std::max<Index>(1, static_cast<Index>(std::ceil(band_hz.first * length)));
  if (last - first + 1 < fewest)
    throw std::invalid_argument(fmt::format("{} lines of {:.3g} Hz in the band; expected {} at least",
                                            std::max<Index>(0, last - first + 1), 1.0 / length, fewest));
  DrivenLines found;
  found.interval = interval;
  const Index count = last - first + 1;
  found.omega =
      VectorXd::LinSpaced(count, static_cast<double>(first), static_cast<double>(last)) * (2.0 * pi / length);
  found.outputs = spectrum_lines(outputs, samples, last).rightCols(count);
  found.inputs = spectrum_lines(inputs, samples, last).rightCols(count);
  return found;
}

DrivenPoles fit_driven_poles(const DrivenLines& lines, const std::vector<Complex>& rates) {
  const Index p = lines.outputs.rows(), inputs = lines.inputs.rows(),
              modes = static_cast<Index>(rates.size());
  const VectorXd size = sizes_of(lines.outputs);
  VectorXd theta = logarithms(rates), weights = size.cwiseInverse();
  for (int round = 0; round < 3; ++round) {
    theta = descend(lines, weights, theta);
    weights = left_of(AtPoles(lines, theta), lines).cwiseInverse();
  }
  const AtPoles at(lines, theta);
  const Normal normal = normal_at(at, theta, weights);
  DrivenPoles fit;
  fit.residual_shapes.resize(p * inputs, modes);
  fit.share.resize(modes);
  fit.ratio.resize(modes);
  for (Index m = 0; m < modes; ++m) {
    const Complex rate = pole_at(std::exp(theta[2 * m]), std::exp(theta[2 * m + 1]));
    fit.rates.push_back(rate);
    for (Index j = 0; j < inputs; ++j)
      for (Index i = 0; i < p; ++i) fit.residual_shapes(i + p * j, m) = at.numerator(m, i, j, rate);
    const VectorXd part = at.part_of_mode(m).colwise().norm().transpose();
    fit.share[m] = part.cwiseQuotient(size).maxCoeff() / std::sqrt(static_cast<double>(lines.omega.size()));
    fit.ratio[m] = ratio_of(at, lines, weights, m, theta);
  }
  fit.transfer.resize(p * inputs, lines.omega.size());
  for (Index j = 0; j < inputs; ++j) fit.transfer.middleRows(p * j, p) = at.transfer(theta, j);
  fit.left = left_of(at, lines);
  const Index count = lines.omega.size();
  fit.left_share = std::sqrt(at.left()
                                 .colwise()
                                 .squaredNorm()
                                 .transpose()
                                 .cwiseQuotient(size.cwiseAbs2() * static_cast<double>(count))
                                 .mean());
  // Every line has its own noise: the sandwich, over what the fit takes.
  const Index q = theta.size();
  const MatrixXd inverse = normal.information.ldlt().solve(MatrixXd::Identity(q, q));
  const double rows = static_cast<double>(2 * count),
               freedom = std::max(1.0, rows - static_cast<double>(at.rank()));
  fit.covariance = rows / freedom * inverse * (normal.lines * normal.lines.transpose()) * inverse;
  if (!fit.covariance.allFinite()) throw std::runtime_error("the lines do not determine the poles");
  return fit;
}

Complex next_pole(const DrivenLines& lines, const std::vector<Complex>& rates, const VectorXd& left) {
  constexpr double octave_share = 12.0;
  const AtPoles at(lines, logarithms(rates));
  const VectorXd weights = left.cwiseInverse();
  const Index count = lines.omega.size();
  const double line = lines.omega[1] - lines.omega[0];
  Complex best;
  double most = -1.0;
  for (double omega = lines.omega[0] + line; omega < lines.omega[count - 1];
       omega += std::max(2.0 * line, omega * (std::exp2(1.0 / octave_share) - 1.0)))
    for (const double ratio : {0.005, 0.02, 0.06}) {
      const double taken = at.taken_by(mode_columns(lines, omega, ratio), weights);
      if (!(taken > most)) continue;
      most = taken;
      best = pole_at(omega, ratio);
    }
  return best;
}

MatrixXd scatter_over(const std::vector<DrivenLines>& sections, const DrivenPoles& fit) {
  const auto count = static_cast<Index>(sections.size());
  const VectorXd theta = logarithms(fit.rates), weights = fit.left.cwiseInverse();
  const Index q = theta.size();
  MatrixXd information = MatrixXd::Zero(q, q), slopes(q, count);
  for (Index i = 0; i < count; ++i) {
    const DrivenLines& section = sections[static_cast<std::size_t>(i)];
    const Normal normal = normal_at(AtPoles(section, theta), theta, weights);
    information += normal.information;
    slopes.col(i) = normal.slope;
  }
  const MatrixXd deviations = information.ldlt().solve(slopes.colwise() - VectorXd(slopes.rowwise().mean()));
  return static_cast<double>(count) / static_cast<double>(std::max<Index>(1, count - 2)) * deviations *
         deviations.transpose();
}

}  // namespace beamid::experiments
