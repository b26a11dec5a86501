// The tables [excitation], [[sensors]] and [simulation] of an experiment file.
#pragma once

#include <optional>
#include <vector>

#include "experiments/config/channel_places.hpp"
#include "experiments/record/record.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/structure.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
