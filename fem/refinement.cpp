#include "fem/refinement.hpp"

#include <stdexcept>
#include <string>

namespace beamid::fem {

Mesh refined(const Mesh& mesh, int parts) {
  if (parts < 1)
    throw std::invalid_argument("parts of an element are " + std::to_string(parts) + "; expected at least 1");
  Mesh fine;
  fine.nodes.push_back(mesh.nodes.front());
  for (const Mesh::Element& whole : mesh.elements) {
    const Mesh::Node &a = mesh.nodes[static_cast<std::size_t>(whole.first)],
                     &b = mesh.nodes[static_cast<std::size_t>(whole.second)];
    for (int i = 1; i <= parts; ++i) {
      const double begin = static_cast<double>(i - 1) / parts, end = static_cast<double>(i) / parts;
      Mesh::Element part = whole;
      part.first = static_cast<int>(fine.nodes.size()) - 1;
      part.second = part.first + 1;
      part.length = whole.length / parts;
      part.from = whole.from + begin * (whole.to - whole.from);
      part.to = i == parts ? whole.to : whole.from + end * (whole.to - whole.from);
      fine.elements.push_back(part);
      fine.nodes.push_back(i == parts ? b : Mesh::Node{a.x + end * (b.x - a.x), a.y + end * (b.y - a.y)});
    }
  }
  return fine;
}

}  // namespace beamid::fem
