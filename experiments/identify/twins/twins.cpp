#include "experiments/identify/twins/twins.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "experiments/identify/twins/spectrum_solutions.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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
  if (q != n) return fmt::format("{} parameters are asked about and there are {} degrees of freedom", q, n);
  if (given != n) return fmt::format("{} of {} frequencies were measured", given, n);
  for (const auto& slope : model.described().derivatives)
    if (slope.mass.nonZeros() > 0) return "a mass is asked about";
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
    search.reason = "part of the stiffness is not asked about";
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
