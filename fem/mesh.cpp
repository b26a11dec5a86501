#include "fem/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

namespace beamid::fem {
namespace {

constexpr double same_place = 1e-9;  // of the beam's length

// Every place that needs a node, in order, each once.
std::vector<double> breaks(const Beam& beam, const std::vector<double>& points) {
  const double length = beam.length();
  std::vector<double> places{0.0};
  for (const Segment& segment : beam.segments) places.push_back(places.back() + segment.length);
  places.back() = length;
  for (const Body& body : beam.bodies) places.push_back(body.position);
  for (const Support& support : beam.supports) places.push_back(support.position);
  for (const Spring& spring : beam.springs) places.push_back(spring.position);
  for (const Dashpot& dashpot : beam.dashpots) places.push_back(dashpot.position);
  for (const Absorber& absorber : beam.absorbers) places.push_back(absorber.position);
  for (const Damage& damage : beam.damages) places.insert(places.end(), {damage.from, damage.to});
  for (const AddedMass& added : beam.added_masses) places.insert(places.end(), {added.from, added.to});
  places.insert(places.end(), points.begin(), points.end());
  std::sort(places.begin(), places.end());
  const auto same = [&](double a, double b) { return b - a < same_place * length; };
  places.erase(std::unique(places.begin(), places.end(), same), places.end());
  places.back() = length;
  return places;
}

// How many elements each interval gets, one at least: whichever would have the longest takes the next.
std::vector<int> share(const std::vector<double>& places, int elements) {
  const std::size_t intervals = places.size() - 1;
  std::vector<int> counts(intervals);
  const auto length = [&](std::size_t i) { return places[i + 1] - places[i]; };
  for (std::size_t i = 0; i < intervals; ++i)
    counts[i] = std::max(1, static_cast<int>(std::floor(length(i) / places.back() * elements * (1 + 1e-12))));
  for (int total = std::accumulate(counts.begin(), counts.end(), 0); total < elements; ++total) {
    std::size_t longest = 0;
    for (std::size_t i = 1; i < intervals; ++i)
      if (length(i) * counts[longest] > length(longest) * counts[i]) longest = i;
    ++counts[longest];
  }
  return counts;
}

// Floors alone have nodes: one between them would turn, and has no mass.
int storeys_between(const Beam& beam, const std::vector<double>& places) {
  if (places.size() == beam.segments.size() + 1) return static_cast<int>(beam.segments.size());
  std::ostringstream message;
  message << "a point lies between two floors; expected the height of one:";
  double height = 0.0;
  for (const Segment& storey : beam.segments) message << ' ' << (height += storey.length);
  throw std::invalid_argument(message.str() + " m");
}

// Element properties between two neighbouring breaks, both inside one segment.
Mesh::Element stretch(const Beam& beam, double from, double to) {
  Mesh::Element element;
  const double middle = 0.5 * (from + to);
  double begin = 0.0;
  while (element.segment + 1 < static_cast<int>(beam.segments.size()) &&
         middle > begin + beam.segments[element.segment].length)
    begin += beam.segments[element.segment++].length;
  const double length = beam.segments[element.segment].length;
  element.from = std::max(0.0, (from - begin) / length);
  element.to = std::min(1.0, (to - begin) / length);
  for (const Damage& damage : beam.damages)
    if (damage.from < middle && middle < damage.to) element.remaining *= 1.0 - damage.loss;
  return element;
}

}  // namespace

Eigen::VectorXd Mesh::positions() const {
  Eigen::VectorXd x(static_cast<Eigen::Index>(nodes.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = nodes[i].x;
  return x;
}

int Mesh::node_at(double x) const {
  const double slack = same_place * nodes.back().x;
  const auto node = std::lower_bound(nodes.begin(), nodes.end(), x - slack,
                                     [](const Node& candidate, double place) { return candidate.x < place; });
  if (node == nodes.end() || node->x > x + slack) {
    std::ostringstream message;
    message << "no node at " << x << " m; expected one of the mesh's";
    throw std::invalid_argument(message.str());
  }
  return static_cast<int>(node - nodes.begin());
}

Mesh cut(const Beam& beam, int elements, const std::vector<double>& points) {
  validate(beam);
  if (elements < 1)
    throw std::invalid_argument("elements is " + std::to_string(elements) + "; expected at least 1");
  for (const double x : points)
    if (!(x >= 0.0 && x <= beam.length())) {
      std::ostringstream message;
      message << "point is at " << x << " m; expected between 0 and the beam's length, " << beam.length()
              << " m";
      throw std::invalid_argument(message.str());
    }
  const std::vector<double> places = breaks(beam, points);
  if (beam.shear_building) elements = storeys_between(beam, places);
  const std::vector<int> counts = share(places, elements);
  Mesh mesh;
  mesh.nodes.push_back({0.0, 0.0});
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const Mesh::Element whole = stretch(beam, places[i], places[i + 1]);
    const int count = counts[i];
    for (int e = 0; e < count; ++e) {
      Mesh::Element element = whole;
      element.first = static_cast<int>(mesh.nodes.size()) - 1;
      element.second = element.first + 1;
      element.length = (places[i + 1] - places[i]) / count;
      const double step = (whole.to - whole.from) / count;
      element.from = whole.from + e * step;
      element.to = e + 1 == count ? whole.to : whole.from + (e + 1) * step;
      mesh.elements.push_back(element);
      mesh.nodes.push_back({e + 1 == count ? places[i + 1] : places[i] + (e + 1) * element.length, 0.0});
    }
  }
  return mesh;
}

}  // namespace beamid::fem
