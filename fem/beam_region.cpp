#include "fem/beam_region.hpp"

#include <algorithm>
#include <vector>

namespace beamid::fem {
namespace {

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

}  // namespace

double share_of(const Segment& segment, double start, double place) {
  constexpr double rounding = 1e-12;
  const double share = (place - start) / segment.length;
  return share < rounding ? 0.0 : share > 1.0 - rounding ? 1.0 : share;
}

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

}  // namespace beamid::fem
