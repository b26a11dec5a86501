#include "experiments/config/read_gauge.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/schema.hpp"
#include "experiments/config/useless_keys.hpp"

namespace beamid::experiments {

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
  const fem::Beam& beam = structure.beam();
  double start = 0.0;
  const double x = position.value_or(0.0);
  for (const fem::Segment& segment : beam.segments) {
    const double s = (x - start) / segment.length;
    start += segment.length;
    if (s > 1.0 && &segment != &beam.segments.back()) continue;
    if (segment.section.outline.shape == fem::Outline::Shape::none) break;
    return 0.5 * segment.section.outline.height(std::min(s, 1.0));
  }
  table.miss("distance_m", expected + "; the section there has no height that would tell");
}

}  // namespace beamid::experiments
