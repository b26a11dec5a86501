#include "experiments/identify/model_check/cause_model.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace beamid::experiments {

using Eigen::Index, Eigen::VectorXd;

CauseModel::CauseModel(fem::Structure structure, int elements, std::vector<fem::Point> points,
                       std::vector<Candidate> causes, Index count)
    : structure_(std::move(structure)),
      elements_(elements),
      points_(std::move(points)),
      causes_(std::move(causes)) {
  for (const Candidate& cause : causes_) {
    Unknown unknown{cause.name, cause.unit, 0.0, cause.scale(), Form::bounded, cause.lower, cause.upper};
    unknown.quantity = cause.name;
    asked_.unknowns.push_back(std::move(unknown));
    asked_.has_prior.push_back(false);
  }
  described_ = fem::assemble(structure_, elements_, points_);
  count_ = std::min(count, described_.size());
}

fem::StructuralSystem CauseModel::assembled(const VectorXd& changes) const {
  fem::Structure there = structure_;
  for (std::size_t q = 0; q < causes_.size(); ++q)
    there = causes_[q].changed(there, changes[static_cast<Index>(q)]);
  std::vector<fem::Point> points = points_;
  if (there.is_beam()) {
    const double before = structure_.beam().length(), after = there.beam().length();
    for (fem::Point& point : points)
      point.position = point.position == before ? after : point.position * (after / before);
  }
  return fem::assemble(there, elements_, points);
}

// Central differences, of a compliance near zero by as much as it is; one-sided at the limits.
MatrixSlope CauseModel::slope(const VectorXd& changes, Index cause, Index n) const {
  const Candidate& of = causes_[static_cast<std::size_t>(cause)];
  if (of.of_clock) return {fem::SparseMatrix(n, n), fem::SparseMatrix(n, n)};
  const double scale = of.scale(), x = changes[cause],
               step = 1e-3 * std::min(scale, std::max(x - of.lower, 1e-6 * scale));
  VectorXd above = changes, below = changes;
  above[cause] = std::min(of.upper, x + step);
  below[cause] = std::max(of.lower, x - step);
  const fem::StructuralSystem more = assembled(above), less = assembled(below);
  if (more.size() != n || less.size() != n)
    throw std::runtime_error("a change of " + of.label + " changes the mesh");
  const double width = above[cause] - below[cause];
  return {(more.stiffness.assembled() - less.stiffness.assembled()) / width, (more.mass - less.mass) / width};
}

PredictedModes CauseModel::at(const VectorXd& changes, bool slopes) const {
  const fem::StructuralSystem system = causes_.empty() ? described_ : assembled(changes);
  const FoundModes found = lowest_found_modes(system, count_, slopes);
  PredictedModes modes = seen_modes(found, system.outputs, count_);
  if (slopes) {
    std::vector<MatrixSlope> changing;
    for (Index q = 0; q < changes.size(); ++q) changing.push_back(slope(changes, q, system.size()));
    add_slopes(found, system.outputs, changing, modes);
  }
  for (std::size_t q = 0; q < causes_.size(); ++q) {
    if (!causes_[q].of_clock) continue;
    const double rate = 1.0 + changes[static_cast<Index>(q)];
    if (slopes) modes.frequency_slopes *= rate;
    if (slopes) modes.frequency_slopes.col(static_cast<Index>(q)) = modes.frequency_hz;
    modes.frequency_hz *= rate;
  }
  return modes;
}

}  // namespace beamid::experiments
