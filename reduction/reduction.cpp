#include "reduction/reduction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "fem/parametric_system.hpp"
#include "reduction/constrained_statics.hpp"

namespace beamid::reduction {

ReductionRegistry& reduction_registry() {
  static ReductionRegistry registry("reduction");
  return registry;
}

ReducedModel reduce(const fem::StructuralSystem& system, const Reduction& reduction,
                    const Training& training) {
  return project(system, reduction.bases(system, training));
}

namespace {

using Eigen::Index, Eigen::MatrixXd;
using Kind = fem::Coordinate::Kind;

constexpr double held = 1e-3;  // of the largest deflection: how much a held point may seem to move

[[noreturn]] void refuse(const std::string& owner, const std::string& what) {
  throw std::invalid_argument(owner + ": " + what);
}

void check(const fem::StructuralSystem& system, const Training& training, const std::string& owner) {
  if (training.empty()) refuse(owner, "no deflections given; expected some points with their deflections");
  if (training.positions.size() != training.deflections.rows())
    refuse(owner, std::to_string(training.positions.size()) + " positions and " +
                      std::to_string(training.deflections.rows()) + " deflections; expected as many");
  if (!training.positions.allFinite() || !training.deflections.allFinite())
    refuse(owner, "a position or deflection is not finite");
  if ((training.deflections.array() == 0.0).all()) refuse(owner, "all deflections are zero");
  if (system.mesh.nodes.empty()) refuse(owner, "needs a mesh; this system is a reduced one");
  for (const fem::Coordinate& coordinate : system.coordinates)
    if (coordinate.kind == Kind::axial)
      refuse(owner, "positions along a beam do not determine points of a frame");
}

// Rows that read the deflection anywhere on the beam.
class DeflectionReader {
 public:
  DeflectionReader(const fem::StructuralSystem& system, const std::string& owner)
      : system_(system), owner_(owner), nodes_(system.mesh.positions()) {
    deflection_.assign(system.mesh.nodes.size(), -1);
    rotation_ = deflection_;
    for (std::size_t i = 0; i < system.coordinates.size(); ++i) {
      const fem::Coordinate& coordinate = system.coordinates[i];
      if (coordinate.kind == Kind::deflection) deflection_[coordinate.node] = static_cast<int>(i);
      if (coordinate.kind == Kind::rotation) rotation_[coordinate.node] = static_cast<int>(i);
    }
  }

  /// Appends row `row` to `entries`. @returns whether the point can move at all.
  bool read(double position, int row, fem::Triplets& entries) const {
    const double length = nodes_.maxCoeff() - nodes_.minCoeff(), same = 1e-9 * length;
    if (!(position >= nodes_.minCoeff() - same && position <= nodes_.maxCoeff() + same)) {
      std::ostringstream message;
      message << "position " << position << " m is off the beam; expected " << nodes_.minCoeff() << " to "
              << nodes_.maxCoeff() << " m";
      refuse(owner_, message.str());
    }
    const double place = std::clamp(position, nodes_.minCoeff(), nodes_.maxCoeff());
    for (const fem::Mesh::Element& element : system_.mesh.elements) {
      const double begin = nodes_[element.first], end = nodes_[element.second];
      if (place < begin - same || place > end + same) continue;
      const double h = end - begin, s = (place - begin) / h;
      const bool at_begin = place - begin <= same, at_end = end - place <= same;
      const std::array<double, 4> weight = at_begin ? std::array<double, 4>{1, 0, 0, 0}
                                           : at_end ? std::array<double, 4>{0, 0, 1, 0}
                                                    : hermite(s);
      const std::array<int, 4> column = {deflection_[element.first], rotation_[element.first],
                                         deflection_[element.second], rotation_[element.second]};
      bool moves = false;
      for (std::size_t i = 0; i < 4; ++i) {
        if (column[i] < 0 || weight[i] == 0.0) continue;
        const bool turns = i % 2 == 1;
        entries.emplace_back(row, column[i],
                             weight[i] * (turns ? h / system_.coordinates[column[i]].scale : 1.0));
        moves = true;
      }
      return moves;
    }
    refuse(owner_, "a position lies on no element");
  }

 private:
  const fem::StructuralSystem& system_;
  const std::string& owner_;
  Eigen::VectorXd nodes_;
  std::vector<int> deflection_, rotation_;  // coordinate of each node, -1 where held

  // w per (w_1, h theta_1, w_2, h theta_2)
  static std::array<double, 4> hermite(double s) {
    const double r = 1.0 - s;
    return {r * r * (1.0 + 2.0 * s), s * r * r, s * s * (3.0 - 2.0 * s), -s * s * r};
  }
};

}  // namespace

MatrixXd static_interpolation(const fem::StructuralSystem& system, const Training& training,
                              const std::string& owner) {
  check(system, training, owner);
  const DeflectionReader reader(system, owner);
  const double largest = training.deflections.cwiseAbs().maxCoeff();
  fem::Triplets entries;
  std::vector<Index> moving;
  for (Index i = 0; i < training.positions.size(); ++i) {
    const double position = training.positions[i];
    std::ostringstream message;
    if ((training.positions.head(i).array() == position).any()) {
      message << "position " << position << " m is given twice";
      refuse(owner, message.str());
    }
    if (reader.read(position, static_cast<int>(moving.size()), entries)) {
      moving.push_back(i);
    } else if (const double moved = training.deflections.row(i).cwiseAbs().maxCoeff();
               moved > held * largest) {
      message << "the deflection at " << position << " m is " << moved
              << ", but a support holds it; expected 0";
      refuse(owner, message.str());
    }
  }
  if (moving.empty()) refuse(owner, "supports hold every point that is given");
  const auto constraints = fem::sparse(static_cast<Index>(moving.size()), system.size(), entries);
  MatrixXd shapes = MatrixXd::Zero(system.size(), training.positions.size());
  shapes(Eigen::all, moving) = ConstrainedStatics(system, constraints, owner).unit_shapes();
  return shapes;
}

}  // namespace beamid::reduction
