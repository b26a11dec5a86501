// Nodes and elements.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem/beam.hpp"

namespace beamid::fem {

/// Lines cut into elements: in the plane, a straight beam on y = 0; or in space.
struct Mesh {
  struct Node {
    double x = 0.0, y = 0.0, z = 0.0;  ///< [m]
  };
  struct Element {
    int first = 0, second = 0;    ///< nodes
    int segment = 0;              ///< of the beam, or member of a frame
    double from = 0.0, to = 1.0;  ///< part of the segment that it covers, s as in Variation
    double length = 0.0;          ///< h [m], the same number for all elements between two breaks
    double remaining = 1.0;       ///< of the bending stiffness, below 1 where damaged
  };
  std::vector<Node> nodes;
  std::vector<Element> elements;
  bool spatial = false;  ///< a space frame's, which moves out of the plane of x and y

  Eigen::VectorXd positions() const;  ///< x of the nodes [m]

  /// The node at x. @throws std::invalid_argument when no node lies there, to 1e-9 of the beam's length.
  int node_at(double x) const;
};

/// Cuts a beam into `elements` of nearly equal length, with a node wherever something begins, ends or sits:
/// segments, bodies, supports, springs, dashpots, absorbers, damage, added mass, and the points [m] asked
/// for. Between two such breaks the elements are equally long. There are never fewer elements than breaks
/// demand.
/// @throws std::invalid_argument when the beam is impossible, elements < 1 or a point is off the beam.
Mesh cut(const Beam& beam, int elements, const std::vector<double>& points = {});

}  // namespace beamid::fem
