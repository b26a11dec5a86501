#include "experiments/config/read_gauge.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/schema.hpp"
#include "experiments/config/useless_keys.hpp"

namespace beamid::experiments {

SectionPlace section_at(const fem::Beam& beam, double position) {
  double start = 0.0;
  for (const fem::Segment& segment : beam.segments) {
    const double s = (position - start) / segment.length;
    start += segment.length;
    if (s <= 1.0 || &segment == &beam.segments.back()) return {&segment.section, std::clamp(s, 0.0, 1.0)};
  }
  return {};
}

void check_gauge_position(const TomlTable& table, const fem::Structure& structure, Quantity quantity) {
  if (quantity != Quantity::strain) return;
  if (!structure.is_beam() || structure.is_chain())
    throw InputError(table.value_place("quantity"),
                     fmt::format("a {} has no sections whose strain could be read; expected displacement, "
                                 "velocity or acceleration",
                                 structure.kind()));
  if (!table.contains("position_m"))
    table.miss("position_m", Key{.name = "position_m", .range = on_beam}.expected(structure.extent()));
}

double gauge_distance(const TomlTable& table, const fem::Structure& structure, Quantity quantity,
                      const std::optional<double>& position, const std::optional<double>& given) {
  if (quantity != Quantity::strain) {
    refuse_useless(table, {"distance_m"}, std::string("for the quantity ") + to_string(quantity),
                   "quantity = \"strain\", or no distance_m");
    return 0.0;
  }
  if (given && *given != 0.0) return *given;
  const std::string expected = "a number of metres that is not zero: how far the gauge is from the axis";
  if (given) table.refuse("distance_m", expected);
  const SectionPlace there = section_at(structure.beam(), position.value_or(0.0));
  if (there.section && there.section->outline.shape != fem::Outline::Shape::none)
    return 0.5 * there.section->outline.height(there.along);
  table.miss("distance_m", expected + "; the section there has no height that would tell");
}

}  // namespace beamid::experiments
