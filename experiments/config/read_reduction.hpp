// Reductions to be compared, and the shape that one may be given.
#pragma once

#include <filesystem>

#include "experiments/config/channel_places.hpp"
#include "experiments/text/toml_table.hpp"
#include "reduction/reduction.hpp"

namespace beamid::experiments {

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
