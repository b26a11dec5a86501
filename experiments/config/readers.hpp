// The table [beam] of an experiment file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/config/schema.hpp"
#include "experiments/modal/modal_data.hpp"
#include "experiments/models/unknown.hpp"
#include "experiments/record/record.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/beam.hpp"
#include "fem/frame.hpp"
#include "fem/matrix_system.hpp"
#include "fem/space_frame.hpp"
#include "fem/structure.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {

/// One segment described in [beam] itself, or several in [[beam.segments]] (readers.hpp); how its ends
/// are held; what sits on it (read_beam.cpp). The sensor's mass rides on the tip, beside the tip mass.
/// @throws InputError for missing, contradicting and useless keys at the table's place or the key's, for a
/// bad value at its own.
fem::Beam read_beam(const TomlTable& table);

/// Finite elements along the beam.
int read_elements(const TomlTable& table);

/// @throws std::invalid_argument where memory does not hold a mesh and so many of its modes
/// (memory_need.hpp).
void require_mesh_memory(double elements, double modes = 0);

/// "clamped-free" and every other pair of clamped, pinned, guided, free: root first, then tip.
const std::vector<std::string>& end_supports();

/// The supports at the ends of a beam. @param name one of end_supports(); "clamped-free", "pinned-guided",
/// ...
std::vector<fem::Support> supports_of(const std::string& name, double length);

// The table [frame] of an experiment file.

struct FrameExperiment {
  fem::Frame frame;
  int elements_per_member = 20;
};

/// Reads and checks the table; docs/configuration.md lists the keys. Joints are numbered from 1 in the order
/// of the file. A member's axial stiffness is given, or E A where Young's modulus and the dimensions are.
/// @throws InputError naming file, line and column, what was found and what was expected.
FrameExperiment read_frame(const TomlTable& table);

// The table [space_frame] of an experiment file.

struct SpaceFrameExperiment {
  fem::SpaceFrame frame;
  int elements_per_member = 8;
};

/// Reads and checks the table; docs/configuration.md lists the keys. Joints are numbered from 1 in the order
/// of the file, sections have names.
/// @throws InputError naming file, line and column, what was found and what was expected.
SpaceFrameExperiment read_space_frame(const TomlTable& table);

// One segment of a beam, as [beam] or [[beam.segments]] describes it.

/// The keys of a segment: its length and those of its section.
const KeyTable& segment_keys();

/// Stiffness: E I as such, or E with the dimensions of a rectangle, E I = E width height^3 / 12, or of a
/// circle, E pi diameter^4 / 64. Mass: in total, per length, or as a density with the dimensions. Dimensions
/// may go linearly to others at the segment's end, and with them all that follows from them; a total mass is
/// then spread in proportion to the section's area.
///
/// Timoshenko: kappa G A as such, or from the shear modulus, G = E / (2 (1 + nu)) unless given, and Cowper's
/// shear factor [cowper1966] unless given. Rotary inertia: rho I as such, or rho A times the section's I / A.
///
/// @throws InputError for missing, contradicting and useless keys, and for a bad value, at its own place.
fem::Segment read_segment(const TomlTable& table);

/// The same where the length [m] follows from something else, such as the joints of a frame's member.
fem::Section read_section(const TomlTable& table, double length);

// The table [system] of an experiment file: matrices of the user's own.

// [[substructures]] of an experiment file.

/// The parts in the order of the file; none without.
/// @param structure whose sections or places they are between
/// @throws InputError for a missing, a useless or a bad value, and where a name is there twice.
std::vector<PartOfStructure> read_parts(const TomlTable& root, const fem::Structure& structure);

/// Matrices are Matrix Market files beside the experiment file.
/// @throws InputError at a key, in a matrix's file, and where sizes differ.
fem::MatrixSystem read_system(const TomlTable& table);

// The tables [[parameters]] of an experiment file.

// What is assumed before a record is seen: [prior] and [noise] of an experiment file.

// What `beamid identifiability` looks at: [identifiability].

const Schema<IdentifiabilitySettings>& identifiability_keys();

/// @param root of the file. @throws InputError at a value of the wrong type or out of range.
void read_prior(const TomlTable& root, Experiment& experiment);

/// What the record is asked about. Whether the model has such a parameter the model says when it is made.
/// @param root the file's root table; @param structure to which regions and factors must belong
/// @throws InputError for a missing, a useless or a bad value.
std::vector<ParameterChoice> read_parameters(const TomlTable& root, const fem::Structure& structure);

// Measured modes from a file: TOML with [[modes]], the results.json of `beamid modal`, or a Universal File.

/// TOML: one table [[modes]] for each mode with frequency_hz, frequency_standard_deviation_hz or
/// frequency_relative_deviation, shape (a number for each of the experiment's sensors, in their order),
/// shape_standard_deviation, and `mode`, its number, where it is known (docs/theory/updating.md).
///
/// JSON: what `beamid modal --out` writes. Channels belong to the sensors of their names or, where no name
/// is a sensor's, in their order; accelerations and velocities become displacements by powers of i omega,
/// complex shapes the real ones nearest to them. Of several records the merged frequencies are used.
///
/// Universal File: datasets 55 (modal/universal_modes.hpp). A sensor along a beam is the node at its
/// position; else the degrees of freedom that move belong to the sensors in their order.
///
/// Modes are sorted by frequency; where the file has another order, a remark says so.
/// @throws InputError naming place, what was found and what was expected.
ModalData read_modal_data(const std::filesystem::path& file, const Experiment& experiment);

/// Whether a file is one of those, by its ending or, of a Universal File, by a dataset 55; else it is a
/// record.
bool holds_modes(const std::filesystem::path& file);

// Where something sits on a structure: a position along a beam, or the name of a place of any other.

/// What `at` says; empty for beams, where `position_m` says it.
/// @param needed `at` must be there, where places have names
/// @throws InputError at `at` beside a beam, at `position_m` beside anything else, at a name that is none of
/// the structure's places.
std::string read_place(const TomlTable& table, const fem::Structure& structure, bool needed,
                       const std::string& at = "at", const std::string& position = "position_m");

/// "one of the places ridge.x, ridge.y, eaves.x, ... (12 in all)"
std::string expected_place(const fem::Structure& structure);

// The table [record] of an experiment file.

struct RecordSection {
  std::optional<std::string> file;  ///< relative to the TOML file's folder
  RecordFormat format;
};

/// Units are stated, never guessed.
/// @param structure on which the sensors sit; null where none is described: positions are then not checked
/// against its length, and a strain gauge's distance from the axis has no default.
/// @throws InputError at the key, for missing ones at the table.
RecordSection read_record_section(const TomlTable& record, const fem::Structure* structure);

/// The same of a file that need not describe anything else. @throws InputError as above.
RecordSection read_record_section(const std::filesystem::path& file);

// The tables [excitation], [[sensors]] and [simulation] of an experiment file.

// The table [acquisition] of an experiment file, and the defects in [[sensors]].

/// @param root the file's root. @throws InputError for an impossible value.
Acquisition read_acquisition(const TomlTable& root);

/// @param structure to which every place must belong.
/// @throws InputError for a missing, a useless or a bad value.
Excitation read_excitation(const TomlTable& table, const fem::Structure& structure);

/// Each of [[excitations]], which act at the same time; none without.
/// @param root of the file. @throws InputError also beside [excitation].
std::vector<Excitation> read_simultaneous_excitations(const TomlTable& root, const fem::Structure& structure);

/// @param root of the file.
std::vector<Sensor> read_sensors(const TomlTable& root, const fem::Structure& structure);

/// What each of the sensors does wrong. @param root of the file.
std::vector<SensorDefects> read_defects(const TomlTable& root);

/// Keys that are none of its own are options of the method. @throws InputError as above, and for unknown
/// options.
Simulation read_simulation(const TomlTable& table);

// Where a sensor sits, and how far from the axis a strain gauge is glued.

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

// [[unknown_forces]], [[virtual_sensors]] and [fatigue] of an experiment file.

/// In the order of the file; none without.
/// @throws InputError for a missing, a useless or a bad value, and where a name is there twice.
std::vector<UnknownForce> read_unknown_forces(const TomlTable& root, const fem::Structure& structure);
std::vector<VirtualSensor> read_virtual_sensors(const TomlTable& root, const fem::Structure& structure);
std::optional<FatigueLaw> read_fatigue(const TomlTable& root);

/// A sensor of the bending moment at a section, M = E I w'' [N m]: distance is -E I there.
/// @throws std::invalid_argument where the structure has no sections
VirtualSensor bending_moment_at(const fem::Beam& beam, double position);

// Reductions to be compared, and the shape that one may be given.

/// One table of [[reductions]], in the form of [reduction].
/// @throws InputError at the name of an unknown method or option, or at a value that the method refuses.
Choice read_reduction(const TomlTable& table);

/// Reads shape_file beside a method already chosen.
/// @throws InputError when the method takes no shape, so that the file would change nothing.
void read_shape_file(const TomlTable& table, Choice& choice);

/// Whether a reduction learns a shape from a file: one of its options is "given".
bool takes_shape(const Choice& choice);

/// A deflection from a text file of two columns, position_m and deflection (in any unit: only ratios matter),
/// a row for each place and as many as it takes. The columns may have names, which must then be these.
/// @param length of the beam, on which the positions lie [m].
/// @throws InputError naming file, line and column.
reduction::Training read_shape(const std::filesystem::path& file, double length);

/// A reduction written as on the command line: "guyan", "modal_truncation:modes=3",
/// "guyan:masters_m=0.4/0.8/1.1", "rayleigh:shape=given,shape_file=shape.csv". The numbers of a list are
/// parted by "/"; the type of a value is that of the method's own option.
/// @param origin stands for the place in messages: "--reduction".
/// @throws InputError.
Choice parse_reduction(const std::string& text, const std::string& origin);

/// The same text again, without the options that are at their defaults.
std::string to_text(const Choice& choice);

// The methods chosen: [reduction], [model], [filter], and what is compared: [[reductions]], [[filters]],
// [compare].

/// Methods are completed with the defaults of their options; an absent table means the Experiment's own
/// default.
/// @param root table of the file. @throws InputError at an unknown method, discretisation or option.
void read_methods(const TomlTable& root, Experiment& experiment);

}  // namespace beamid::experiments
