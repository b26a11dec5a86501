#include "fem/beam.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace beamid::fem {
namespace {

/// A phrase of a message in two parts, put together only where there is one: beams are checked at every set
/// of parameters that a search tries.
struct Phrase {
  std::string_view first, second;
  Phrase(const char* words) : first(words) {}
  Phrase(std::string_view one, std::string_view other) : first(one), second(other) {}
};

void require(bool valid, const Phrase& name, double value, const Phrase& expected) {
  if (valid && std::isfinite(value)) return;
  std::ostringstream message;
  message << name.first << name.second << " is " << value << "; expected " << expected.first
          << expected.second;
  throw std::invalid_argument(message.str());
}

// A section's end may vanish (a sharp tip), to rounding, and nothing may be negative in between.
void validate(const Section& section, const std::string& where) {
  const auto positive = [&](const Variation& quantity, const char* name, const char* unit) {
    const double rounding = 1e-12 * std::abs(quantity(0.5));
    if (quantity.is_constant())
      return require(quantity(0.5) > 0.0, {where, name}, quantity(0.5), {"a positive number of ", unit});
    for (const double s : {0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0})
      require(s == 0.0 || s == 1.0 ? quantity(s) >= -rounding : quantity(s) > 0.0, {where, name}, quantity(s),
              {"a positive number of ", unit});
  };
  positive(section.bending_stiffness, "bending stiffness", "N m2");
  positive(section.mass_per_length, "mass per length", "kg/m");
  if (section.shear_stiffness) positive(*section.shear_stiffness, "shear stiffness", "N");
  if (section.axial_stiffness) positive(*section.axial_stiffness, "axial stiffness", "N");
  for (const double s : {0.0, 0.5, 1.0})
    require(section.rotary_inertia(s) >= -1e-12 * std::abs(section.rotary_inertia(0.5)),
            {where, "rotary inertia"}, section.rotary_inertia(s), "zero or a positive number of kg m");
}

}  // namespace

double Beam::length() const {
  double sum = 0.0;
  for (const Segment& segment : segments) sum += segment.length;
  return sum;
}

double Beam::mass() const {
  double sum = 0.0;
  for (const Segment& segment : segments) sum += segment.length * segment.section.mass_per_length.mean();
  for (const AddedMass& added : added_masses) sum += (added.to - added.from) * added.mass_per_length;
  return sum;
}

double Beam::tip_mass() const {
  double sum = 0.0;
  for (const Body& body : bodies)
    if (body.position == length()) sum += body.mass;
  return sum;
}

void validate(const Beam& beam) {
  if (beam.segments.empty()) throw std::invalid_argument("the beam has no segment; expected at least one");
  for (std::size_t i = 0; i < beam.segments.size(); ++i) {
    const std::string where = beam.segments.size() == 1 ? "" : "segment " + std::to_string(i + 1) + ": ";
    require(beam.segments[i].length > 0.0, {where, "length"}, beam.segments[i].length,
            "a positive number of metres");
    validate(beam.segments[i].section, where);
  }
  const double length = beam.length();
  const auto on_beam = [&](double x, const char* what) {
    if (x >= 0.0 && x <= length) return;
    std::ostringstream span;
    span << "between 0 and the beam's length, " << length << " m";
    require(false, what, x, span.str().c_str());
  };
  // The deflection there under a force, the integral of x^2 / EI, has no bound.
  const bool sharp_root = beam.segments.front().section.bending_stiffness(0.0) <= 0.0,
             sharp_tip = beam.segments.back().section.bending_stiffness(1.0) <= 0.0;
  const auto carried = [&](double x, const char* what) {
    on_beam(x, what);
    require(!(sharp_root && x == 0.0) && !(sharp_tip && x == length), what, x,
            "a place off the sharp end, which carries no load");
  };
  const auto stretch = [&](double from, double to, const char* what) {
    on_beam(from, what), on_beam(to, what);
    require(from < to, what, from, "a begin before its end");
  };
  for (const Body& body : beam.bodies) {
    const char* const name = body.position == length ? "tip" : "body";
    carried(body.position, "position of a body");
    require(body.mass >= 0.0, {name, " mass"}, body.mass, "zero or a positive number of kg");
    require(body.rotary_inertia >= 0.0, {name, " rotary inertia"}, body.rotary_inertia,
            "zero or a positive number of kg m2");
    require(true, {name, " eccentricity"}, body.eccentricity, "a finite number of metres");
  }
  for (const AddedMass& added : beam.added_masses) {
    stretch(added.from, added.to, "added mass");
    require(added.mass_per_length >= 0.0, "added mass per length", added.mass_per_length,
            "zero or a positive number of kg/m");
  }
  for (const Damage& damage : beam.damages) {
    stretch(damage.from, damage.to, "damage");
    require(damage.loss >= 0.0 && damage.loss < 1.0, "loss of stiffness", damage.loss,
            "a number from 0 to below 1");
  }
  for (const Support& support : beam.supports) on_beam(support.position, "position of a support");
  for (const Spring& spring : beam.springs) {
    carried(spring.position, "position of a spring");
    require(spring.translational >= 0.0, "spring stiffness", spring.translational,
            "zero or a positive number of N/m");
    require(spring.rotational >= 0.0, "rotational spring stiffness", spring.rotational,
            "zero or a positive number of N m/rad");
    require(true, "cubic spring stiffness", spring.cubic, "a finite number of N/m3");
  }
  for (const Dashpot& dashpot : beam.dashpots) {
    carried(dashpot.position, "position of a dashpot");
    require(dashpot.translational >= 0.0, "dashpot", dashpot.translational,
            "zero or a positive number of N s/m");
    require(dashpot.rotational >= 0.0, "rotational dashpot", dashpot.rotational,
            "zero or a positive number of N m s/rad");
    require(dashpot.quadratic >= 0.0, "quadratic dashpot", dashpot.quadratic,
            "zero or a positive number of N s2/m2");
  }
  for (const Absorber& absorber : beam.absorbers) {
    carried(absorber.position, "position of an absorber");
    require(absorber.mass > 0.0, "absorber mass", absorber.mass, "a positive number of kg");
    require(absorber.stiffness > 0.0, "absorber stiffness", absorber.stiffness, "a positive number of N/m");
    require(absorber.damping >= 0.0, "absorber damping", absorber.damping,
            "zero or a positive number of N s/m");
  }
  require(true, "axial load", beam.axial_load, "a finite number of N");
}

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
