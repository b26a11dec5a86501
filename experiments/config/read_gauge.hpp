// Where a sensor sits, and how far from the axis a strain gauge is glued.
#pragma once

#include <optional>

#include "experiments/record/record.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

/// The section of a beam at a position, and how far along its segment that is, 0 to 1; null without segments.
struct SectionPlace {
  const fem::Section* section = nullptr;
  double along = 0.0;
};
SectionPlace section_at(const fem::Beam& beam, double position);

/// @throws InputError when a strain gauge has no `position_m`, or sits on no beam with sections.
void check_gauge_position(const TomlTable& table, const fem::Structure& structure, Quantity quantity);

/// `distance_m` of a strain gauge from the axis, c of -c w'' [m], positive on the side of positive
/// deflection; absent: half the section's height there. Zero for other quantities.
/// @throws InputError when the key stands beside another quantity, or the section has no drawn height.
/// @param position of a strain gauge [m] @param given what the file says [m]
double gauge_distance(const TomlTable& table, const fem::Structure& structure, Quantity quantity,
                      const std::optional<double>& position, const std::optional<double>& given);

}  // namespace beamid::experiments
