#include "experiments/identify/twins/spectrum_solutions.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "experiments/identify/twins/path_tracking.hpp"
#include "experiments/text/countdown.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

double wrapped_angle(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

// Whether two balls may hold the same solution.
bool meet(const CertifiedSolution& a, const CertifiedSolution& b) {
  const double reach = 2.0 * (a.radius + b.radius);
  for (Index i = 0; i < a.u.size(); ++i) {
    const PathComplex d = a.u[i] - b.u[i];
    if (std::abs(d.real()) > reach || std::abs(wrapped_angle(d.imag())) > reach) return false;
  }
  return true;
}

// Adds those that differ from all others; sorted by Re u_1, where only neighbours can meet.
void add_distinct(std::vector<CertifiedSolution> more, std::vector<CertifiedSolution>& all) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  std::sort(all.begin(), all.end(), [](const CertifiedSolution& a, const CertifiedSolution& b) {
    return a.u[0].real() < b.u[0].real();
  });
  double widest = 0.0;
  for (const CertifiedSolution& one : all) widest = std::max(widest, one.radius);
  std::vector<CertifiedSolution> kept;
  for (CertifiedSolution& one : all) {
    bool known = false;
    for (auto other = kept.rbegin(); other != kept.rend() && !known; ++other) {
      if (one.u[0].real() - other->u[0].real() > 4.0 * widest) break;
      known = meet(one, *other);
    }
    if (!known) kept.push_back(std::move(one));
  }
  all = std::move(kept);
}

// Real and positive: its conjugate solves the same equations, and lies in the ball that has one solution.
bool is_positive(const CertifiedSolution& one) {
  for (Index i = 0; i < one.u.size(); ++i)
    if (std::abs(wrapped_angle(one.u[i].imag())) > 2.0 * one.radius) return false;
  return true;
}

// Newton's method on the eigenvalues themselves: the polynomials' coefficients lose digits that these keep.
// With A = L L^T those of L^T diag(k) L, whose derivative by ln k_j is k_j (row j of L times eigenvector)^2.
VectorXd polished(const MatrixXd& matrix, const VectorXd& spectrum, VectorXd k) {
  const MatrixXd root = matrix.llt().matrixL();
  VectorXd wanted = spectrum;
  std::sort(wanted.begin(), wanted.end());
  for (int i = 0; i < 4; ++i) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(root.transpose() * k.asDiagonal() * root);
    const MatrixXd slopes = (root * solver.eigenvectors()).cwiseAbs2().transpose() * k.asDiagonal();
    const VectorXd left = (wanted - solver.eigenvalues()).cwiseQuotient(wanted);
    const VectorXd step = (wanted.cwiseInverse().asDiagonal() * slopes).partialPivLu().solve(left);
    if (!step.allFinite() || step.cwiseAbs().maxCoeff() > 1e-3) break;
    k = k.cwiseProduct(step.array().exp().matrix());
  }
  return k;
}

std::vector<ComplexVector> permuted_starts(const VectorXd& spectrum) {
  std::vector<Index> order(static_cast<std::size_t>(spectrum.size()));
  std::iota(order.begin(), order.end(), 0);
  std::vector<ComplexVector> starts;
  do {
    ComplexVector u(spectrum.size());
    for (Index i = 0; i < u.size(); ++i) u[i] = std::log(spectrum[order[static_cast<std::size_t>(i)]]);
    starts.push_back(u);
  } while (std::next_permutation(order.begin(), order.end()));
  return starts;
}

}  // namespace

SpectrumSolutions spectrum_solutions(const MatrixXd& matrix, const VectorXd& spectrum,
                                     const Progress& progress) {
  const Index n = matrix.rows();
  if (n < 1 || n > most_paths_order || matrix.cols() != n || spectrum.size() != n ||
      !(spectrum.minCoeff() > 0.0))
    throw std::invalid_argument(
        fmt::format("a matrix of {} rows with {} eigenvalues; expected as many "
                    "positive eigenvalues as rows, {} at most",
                    n, spectrum.size(), most_paths_order));
  // Unit diagonal and spectrum of geometric mean 1: k_i a_ii / scale stand for k_i.
  const VectorXd diagonal = matrix.diagonal(), root = diagonal.cwiseSqrt().cwiseInverse();
  const double scale = std::exp(spectrum.array().log().mean());
  const VectorXd scaled = spectrum / scale;
  const MinorSystem system(root.asDiagonal() * matrix * root.asDiagonal(), scaled);
  const std::vector<ComplexVector> starts = permuted_starts(scaled);
  SpectrumSolutions result;
  result.complex_solutions = starts.size();
  std::vector<CertifiedSolution> all;
  // Paths that came too near each other and were exchanged end twice at one solution: another arc and
  // shorter steps tell them apart.
  const std::pair<double, double> attempts[] = {{0.8, 3e-3}, {-1.1, 3e-4}, {2.0, 3e-5}};
  for (const auto& [angle, correction] : attempts) {
    std::vector<std::optional<CertifiedSolution>> ends(starts.size());
    Countdown countdown(progress, starts.size(), "paths");
    tbb::parallel_for(
        std::size_t{0}, starts.size(), [&, angle = angle, correction = correction](std::size_t i) {
          if (const auto end = follow_path(system, starts[i], std::polar(1.0, angle), correction))
            ends[i] = certified(system, *end);
          countdown.count();
        });
    std::vector<CertifiedSolution> found;
    for (auto& end : ends)
      if (end) found.push_back(std::move(*end));
    add_distinct(std::move(found), all);
    if (all.size() == starts.size()) break;
  }
  result.found = all.size();
  for (const CertifiedSolution& one : all)
    if (is_positive(one))
      result.positive.push_back(
          polished(matrix, spectrum, (one.u.real().array().exp() * scale / diagonal.array()).matrix()));
  return result;
}

}  // namespace beamid::experiments
