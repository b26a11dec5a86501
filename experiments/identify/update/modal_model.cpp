#include "experiments/identify/update/modal_model.hpp"

#include <Eigen/Eigenvalues>
#include <stdexcept>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index most_dense_unknowns = 64;

}  // namespace

ModalModel::ModalModel(const fem::Structure& structure, int elements, std::vector<fem::Point> points,
                       AskedParameters asked, Index count)
    : structure_(structure), elements_(elements), points_(std::move(points)), asked_(std::move(asked)) {
  described_ = fem::assemble_parametric(structure_, elements_, points_, asked_.parameters);
  count_ = std::min(count, size());
  for (std::size_t j = 0; j < asked_.parameters.size(); ++j)
    slopes_.push_back({described_.stiffness_derivative(j), described_.derivatives[j].mass});
  if (!dense()) return;
  mass_0_ = described_.system.mass;
  stiffness_0_ = described_.system.stiffness.assembled();
  for (std::size_t j = 0; j < asked_.parameters.size(); ++j) {
    mass_0_ -= described_.values[static_cast<Index>(j)] * slopes_[j].mass;
    stiffness_0_ -= described_.values[static_cast<Index>(j)] * slopes_[j].stiffness;
  }
}

bool ModalModel::dense() const {
  return size() <= most_dense_unknowns;
}

std::pair<MatrixXd, MatrixXd> ModalModel::matrices(const VectorXd& values) const {
  if (!dense()) throw std::invalid_argument("the system is not small");
  MatrixXd mass = mass_0_, stiffness = stiffness_0_;
  for (std::size_t j = 0; j < slopes_.size(); ++j) {
    mass += values[static_cast<Index>(j)] * slopes_[j].mass;
    stiffness += values[static_cast<Index>(j)] * slopes_[j].stiffness;
  }
  return {mass, stiffness};
}

FoundModes ModalModel::found(const VectorXd& values, bool slopes) const {
  if (dense()) {
    const auto [mass, stiffness] = matrices(values);
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(stiffness, mass);
    if (solver.info() != Eigen::Success) throw std::runtime_error("the mass matrix is not positive definite");
    return {solver.eigenvalues(), solver.eigenvectors(), {}};
  }
  fem::Structure there = structure_;
  for (std::size_t j = 0; j < asked_.parameters.size(); ++j)
    if (fem::value_of(there, asked_.parameters[j]) != values[static_cast<Index>(j)])
      there = fem::with_value(there, asked_.parameters[j], values[static_cast<Index>(j)]);
  // A beam's mesh has nodes where its parameters begin and end; else the derivatives are not needed.
  return lowest_found_modes(
      there.is_beam() ? fem::assemble_parametric(there, elements_, points_, asked_.parameters).system
                      : fem::assemble(there, elements_, points_),
      count_, slopes);
}

PredictedModes ModalModel::at(const VectorXd& values, bool slopes) const {
  const FoundModes all = found(values, slopes);
  PredictedModes modes = seen_modes(all, described_.system.outputs, count_);
  if (slopes) add_slopes(all, described_.system.outputs, slopes_, modes);
  return modes;
}

}  // namespace beamid::experiments
