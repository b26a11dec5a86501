#include "experiments/identify/twins/twins.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include "experiments/text/progress.hpp"

namespace beamid::experiments {
namespace {

// Polynomials in which each unknown is linear: the principal minors of diag(k) A, summed by their order.

using PathComplex = std::complex<double>;

using ComplexVector = Eigen::Matrix<PathComplex, Eigen::Dynamic, 1, 0, most_paths_order, 1>;

using ComplexMatrix =
    Eigen::Matrix<PathComplex, Eigen::Dynamic, Eigen::Dynamic, 0, most_paths_order, most_paths_order>;

/// F_r(u; tau) = sum_{|S| = r} w_S(tau) exp(sum_{i in S} u_i) / c_r - 1,  r = 1 ... n,
///
/// with w_S(tau) = 1 + tau (det A_S - 1), c_r = e_r(lambda), u = ln k; A has a unit diagonal. At tau = 0 the
/// solutions are the permutations of ln lambda, at tau = 1 they are those wanted.
class MinorSystem {
 public:
  MinorSystem(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& spectrum);

  Eigen::Index size() const { return n_; }

  struct Value {
    ComplexVector residual;                                                 ///< F (n)
    ComplexMatrix jacobian;                                                 ///< dF/du (n x n)
    ComplexVector motion;                                                   ///< dF/dtau (n)
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_paths_order, 1> size;  ///< T_r, F's terms in modulus (n)
  };
  void at(const ComplexVector& u, PathComplex tau, Value& value) const;

 private:
  Eigen::Index n_;
  std::vector<double> minor_;  // det A_S of every subset S of 1 ... n, as bits
  std::vector<int> order_;     // |S|
  Eigen::VectorXd sums_;       // e_r(lambda)
};

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

double minor_of(const MatrixXd& matrix, unsigned subset) {
  std::vector<Index> rows;
  for (Index i = 0; i < matrix.rows(); ++i)
    if (subset >> i & 1u) rows.push_back(i);
  return rows.empty() ? 1.0 : MatrixXd(matrix(rows, rows)).determinant();
}

MinorSystem::MinorSystem(const MatrixXd& matrix, const VectorXd& spectrum) : n_(matrix.rows()) {
  const unsigned subsets = 1u << n_;
  for (unsigned subset = 0; subset < subsets; ++subset) {
    minor_.push_back(minor_of(matrix, subset));
    order_.push_back(std::popcount(subset));
  }
  sums_ = VectorXd::Zero(n_ + 1);
  sums_[0] = 1.0;
  for (Index i = 0; i < n_; ++i)
    for (Index r = i + 1; r > 0; --r) sums_[r] += spectrum[i] * sums_[r - 1];
}

void MinorSystem::at(const ComplexVector& u, PathComplex tau, Value& value) const {
  std::array<PathComplex, 1u << most_paths_order> product;
  std::array<PathComplex, most_paths_order> k;
  for (Index i = 0; i < n_; ++i) k[static_cast<std::size_t>(i)] = std::exp(u[i]);
  value.residual.setZero(n_);
  value.motion.setZero(n_);
  value.jacobian.setZero(n_, n_);
  value.size.setZero(n_);
  product[0] = 1.0;
  for (unsigned subset = 1; subset < minor_.size(); ++subset) {
    const auto lowest = static_cast<std::size_t>(std::countr_zero(subset));
    product[subset] = product[subset & (subset - 1)] * k[lowest];
    const Index r = order_[subset] - 1;
    const PathComplex scaled = product[subset] / sums_[r + 1],
                      term = (1.0 + tau * (minor_[subset] - 1.0)) * scaled;
    value.residual[r] += term;
    value.motion[r] += (minor_[subset] - 1.0) * scaled;
    value.size[r] += std::abs(term.real()) + std::abs(term.imag());
    for (unsigned left = subset; left != 0; left &= left - 1)
      value.jacobian(r, std::countr_zero(left)) += term;
  }
  value.residual.array() -= 1.0;
}

// One solution followed from the easy system to the wanted one.

/// A solution that exists for sure, and no second one near it.
struct CertifiedSolution {
  ComplexVector u;      ///< ln k, approximately
  double radius = 0.0;  ///< the solution lies within it, in every component; no other one within 2 of them
};

constexpr double shortest_path_step = 1e-9, path_rounding = 64.0 * std::numeric_limits<double>::epsilon();

double largest_modulus(const ComplexVector& vector) {
  return vector.cwiseAbs().maxCoeff();
}

class Follower {
 public:
  Follower(const MinorSystem& system, PathComplex gamma) : system_(system), gamma_(gamma) {}

  // du/ds
  ComplexVector slope(const ComplexVector& u, double s) {
    const PathComplex below = s + (1.0 - s) * gamma_;
    system_.at(u, s / below, value_);
    return -(gamma_ / (below * below)) * ComplexVector(value_.jacobian.partialPivLu().solve(value_.motion));
  }

  ComplexVector predicted(const ComplexVector& u, double s, double h) {
    const ComplexVector a = slope(u, s), b = slope(u + 0.5 * h * a, s + 0.5 * h),
                        c = slope(u + 0.5 * h * b, s + 0.5 * h), d = slope(u + h * c, s + h);
    return u + (h / 6.0) * (a + 2.0 * b + 2.0 * c + d);
  }

  // Newton's method; the first correction, or infinity where it does not converge as it should.
  double correct(ComplexVector& u, double s) {
    double first = 0.0, before = 0.0;
    for (int i = 0; i < 4; ++i) {
      system_.at(u, s / (s + (1.0 - s) * gamma_), value_);
      const ComplexVector step = value_.jacobian.partialPivLu().solve(value_.residual);
      const double size = largest_modulus(step);
      if (!std::isfinite(size) || size > 0.1 || (i > 0 && size > 0.1 * before && size > 1e-11))
        return std::numeric_limits<double>::infinity();
      u -= step;
      if (i == 0) first = size;
      if (size < 1e-10) return first;
      before = size;
    }
    return first;
  }

 private:
  const MinorSystem& system_;
  PathComplex gamma_;
  MinorSystem::Value value_;
};

/// tau = s / (s + (1 - s) gamma), s from 0 to 1: an arc that, for all gamma but finitely many, meets no
/// system with a multiple solution. Runge-Kutta's fourth order predicts, Newton's method corrects, and a step
/// that needs more than a small correction is halved.
/// @return nothing when steps become too short: solutions meet.
std::optional<ComplexVector> follow_path(const MinorSystem& system, ComplexVector u, PathComplex gamma,
                                         double largest_correction) {
  Follower follower(system, gamma);
  double s = 0.0, h = 0.05;
  while (s < 1.0) {
    h = std::min(h, 1.0 - s);
    ComplexVector next = follower.predicted(u, s, h);
    const double correction =
        next.allFinite() ? follower.correct(next, s + h) : std::numeric_limits<double>::infinity();
    if (correction > largest_correction) {
      h *= 0.5;
      if (h < shortest_path_step) return std::nullopt;
      continue;
    }
    u = next;
    s = h == 1.0 - s ? 1.0 : s + h;
    if (correction < 0.05 * largest_correction) h *= 1.8;
  }
  return u;
}

// |F_r''[v, v]| <= r^2 T_r e^(r rho) for |v| <= 1 within rho of u, since every exponent is a sum of r
// components.
/// Newton's method at tau = 1 and Kantorovich's theorem: with beta = |J^-1 F| and L a bound of
/// |J^-1| |F''| nearby, beta L <= 1/4 proves a solution within 2 beta. beta includes the rounding of F.
std::optional<CertifiedSolution> certified(const MinorSystem& system, ComplexVector u) {
  MinorSystem::Value value;
  const Index n = system.size();
  double beta = 0.0, curvature = 0.0;
  for (int i = 0; i < 8; ++i) {
    system.at(u, 1.0, value);
    if (!value.jacobian.allFinite()) return std::nullopt;
    const ComplexMatrix inverse = value.jacobian.inverse();
    if (!inverse.allFinite()) return std::nullopt;
    const ComplexVector step = inverse * value.residual;
    beta = largest_modulus(step);
    curvature = 0.0;
    double floor = 0.0;
    for (Index row = 0; row < n; ++row) {
      double bend = 0.0, rounded = 0.0;
      for (Index r = 0; r < n; ++r) {
        bend += std::abs(inverse(row, r)) * static_cast<double>((r + 1) * (r + 1)) * value.size[r];
        rounded += std::abs(inverse(row, r)) * (value.size[r] + 1.0) * path_rounding;
      }
      curvature = std::max(curvature, bend);
      floor = std::max(floor, rounded);
    }
    if (beta < 2.0 * floor || i == 7) {
      beta += floor;
      break;
    }
    u -= step;
  }
  const double bound = curvature * std::exp(2.0 * static_cast<double>(n) * beta);
  if (!(beta * bound <= 0.25)) return std::nullopt;
  return CertifiedSolution{u, 2.0 * beta};
}

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

namespace {

// K_j = b b^T; empty where its rank is not one.
VectorXd spring_of(const MatrixXd& stiffness) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(stiffness);
  const Index last = stiffness.rows() - 1;
  const double largest = solver.eigenvalues()[last];
  if (last > 0 && solver.eigenvalues().head(last).cwiseAbs().maxCoeff() > 1e-9 * largest) return {};
  return std::sqrt(largest) * solver.eigenvectors().col(last);
}

// Why the polynomials do not describe the structure; empty where they do.
std::string objection_to_paths(const ModalModel& model, const ModalData& data) {
  const Index n = model.size(), q = model.parameters(), given = static_cast<Index>(data.modes.size());
  if (n > most_paths_order || !model.dense())
    return fmt::format(
        "the structure has {} degrees of freedom, and {} are the most for which all solutions "
        "are computed",
        n, most_paths_order);
  if (q != n) return fmt::format("{} parameters are requested and there are {} degrees of freedom", q, n);
  if (given != n) return fmt::format("{} of {} frequencies were measured", given, n);
  for (const auto& slope : model.described().derivatives)
    if (slope.mass.nonZeros() > 0) return "a mass is requested";
  return "";
}

}  // namespace

// K = B^T diag(p) B with the springs as rows of B, so that M^-1 K has the spectrum of diag(p) A, A = B M^-1
// B^T.
TwinSearch exact_twins(const ModalModel& model, const ModalData& data, const Progress& progress) {
  TwinSearch search;
  search.reason = objection_to_paths(model, data);
  if (!search.reason.empty()) return search;
  const Index n = model.size();
  const auto [mass, stiffness] = model.matrices(model.described().values);
  MatrixXd springs(n, n), left = stiffness;
  for (Index j = 0; j < n; ++j) {
    const MatrixXd slope = model.described().stiffness_derivative(static_cast<std::size_t>(j));
    const VectorXd spring = spring_of(slope);
    if (spring.size() == 0) {
      search.reason = "a parameter is more than one spring";
      return search;
    }
    springs.row(j) = spring.transpose();
    left -= model.described().values[j] * slope;
  }
  if (left.cwiseAbs().maxCoeff() > 1e-9 * stiffness.cwiseAbs().maxCoeff()) {
    search.reason = "part of the stiffness is not requested";
    return search;
  }
  VectorXd spectrum(n);
  for (Index i = 0; i < n; ++i)
    spectrum[i] = std::pow(2.0 * std::numbers::pi * data.modes[static_cast<std::size_t>(i)].frequency_hz, 2);
  const MatrixXd matrix = springs * mass.llt().solve(MatrixXd(springs.transpose()));
  const SpectrumSolutions solutions =
      spectrum_solutions(0.5 * (matrix + matrix.transpose()), spectrum, progress);
  search.method = TwinSearch::Method::all_solutions;
  search.complex_solutions = solutions.complex_solutions;
  search.found = solutions.found;
  search.values = solutions.positive;
  return search;
}

bool is_stiffness(const std::string& quantity) {
  return quantity.ends_with("_stiffness") || quantity == "factor";
}

double unseen_probability(const Updating& updating) {
  std::size_t once = 0, all = 0;
  for (const ParameterSet& set : updating.sets) {
    once += set.starts == 1 ? 1 : 0;
    all += set.starts;
  }
  return all > 0 ? static_cast<double>(once) / static_cast<double>(all) : 1.0;
}

bool starts_say_little(const Updating& updating) {
  return unseen_probability(updating) > 0.5;
}

}  // namespace beamid::experiments
