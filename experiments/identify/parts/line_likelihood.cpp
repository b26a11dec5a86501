#include "experiments/identify/parts/line_likelihood.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "experiments/signal/spectrum.hpp"
#include "experiments/signal/toolbox.hpp"
#include "filters/levenberg_marquardt.hpp"
#include "filters/linear_gaussian.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;
using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double usual_band = 0.6;  // of half the sampling rate
constexpr Index fewest_lined_samples = 64, fewest_used_lines = 8;

Complex sum_of_powers(Complex pole, double omega, const RecordLines& record) {
  const double dt = record.interval;
  const Complex whole = std::exp(pole * (dt * static_cast<double>(record.samples)));
  return (1.0 - whole) / (1.0 - std::exp((pole - Complex(0.0, omega)) * dt));
}

}  // namespace

RecordLines record_lines(const filters::Measurements& record, const MatrixXd& inputs,
                         const std::optional<double>& highest_hz) {
  filters::require_even_stamps(record, record.interval());
  if (!record.outputs.allFinite() || !inputs.allFinite())
    throw std::invalid_argument("readings are missing; expected every sample of every channel of the part");
  if (record.size() < fewest_lined_samples)
    throw std::invalid_argument(
        fmt::format("{} samples; expected {} at least", record.size(), fewest_lined_samples));
  RecordLines found;
  found.samples = fast_length_within(record.size(), 5);
  found.interval = record.interval();
  const double half_rate = 0.5 / found.interval, highest = highest_hz.value_or(usual_band * half_rate),
               length = static_cast<double>(found.samples) * found.interval;
  const auto lines = static_cast<Index>(highest * length * (1.0 + 1e-9));
  if (!(highest < half_rate) || lines < fewest_used_lines)
    throw std::invalid_argument(fmt::format(
        "highest_hz is {:g}; expected it between {:.3g}, {} lines, and half the sampling rate, {:g} Hz",
        highest, static_cast<double>(fewest_used_lines) / length, fewest_used_lines, half_rate));
  const double first = 2.0 * pi / length;
  found.omega = first * VectorXd::LinSpaced(lines, 1.0, static_cast<double>(lines));
  found.outputs = spectrum_lines(record.outputs, found.samples, lines);
  found.inputs = spectrum_lines(inputs, found.samples, lines);
  return found;
}

MatrixXcd free_lines(const SupportedResponse::FreeMotion& motion, const RecordLines& record) {
  const Index p = motion.shapes.rows(), lines = record.omega.size();
  std::vector<VectorXcd> columns;
  for (Index j = 0; j < motion.poles.size(); ++j) {
    const Complex pole = motion.poles[j];
    const VectorXcd shape = motion.shapes.col(j);
    VectorXcd real(p * lines), imaginary(p * lines);
    for (Index k = 0; k < lines; ++k) {
      const VectorXcd forth = shape * sum_of_powers(pole, record.omega[k], record),
                      back = shape.conjugate() * sum_of_powers(std::conj(pole), record.omega[k], record);
      real.segment(k * p, p) = 0.5 * (forth + back);
      imaginary.segment(k * p, p) = Complex(0.0, -0.5) * (forth - back);
    }
    columns.push_back(real.normalized());
    if (pole.imag() > 0.0) columns.push_back(imaginary.normalized());
  }
  MatrixXcd found(p * lines, static_cast<Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) found.col(static_cast<Index>(j)) = columns[j];
  return found;
}

namespace {

constexpr double no_part = std::numeric_limits<double>::infinity();  // J where there is none

// G_k of all lines, and Z.
struct CandidateLines {
  std::vector<MatrixXcd> transfer;
  MatrixXcd free;
};

// Complex lines as real rows, one of them sqrt(2) long for each of the two: |rows|^2 / 2 is what J has.
MatrixXd line_rows(const MatrixXcd& lines) {
  MatrixXd rows(2 * lines.rows(), lines.cols());
  rows << std::numbers::sqrt2 * lines.real(), std::numbers::sqrt2 * lines.imag();
  return rows;
}

// J about one theta: what is left whitened, without free motion.
class LinesAt {
 public:
  LinesAt(const LineProblem& problem, const CandidateLines& part) : problem_(problem), part_(part) {
    const RecordLines& record = problem.record;
    const Index p = record.outputs.rows(), lines = record.omega.size();
    VectorXcd white(p * lines);
    MatrixXcd free = part.free;
    for (Index k = 0; k < lines; ++k) {
      const MatrixXcd& g = part.transfer[static_cast<std::size_t>(k)];
      const MatrixXcd spread = g * problem.input_noise.asDiagonal();
      MatrixXcd s = spread * spread.adjoint();
      s.diagonal() += problem.output_noise.cwiseAbs2();
      roots_.emplace_back(s);
      if (roots_.back().info() != Eigen::Success)
        throw std::runtime_error("the covariance of a line is not positive definite");
      white.segment(k * p, p) = record.outputs.col(k) - g * record.inputs.col(k);
      whiten(k, white.segment(k * p, p));
      whiten(k, free.middleRows(k * p, p));
    }
    const MatrixXd columns = line_rows(free);
    without_.compute(columns);
    const VectorXd all = line_rows(white);
    coefficients_ = without_.solve(all);
    white_ = all - columns * coefficients_;
  }

  double cost() const { return 0.5 * white_.squaredNorm(); }
  const VectorXd& white() const { return white_; }
  const VectorXd& coefficients() const { return coefficients_; }
  Index free_columns() const { return without_.rank(); }

  // r_k, and u^_k.
  VectorXcd rest(Index k) const {
    const RecordLines& record = problem_.record;
    const Index p = record.outputs.rows();
    return record.outputs.col(k) - part_.transfer[static_cast<std::size_t>(k)] * record.inputs.col(k) -
           part_.free.middleRows(k * p, p) * coefficients_;
  }
  VectorXcd input(Index k) const {
    const MatrixXcd& g = part_.transfer[static_cast<std::size_t>(k)];
    return problem_.record.inputs.col(k) +
           problem_.input_noise.cwiseAbs2().asDiagonal() * (g.adjoint() * root(k).solve(rest(k)));
  }
  // Covariance of u^_k.
  MatrixXcd input_covariance(Index k) const {
    const MatrixXcd& g = part_.transfer[static_cast<std::size_t>(k)];
    const MatrixXd r = problem_.input_noise.cwiseAbs2().asDiagonal();
    return r - r * (g.adjoint() * root(k).solve(g * r));
  }
  void whiten(Index k, auto&& columns) const { root(k).matrixL().solveInPlace(columns); }
  // Without what free motion could have made of it.
  MatrixXd projected(const MatrixXcd& lines) const {
    MatrixXd rows = line_rows(lines);
    const MatrixXd q = without_.householderQ() * MatrixXd::Identity(rows.rows(), without_.rank());
    rows -= q * (q.transpose() * rows);
    return rows;
  }

 private:
  const LineProblem& problem_;
  const CandidateLines& part_;
  std::vector<Eigen::LLT<MatrixXcd>> roots_;
  Eigen::ColPivHouseholderQR<MatrixXd> without_;
  VectorXd white_, coefficients_;

  const Eigen::LLT<MatrixXcd>& root(Index k) const { return roots_[static_cast<std::size_t>(k)]; }
};

struct LineSlope {
  VectorXd gradient;
  MatrixXd squares, noise;  // D^H S^-1 D, and what the noise of u^ has in it (q x q)
};

class LineLikelihood {
 public:
  explicit LineLikelihood(const LineProblem& problem) : problem_(problem) {
    const MatrixXd& known = problem.prior.covariance;
    prior_ = known.llt().solve(MatrixXd::Identity(known.rows(), known.cols()));
  }
  const MatrixXd& prior() const { return prior_; }
  VectorXd off(const VectorXd& theta) const { return theta - problem_.prior.mean; }

  CandidateLines part(const VectorXd& theta) const {
    const SupportedResponse response = problem_.response(theta);
    CandidateLines found{{}, free_lines(response.free_motion(problem_.free_modes), problem_.record)};
    for (const double omega : problem_.record.omega) found.transfer.push_back(response.transfer(omega));
    return found;
  }
  double cost(const LinesAt& at, const VectorXd& theta) const {
    return at.cost() + 0.5 * off(theta).dot(prior_ * off(theta));
  }
  // Infinite where there is no such part.
  double cost(const VectorXd& theta) const {
    try {
      const CandidateLines there = part(theta);
      const double found = cost(LinesAt(problem_, there), theta);
      return std::isfinite(found) ? found : no_part;
    } catch (const std::runtime_error&) {
      return no_part;
    }
  }

  LineSlope slope(const LinesAt& at, const VectorXd& theta) const {
    constexpr double share = 1e-3;  // of the deviations known beforehand
    const Index q = theta.size(), p = problem_.record.outputs.rows(), lines = problem_.record.omega.size();
    MatrixXcd turned(p * lines, q);
    std::vector<std::vector<MatrixXcd>> changes;
    for (Index j = 0; j < q; ++j) {
      const double step = share * std::sqrt(problem_.prior.covariance(j, j));
      const CandidateLines up = part(theta + step * VectorXd::Unit(q, j)),
                           down = part(theta - step * VectorXd::Unit(q, j));
      turned.col(j) = (up.free - down.free) * at.coefficients() / (2.0 * step);
      changes.emplace_back();
      for (std::size_t k = 0; k < up.transfer.size(); ++k)
        changes.back().emplace_back((up.transfer[k] - down.transfer[k]) / (2.0 * step));
    }
    LineSlope found{{}, {}, MatrixXd::Zero(q, q)};
    for (Index k = 0; k < lines; ++k) {
      const VectorXcd input = at.input(k);
      const MatrixXcd spread = at.input_covariance(k);
      std::vector<MatrixXcd> white;
      for (Index j = 0; j < q; ++j) {
        MatrixXcd& change = changes[static_cast<std::size_t>(j)][static_cast<std::size_t>(k)];
        turned.col(j).segment(k * p, p) += change * input;
        at.whiten(k, change);
        white.push_back(change);
      }
      at.whiten(k, turned.middleRows(k * p, p));
      for (Index i = 0; i < q; ++i)
        for (Index j = 0; j < q; ++j)
          found.noise(i, j) += 2.0 * (white[static_cast<std::size_t>(i)] * spread)
                                         .cwiseProduct(white[static_cast<std::size_t>(j)].conjugate())
                                         .sum()
                                         .real();
    }
    const MatrixXd rows = at.projected(turned);
    found.squares = rows.transpose() * rows;
    found.gradient = prior_ * off(theta) - rows.transpose() * at.white();
    return found;
  }

 private:
  const LineProblem& problem_;
  MatrixXd prior_;
};

// I, or where the noise of the inputs is all there is, no less than a thousandth of what is read.
MatrixXd line_information(const LineSlope& slope) {
  const MatrixXd information = slope.squares - slope.noise;
  const Eigen::LLT<MatrixXd> factor(information - 1e-3 * slope.squares);
  return factor.info() == Eigen::Success ? information : MatrixXd(1e-3 * slope.squares);
}

LineFit fit_at(const LineProblem& problem, const LineLikelihood& likelihood, const LinesAt& at,
               const VectorXd& theta, const LineSlope& slope) {
  const Index lines = problem.record.omega.size(), p = problem.record.outputs.rows();
  LineFit fit{theta, line_information(slope), {}, VectorXd(lines), VectorXd(lines), 0.0, false};
  const Index q = theta.size();
  const MatrixXd inverse = (fit.information + likelihood.prior()).ldlt().solve(MatrixXd::Identity(q, q));
  fit.covariance = inverse * (slope.squares + likelihood.prior()) * inverse;
  for (Index k = 0; k < lines; ++k) {
    VectorXcd rest = at.rest(k), read = problem.record.outputs.col(k);
    at.whiten(k, rest);
    at.whiten(k, read);
    fit.squares[k] = rest.squaredNorm();
    fit.readings[k] = read.squaredNorm();
  }
  fit.freedom = static_cast<double>(2 * (p - problem.unmeasured) * lines - at.free_columns() - q);
  return fit;
}

}  // namespace

LineFit fit_lines(const LineProblem& problem, const std::vector<VectorXd>& others) {
  constexpr double close_enough = 0.01;  // length of the next step, in deviations
  const LineLikelihood likelihood(problem);
  VectorXd theta = problem.prior.mean;
  double least = likelihood.cost(theta);
  for (const VectorXd& other : others)
    if (const double cost = likelihood.cost(other); cost < least) least = cost, theta = other;
  CandidateLines part = likelihood.part(theta);
  auto at = std::make_unique<LinesAt>(problem, part);
  LineSlope slope = likelihood.slope(*at, theta);
  bool last = false;
  const auto next_step = [&](double damping) {
    return VectorXd(-filters::solve_damped(slope.squares + likelihood.prior(), damping, slope.gradient));
  };
  const auto take = [&](const VectorXd& step) {
    const MatrixXd curvature = slope.squares + likelihood.prior();
    last = std::sqrt(step.dot(curvature * step)) < close_enough;
    const double cost = likelihood.cost(theta + step);
    if (!(cost < least)) return filters::TriedStep{0.0, last};
    const double expected = -(slope.gradient.dot(step) + 0.5 * step.dot(curvature * step));
    const double gain = (least - cost) / std::max(expected, 1e-300);
    theta += step;
    least = cost;
    at.reset();
    part = likelihood.part(theta);
    at = std::make_unique<LinesAt>(problem, part);
    slope = likelihood.slope(*at, theta);
    return filters::TriedStep{gain, last};
  };
  filters::MarquardtDamping rule;
  rule.most_steps = 60;
  const filters::DescentEnd end = filters::levenberg_marquardt(rule, next_step, take);
  LineFit fit = fit_at(problem, likelihood, *at, theta, slope);
  fit.converged = end == filters::DescentEnd::settled;
  return fit;
}

}  // namespace beamid::experiments
