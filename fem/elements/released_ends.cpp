#include "fem/elements/released_ends.hpp"

#include <Eigen/Eigenvalues>

namespace beamid::fem {
namespace {

using Eigen::Matrix3d;

constexpr double no_direction = 1e-9;  // squared sine of the angle between two directions that are one

ReleasedDirections released_axes(const SpaceFrame::End& end, const Matrix3d& axes) {
  ReleasedDirections directions(3, int{end.x} + int{end.y} + int{end.z});
  int column = 0;
  for (const auto& [released, axis] : {std::pair{end.x, 0}, {end.y, 1}, {end.z, 2}})
    if (released) directions.col(column++) = axes.col(axis);
  return directions;
}

// The directions within `from` that are across all of `without`.
ReleasedDirections across(const ReleasedDirections& from, const ReleasedDirections& without) {
  const Matrix3d kept = from * from.transpose() - without * without.transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(kept);
  return solver.eigenvectors().rightCols(from.cols() - without.cols());
}

}  // namespace

std::vector<std::array<ReleasedDirections, 2>> released_ends(const SpaceFrame& frame) {
  const std::size_t count = frame.joints.size();
  std::vector<std::array<ReleasedDirections, 2>> released(frame.members.size());
  std::vector<Matrix3d> turned(count, Matrix3d::Zero());  // sums of the directions in which a joint is turned
  std::vector<ReleasedDirections*> first(count, nullptr);
  for (std::size_t i = 0; i < frame.members.size(); ++i) {
    const SpaceFrame::Member& member = frame.members[i];
    const Matrix3d axes = frame.axes(i);
    released[i] = {released_axes(member.at_first, axes), released_axes(member.at_second, axes)};
    for (const auto& [joint, end] : {std::pair{member.first, 0}, {member.second, 1}}) {
      ReleasedDirections& own = released[i][static_cast<std::size_t>(end)];
      turned[static_cast<std::size_t>(joint)] += Matrix3d::Identity() - own * own.transpose();
      if (first[static_cast<std::size_t>(joint)] == nullptr) first[static_cast<std::size_t>(joint)] = &own;
    }
  }
  for (const SpaceFrame::Support& support : frame.supports)
    for (const auto& [held, axis] : {std::pair{support.rx, 0}, {support.ry, 1}, {support.rz, 2}})
      if (held) turned[static_cast<std::size_t>(support.joint)](axis, axis) += 1.0;
  for (std::size_t joint = 0; joint < count; ++joint) {
    if (first[joint] == nullptr || first[joint]->cols() == 0) continue;
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(turned[joint]);
    const Eigen::Index idle = (solver.eigenvalues().array() < no_direction).count();
    if (idle > 0) *first[joint] = across(*first[joint], solver.eigenvectors().leftCols(idle));
  }
  return released;
}

}  // namespace beamid::fem
