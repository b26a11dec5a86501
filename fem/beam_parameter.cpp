// The values of a beam's parameters, and beams with others.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fem/beam.hpp"
#include "fem/parametric_system.hpp"
#include "fem/shear_building.hpp"

namespace beamid::fem {
namespace {

// A stretch of a beam: its bending stiffness, read and scaled.

using Region = std::pair<double, double>;  ///< from, to [m], along the beam

/// How far into a segment that begins at `start` a place lies, from 0 to 1; at its end where only the
/// rounding of sums of lengths tells it apart.
double share_of(const Segment& segment, double start, double place);

// Calls f(segment, begin, end) for the part of each segment in the region, s from 0 to 1.
template <class Function>
void for_each_part(const Beam& beam, const Region& region, const Function& f) {
  double start = 0.0;
  for (const Segment& segment : beam.segments) {
    const double begin = share_of(segment, start, region.first),
                 end = share_of(segment, start, region.second);
    if (begin < end) f(segment, start, begin, end);
    start += segment.length;
  }
}

Section stretched(const Section& section, double begin, double end, double factor) {
  Section result = section;
  for (Variation* quantity : {&result.bending_stiffness, &result.mass_per_length, &result.rotary_inertia,
                              &result.outline.width, &result.outline.height})
    *quantity = quantity->part(begin, end);
  for (auto* quantity : {&result.shear_stiffness, &result.axial_stiffness})
    if (*quantity) *quantity = (*quantity)->part(begin, end);
  result.bending_stiffness = Variation(factor) * result.bending_stiffness;
  if (result.shear_stiffness) result.shear_stiffness = Variation(factor) * *result.shear_stiffness;
  return result;
}

double share_of(const Segment& segment, double start, double place) {
  constexpr double rounding = 1e-12;
  const double share = (place - start) / segment.length;
  return share < rounding ? 0.0 : share > 1.0 - rounding ? 1.0 : share;
}

/// Integral of E I, damage included, over the region [N m3].
double bending_integral(const Beam& beam, const Region& region) {
  std::vector<double> places{region.first, region.second};
  for (const Damage& damage : beam.damages)
    for (const double x : {damage.from, damage.to})
      if (region.first < x && x < region.second) places.push_back(x);
  std::sort(places.begin(), places.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const double middle = 0.5 * (places[i] + places[i + 1]);
    double remaining = 1.0;
    for (const Damage& damage : beam.damages)
      if (damage.from < middle && middle < damage.to) remaining *= 1.0 - damage.loss;
    for_each_part(beam, {places[i], places[i + 1]}, [&](const Segment& segment, double, double s, double e) {
      sum += remaining * segment.length * (e - s) * segment.section.bending_stiffness.part(s, e).mean();
    });
  }
  return sum;
}

/// Segments are cut at the region's ends, those inside made stiffer by the factor, in shear too; the length
/// is kept to the last bit, for bodies sit at its end.
void scale_bending(Beam& beam, const Region& region, double factor) {
  const double length = beam.length();
  std::vector<Segment> segments;
  double start = 0.0;
  for (const Segment& segment : beam.segments) {
    const double begin = share_of(segment, start, region.first),
                 end = share_of(segment, start, region.second);
    if (begin == 0.0 && end == 1.0) {
      segments.push_back({segment.length, stretched(segment.section, 0.0, 1.0, factor), segment.dashpot});
    } else if (begin >= end) {
      segments.push_back(segment);
    } else {
      const auto piece = [&](double from, double to, double scale) {
        if (from < to)
          segments.push_back(
              {(to - from) * segment.length, stretched(segment.section, from, to, scale), segment.dashpot});
      };
      piece(0.0, begin, 1.0);
      piece(begin, end, factor);
      piece(end, 1.0, 1.0);
    }
    start += segment.length;
  }
  beam.segments = std::move(segments);
  for (int i = 0; i < 4 && beam.length() != length; ++i)
    beam.segments.back().length += length - beam.length();
}

using Quantity = BeamParameter::Quantity;

bool is_of_storeys(const BeamParameter& parameter) {
  return parameter.quantity == Quantity::storey_stiffness || parameter.quantity == Quantity::storey_damping;
}

Region region_of(const Beam& beam, const BeamParameter& parameter) {
  const double length = beam.length();
  if (!parameter.region) return {0.0, length};
  const auto [from, to] = *parameter.region;
  const bool has_regions = parameter.quantity == Quantity::bending_stiffness ||
                           parameter.quantity == Quantity::body_mass || is_of_storeys(parameter);
  if (has_regions && from >= 0.0 && from < to && to <= length) return *parameter.region;
  std::ostringstream message;
  message << "region is " << from << " to " << to << " m; expected ";
  if (has_regions)
    message << "a begin before its end, both between 0 and the beam's length, " << length << " m";
  else
    message << "none: only the bending stiffness, storeys and bodies have regions";
  throw std::invalid_argument(message.str());
}

// Calls f(storey) for those of the region.
template <class AnyBeam, class Function>
void for_each_storey(AnyBeam& beam, const Region& region, const Function& f) {
  if (!beam.shear_building)
    throw std::invalid_argument("the structure has no storeys; expected a shear building");
  double start = 0.0;
  for (auto& storey : beam.segments) {
    const double begin = share_of(storey, start, region.first), end = share_of(storey, start, region.second);
    start += storey.length;
    if (begin >= end) continue;
    if (begin != 0.0 || end != 1.0) {
      std::ostringstream message;
      message << "region is " << region.first << " to " << region.second
              << " m; expected ends at the heights of floors";
      throw std::invalid_argument(message.str());
    }
    f(storey);
  }
}

double mean_of_storeys(const Beam& beam, const Region& region, double (*value)(const Segment&)) {
  double sum = 0.0, count = 0.0;
  for_each_storey(beam, region, [&](const Segment& storey) { sum += value(storey), count += 1.0; });
  return sum / count;
}

// The bodies at the tip keep their proportions; without one that has any, the first one gets all of it.
void set_at_tip(Beam& beam, double Body::*property, double found, double value) {
  const double length = beam.length();
  bool given = false;
  for (Body& body : beam.bodies)
    if (body.position == length) {
      body.*property = found > 0.0 ? body.*property / found * value : given ? 0.0 : value;
      given = true;
    }
  if (given) return;
  Body body{length};
  body.*property = value;
  beam.bodies.push_back(body);
}

bool is_in(const Body& body, const Region& region) {
  return body.position >= region.first && body.position <= region.second;
}

double body_mass(const Beam& beam, const Region& region) {
  double sum = 0.0;
  for (const Body& body : beam.bodies)
    if (is_in(body, region)) sum += body.mass;
  if (sum > 0.0) return sum;
  std::ostringstream message;
  message << "no body with mass lies between " << region.first << " and " << region.second
          << " m; expected a region that holds one";
  throw std::invalid_argument(message.str());
}

auto first_at_tip(auto& beam) {
  return std::find_if(beam.bodies.begin(), beam.bodies.end(),
                      [&](const Body& body) { return body.position == beam.length(); });
}

double sum_at_root(const Beam& beam, double Spring::*property) {
  double sum = 0.0;
  for (const Spring& spring : beam.springs)
    if (spring.position == 0.0) sum += spring.*property;
  return sum;
}

double elastic_root(const Beam& beam, const BeamParameter& parameter) {
  const bool turns = parameter.quantity == Quantity::root_rotational_stiffness;
  const double sum = sum_at_root(beam, turns ? &Spring::rotational : &Spring::translational);
  if (sum > 0.0) return sum;
  throw std::invalid_argument(std::string("the beam has no elastic root: the stiffness of its root in ") +
                              (turns ? "rotation" : "translation") +
                              " is zero or infinite; expected a spring there that is positive");
}

}  // namespace

double value_of(const Beam& beam, const BeamParameter& parameter) {
  validate(beam);
  const Region region = region_of(beam, parameter);
  switch (parameter.quantity) {
    case Quantity::bending_stiffness:
      return bending_integral(beam, region) / (region.second - region.first);
    case Quantity::tip_mass:
      return first_at_tip(beam) == beam.bodies.end() ? 0.0 : first_at_tip(beam)->mass;
    case Quantity::body_mass:
      return body_mass(beam, region);
    case Quantity::tip_rotary_inertia: {
      double sum = 0.0;
      for (const Body& body : beam.bodies)
        if (body.position == beam.length()) sum += body.rotary_inertia;
      return sum;
    }
    case Quantity::root_rotational_stiffness:
    case Quantity::root_translational_stiffness:
      return elastic_root(beam, parameter);
    case Quantity::storey_stiffness:
      return mean_of_storeys(beam, region, storey_stiffness);
    case Quantity::storey_damping:
      return mean_of_storeys(beam, region, [](const Segment& storey) { return storey.dashpot; });
    case Quantity::factor:
      throw std::invalid_argument(
          "a beam has no named factors; expected a frame's group of members or a system's parameter");
    case Quantity::axial_load:
      break;
  }
  return beam.axial_load;
}

Beam with_value(const Beam& beam, const BeamParameter& parameter, double value) {
  const double found = value_of(beam, parameter);
  Beam changed = beam;
  const auto scale_at_root = [&](double Spring::*property) {
    for (Spring& spring : changed.springs)
      if (spring.position == 0.0) spring.*property *= value / found;
  };
  switch (parameter.quantity) {
    case Quantity::bending_stiffness:
      if (!(value > 0.0 && std::isfinite(value))) {
        std::ostringstream message;
        message << "bending stiffness is " << value << "; expected a positive number of N m2";
        throw std::invalid_argument(message.str());
      }
      scale_bending(changed, region_of(beam, parameter), value / found);
      break;
    case Quantity::tip_mass:
      if (first_at_tip(changed) == changed.bodies.end())
        changed.bodies.push_back({changed.length(), value, 0.0, 0.0});
      else
        first_at_tip(changed)->mass = value;
      break;
    case Quantity::body_mass:
      for (Body& body : changed.bodies)
        if (is_in(body, region_of(beam, parameter))) body.mass *= value / found;
      break;
    case Quantity::tip_rotary_inertia:
      set_at_tip(changed, &Body::rotary_inertia, found, value);
      break;
    case Quantity::root_rotational_stiffness:
      scale_at_root(&Spring::rotational);
      break;
    case Quantity::root_translational_stiffness:
      scale_at_root(&Spring::translational);
      break;
    case Quantity::axial_load:
      changed.axial_load = value;
      break;
    case Quantity::storey_stiffness:
      scale_bending(changed, region_of(beam, parameter), value / found);
      break;
    case Quantity::storey_damping:
      for_each_storey(changed, region_of(beam, parameter), [&](Segment& storey) {
        storey.dashpot = found > 0.0 ? storey.dashpot * (value / found) : value;
      });
      break;
    case Quantity::factor:  // value_of() has refused it
      break;
  }
  validate(changed);
  return changed;
}

Beam with_nodes(const Beam& beam, const std::vector<double>& positions) {
  Beam result = beam;
  const double length = beam.length();
  for (const double x : positions) {
    if (!(x >= 0.0 && x <= length)) {
      std::ostringstream message;
      message << "node is at " << x << " m; expected between 0 and the beam's length, " << length << " m";
      throw std::invalid_argument(message.str());
    }
    if (x > 0.0 && x < length) result.damages.push_back({0.0, x, 0.0});
  }
  return result;
}

}  // namespace beamid::fem
