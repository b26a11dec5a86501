// A frame, plane or in space, whose groups of members are of unknown stiffness, its places by name.
#pragma once

#include <string>
#include <vector>

#include "fem/frame.hpp"
#include "fem/parametric_system.hpp"
#include "fem/space_frame.hpp"

namespace beamid::fem {

/// "NAME.x", "NAME.y" and in space "NAME.z" of every joint, as far as supports let it move there.
std::vector<std::string> frame_places(const Frame& frame);
std::vector<std::string> frame_places(const SpaceFrame& frame);

/// As assemble(frame), the points being places, the base moving along `frame.base_axis` or
/// `frame.base_direction` alone.
/// @throws std::invalid_argument also when a place does not exist or is held.
StructuralSystem assemble_at_places(const Frame& frame, int elements_per_member,
                                    const std::vector<Point>& points);
StructuralSystem assemble_at_places(const SpaceFrame& frame, int elements_per_member,
                                    const std::vector<Point>& points);

/// Factor on E I, E A, kappa G A and G J of the members of a group. @throws std::invalid_argument when the
/// parameter is no factor, or no member is of this group.
double value_of(const Frame& frame, const BeamParameter& parameter);
double value_of(const SpaceFrame& frame, const BeamParameter& parameter);
Frame with_value(const Frame& frame, const BeamParameter& parameter, double value);
SpaceFrame with_value(const SpaceFrame& frame, const BeamParameter& parameter, double value);

/// Derivatives are differences of two assemblies, exact to rounding, since D is linear in every factor.
ParametricSystem assemble_parametric(const Frame& frame, int elements_per_member,
                                     const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters);
ParametricSystem assemble_parametric(const SpaceFrame& frame, int elements_per_member,
                                     const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters);

}  // namespace beamid::fem
