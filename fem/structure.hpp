// Whatever can be described and assembled: a beam, a plane frame, a space frame, matrices of a user's own.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "fem/assembly.hpp"
#include "fem/frame.hpp"
#include "fem/matrix_system.hpp"
#include "fem/parametric_system.hpp"
#include "fem/space_frame.hpp"

namespace beamid::fem {

// A frame, plane or in space, whose groups of members are of unknown stiffness, its places by name.

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

/// One of the kinds of structures. What is common to all are the functions below; what only a beam has, a
/// length or sections, is asked of beam(), which says so where there is none.
class Structure {
 public:
  Structure() = default;
  Structure(Beam beam) : kind_(std::move(beam)) {}                  // NOLINT(google-explicit-constructor)
  Structure(Frame frame) : kind_(std::move(frame)) {}               // NOLINT(google-explicit-constructor)
  Structure(SpaceFrame frame) : kind_(std::move(frame)) {}          // NOLINT(google-explicit-constructor)
  Structure(MatrixSystem matrices) : kind_(std::move(matrices)) {}  // NOLINT(google-explicit-constructor)

  bool is_beam() const { return std::holds_alternative<Beam>(kind_); }
  const Frame* frame() const { return std::get_if<Frame>(&kind_); }
  const SpaceFrame* space_frame() const { return std::get_if<SpaceFrame>(&kind_); }
  const MatrixSystem* matrices() const { return std::get_if<MatrixSystem>(&kind_); }

  /// @throws std::invalid_argument "this needs a beam; found a frame" where it is none.
  const Beam& beam() const;
  Beam& beam() { return const_cast<Beam&>(std::as_const(*this).beam()); }

  /// Whether a place is a position along it [m]; else it has a name (Point::place).
  bool has_positions() const { return is_beam(); }

  /// Whether it is a chain of storeys.
  bool is_chain() const { return is_beam() && beam().shear_building; }

  /// "beam", "chain", "frame", "space_frame", "system": the table of an experiment file that describes it.
  const char* kind() const;

  /// Of a beam its length, of a frame the diagonal of the rectangle or box around it, of matrices 1 [m].
  double extent() const;

 private:
  std::variant<Beam, Frame, SpaceFrame, MatrixSystem> kind_;
};

/// Names of all places that can move, in their order: "ridge.x" of a frame, labels of a system; none where
/// places have positions.
std::vector<std::string> place_names(const Structure& structure);

/// Names of all factors that may be asked about: groups of members, parameters of a system.
std::vector<std::string> factor_names(const Structure& structure);

/// Where forces act and motion is observed unless said otherwise; the first of the named places.
Point natural_point(const Structure& structure);

/// As assemble() of its kind, `elements` being of a frame those of each member, of no meaning for matrices:
/// each point an input and an output, the last input base_acceleration.
/// @throws std::invalid_argument also when a point's place is none of the structure's.
StructuralSystem assemble(const Structure& structure, int elements, const std::vector<Point>& points);
StructuralSystem assemble(const Structure& structure, int elements);

/// As value_of(), with_value() and assemble_parametric() of a beam (parametric_system.hpp).
double value_of(const Structure& structure, const BeamParameter& parameter);
Structure with_value(const Structure& structure, const BeamParameter& parameter, double value);
ParametricSystem assemble_parametric(const Structure& structure, int elements,
                                     const std::vector<Point>& points,
                                     const std::vector<BeamParameter>& parameters);

}  // namespace beamid::fem
