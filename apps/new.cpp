// beamid new: a commented experiment file to start from.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "apps/command.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::apps {
namespace {

// The part of a starter file that describes a structure other than a beam.

struct StructureStarter {
  const char* name;   ///< of --structure
  const char* text;   ///< its tables
  const char* place;  ///< the keys of a place on it, for an excitation and a channel
};

constexpr const char* chain_starter = R"toml(title = "three floors"

[chain]                             # from the lowest floor up; [[chain.layers]] for a column of soil
masses_kg = [1000, 1000, 800]
stiffnesses_n_per_m = [2.0e6, 1.6e6, 1.2e6]
heights_m = [3, 3, 3]               # places are heights above the base
# dashpots_n_s_per_m = [300, 240, 180]

# [[chain.storeys]]                 # a storey that is not linear; laws: beamid list springs
# storey = 1
# law = "duffing"
# cubic_stiffness_n_per_m3 = 5.0e8

[[sensors]]                         # accelerations are absolute
position_m = 3
noise_m_per_s2 = 0.01
[[sensors]]
position_m = 9
noise_m_per_s2 = 0.01

[[parameters]]                      # to be determined: the storey between two floors
quantity = "storey_stiffness"
from_m = 0
to_m = 3
[[parameters]]
quantity = "storey_stiffness"
from_m = 3
to_m = 9
[[parameters]]
quantity = "damping_ratio"

[reduction]
method = "none"
)toml";

constexpr const char* frame_starter = R"toml(title = "a portal frame"

[frame]
elements_per_member = 4
base_motion = "x"                   # along which axis a moving base goes
joints = [
  { name = "left_foot", x_m = 0, y_m = 0 }, { name = "left", x_m = 0, y_m = 3 },
  { name = "right", x_m = 4, y_m = 3 }, { name = "right_foot", x_m = 4, y_m = 0 },
]
supports = [{ joint = 1, kind = "clamped" }, { joint = 4, kind = "clamped" }]
bodies = [{ joint = 2, mass_kg = 800 }, { joint = 3, mass_kg = 800 }]

[[frame.members]]                   # joints by their number, from 1
first = 1
second = 2
group = "columns"                   # members of a group share a factor on E I and E A
width_m = 0.1
height_m = 0.1
youngs_modulus_pa = 2.1e11
density_kg_per_m3 = 7850
# stiffness_factor = 0.8            # of a member that has lost a fifth
# axial_load_n = 5e4                # of compression, at rest, which softens it
[[frame.members]]
first = 4
second = 3
group = "columns"
width_m = 0.1
height_m = 0.1
youngs_modulus_pa = 2.1e11
density_kg_per_m3 = 7850
[[frame.members]]
first = 2
second = 3
group = "girder"
width_m = 0.1
height_m = 0.12
youngs_modulus_pa = 2.1e11
density_kg_per_m3 = 7850

[[sensors]]                         # a place is a joint and a direction
at = "left.x"
noise_m_per_s2 = 0.01
[[sensors]]
at = "left.y"
noise_m_per_s2 = 0.01

[[parameters]]                      # to be determined: the factors of groups
quantity = "factor"
name = "columns"
[[parameters]]
quantity = "damping_ratio"

[reduction]
method = "modal_truncation"
modes = 4
)toml";

constexpr const char* space_frame_starter = R"toml(title = "a table of steel"

[space_frame]
elements_per_member = 6
base_direction = [1, 0, 0]          # in which a moving base goes: x, y, z
joints = [                          # numbered from 1 in this order; z is upwards in pictures
  { x_m = 0, y_m = 0, z_m = 0 }, { x_m = 4, y_m = 0, z_m = 0 }, { x_m = 4, y_m = 3, z_m = 0 }, { x_m = 0, y_m = 3, z_m = 0 },
  { name = "a", x_m = 0, y_m = 0, z_m = 3 }, { name = "b", x_m = 4, y_m = 0, z_m = 3 },
  { name = "c", x_m = 4, y_m = 3, z_m = 3 }, { name = "d", x_m = 0, y_m = 3, z_m = 3 },
]
members = [                         # a section's height is along z, of a column's along x; or section_z, roll_deg
  { first = 1, second = 5, section = "column", group = "columns" }, { first = 2, second = 6, section = "column", group = "columns" },
  { first = 3, second = 7, section = "column", group = "columns" }, { first = 4, second = 8, section = "column", group = "columns" },
  { first = 5, second = 6, section = "girder", group = "girders" }, { first = 6, second = 7, section = "girder", group = "girders" },
  { first = 7, second = 8, section = "girder", group = "girders" }, { first = 8, second = 5, section = "girder", group = "girders" },
]
supports = [                        # or holds = ["x", "z", "ry"], whichever motions are held
  { joint = 1, kind = "clamped" }, { joint = 2, kind = "clamped" }, { joint = 3, kind = "clamped" }, { joint = 4, kind = "clamped" },
]
bodies = [{ joint = 5, mass_kg = 600 }, { joint = 6, mass_kg = 600 }, { joint = 7, mass_kg = 600 }, { joint = 8, mass_kg = 600 }]
# dashpots = [{ joint = 5, translational_n_s_per_m = [150, 0, 0] }]    # against the ground; springs likewise
# members also have axial_load_n = 5e4 (compression at rest, which softens), stiffness_factor = 0.8

[[space_frame.sections]]
name = "column"
shape = "tube"                      # rectangle, circle, tube, i, or constants
diameter_m = 0.1143
wall_m = 0.006
youngs_modulus_pa = 2.1e11
poissons_ratio = 0.3
density_kg_per_m3 = 7850
[[space_frame.sections]]
name = "girder"
shape = "i"
width_m = 0.1
height_m = 0.2
web_m = 0.0056
flange_m = 0.0085
youngs_modulus_pa = 2.1e11
poissons_ratio = 0.3
density_kg_per_m3 = 7850

[[sensors]]                         # a place is a joint and a direction
at = "a.x"
noise_m_per_s2 = 0.01
[[sensors]]
at = "d.x"
noise_m_per_s2 = 0.01

[[parameters]]                      # to be determined: the factors of groups
quantity = "factor"
name = "columns"
[[parameters]]
quantity = "damping_ratio"

[reduction]
method = "modal_truncation"
modes = 6
)toml";

constexpr const char* system_starter = R"toml(title = "user-supplied matrices"

# Matrix Market files beside this one; from Python:
#   from scipy.io import mmwrite
#   mmwrite("M.mtx", M); mmwrite("K0.mtx", K0); mmwrite("K1.mtx", K1)      # K = K0 + k1 K1
[system]
mass = "M.mtx"
stiffness = "K0.mtx"
# damping = "C.mtx"
# labels = ["floor1", "floor2"]     # of the unknowns; else "1", "2", ...
# base_motion = [1, 1]              # how far each unknown goes when all supports move by 1 m

[[system.parameters]]               # factors on parts of K, M or C
name = "k1"
stiffness = "K1.mtx"

[[sensors]]                         # a place is the label of an unknown
at = "2"
noise_m_per_s2 = 0.01

[[parameters]]                      # to be determined
quantity = "factor"
name = "k1"
[[parameters]]
quantity = "damping_ratio"

[reduction]
method = "none"                     # many unknowns take less time with one: modal_truncation, craig_bampton, ...
)toml";

const std::vector<StructureStarter>& structure_starters() {
  static const std::vector<StructureStarter> kinds{{"chain", chain_starter, "position_m = 9"},
                                                   {"frame", frame_starter, "at = \"left.x\""},
                                                   {"space_frame", space_frame_starter, "at = \"a.x\""},
                                                   {"system", system_starter, "at = \"2\""}};
  return kinds;
}

// The commented experiment files that `beamid new` writes.

constexpr const char* beam_starter =
    R"toml(# An experiment for beamid: the beam and what is done with it. Put your own values in place of these.
# Numbers are SI, and keys carry the unit. Lines behind # show what else may stand there; docs/configuration.md has
# every key.  Check:      beamid validate FILE
#             compute:    beamid modes --config FILE        (simulate, frf: likewise)
#             identify:   beamid identify RECORD --config FILE --out results
title = "steel cantilever with a tip mass"

[beam]                              # a uniform cantilever; segments, taper, springs, damage, ...: see every key
length_m = 1.10
width_m = 0.060                     # of the section, across the direction of bending
height_m = 0.006                    # of the section, along the direction of bending
youngs_modulus_pa = 2.12e11
# bending_stiffness_n_m2 = 228.96   # E I, instead of youngs_modulus_pa, width_m and height_m
mass_kg = 3.055
# mass_per_length_kg_per_m = 2.777  # instead of mass_kg
# density_kg_per_m3 = 7850          # instead of mass_kg, with width_m and height_m
tip_mass_kg = 0.360
# tip_rotary_inertia_kg_m2 = 1e-4
# tip_eccentricity_m = 0.02
sensor_mass_kg = 0.0
# support = "clamped-free"
# axial_load_n = 10.0
# theory = "timoshenko"             # with poissons_ratio; else Euler-Bernoulli
# poissons_ratio = 0.3
# elements = 40

[record]                            # a text file of numbers in columns
file = "record.csv"                 # relative to this file; a RECORD on the command line comes first
# header_lines = 23                 # when more than one line stands before the numbers
# sampling_rate_hz = 1000.0         # when the printed times are rounded, or there are none
# window_s = [0.8, 1.6]             # part of the record to use; damping often depends on amplitude, hence on it
time = { column = 1, unit = "s" }   # by number from 1, or by name: column = "Time"; units s, ms, us
channels = [                        # what was measured at the tip, in which column and unit
  { quantity = "acceleration", column = 2, unit = "m/s2" },  # m/s2, mm/s2 or g
  # { quantity = "displacement", column = 3, unit = "mm" },  # m, mm or um
]

# [damping]                         # for modes, simulate and frf
# ratio = 0.002                     # of every mode; Rayleigh's law and others: see every key

# [excitation]                      # for simulate
# kind = "release"
# deflection_m = 0.012

# [simulation]                      # for simulate
# duration_s = 5.0
# sampling_rate_hz = 1000.0

# [frequency_response]              # for frf
# from_hz = 1.0
# to_hz = 200.0

[filter]
method = "ekf"
discretisation = "exponential"      # beamid list discretisations; this one is exact at any step

# [reduction]
# method = "rayleigh"

# [prior]                           # known beforehand; what is omitted is worked out from beam and record
# stiffness_n_per_m = 510.0
# stiffness_deviation_n_per_m = 150.0
# damping_ratio = 0.01
# damping_ratio_deviation = 0.01

# [noise]                           # standard deviation; estimated from the record unless given
# acceleration_m_per_s2 = 0.05
)toml";

constexpr const char* head =
    R"toml(# An experiment for beamid: a structure and what is done with it. Put your own values in place of these.
# Numbers are SI, and keys carry the unit; docs/configuration.md has every key.
#   beamid validate FILE;  beamid modes --config FILE;  beamid identifiability --config FILE
#   beamid simulate --config FILE --out shaken;  beamid identify shaken/record.csv --config FILE --out results
)toml";

constexpr const char* tail = R"toml(
[damping]
ratio = 0.02

[excitation]                        # for simulate
kind = "%s"
%s
[simulation]
duration_s = 20
sampling_rate_hz = 100

# [record]                          # a file of your own: which column is what
# file = "record.csv"
# time = { column = 1, unit = "s" }
# channels = [{ quantity = "acceleration", column = 2, unit = "g", %s }]

[model]
name = "beam"                       # the structure itself, whichever it is
)toml";

/// What a key is, in a line: its values where they are few, else the first clause of what its row says,
/// behind the values of another key with which it has a use. Empty where that takes more words.
std::string short_meaning(const experiments::Key& key) {
  constexpr std::size_t few = 9;
  if (!key.allowed.empty() && key.allowed.size() <= few)
    return fmt::format("{}", fmt::join(key.allowed, ", "));
  std::string meaning = key.meaning;
  std::erase(meaning, '`');
  if (const std::size_t colon = meaning.find(": "); !key.with.empty() && colon != std::string::npos)
    meaning.erase(0, colon + 2);
  meaning = meaning.substr(0, meaning.find(';'));
  const bool asks_for_more = meaning.find(": ") != std::string::npos && key.allowed.empty();
  return asks_for_more || meaning.starts_with("in place of") ? "" : meaning;
}

/// "# rigid mass at the tip" behind "tip_mass_kg = 0.360": what the key's row says of it, as far as a
/// line holds it, where the starter says nothing itself.
std::string annotated(const std::string& starter) {
  constexpr std::size_t column = 36, width = 118;
  const experiments::KeyTable* table = experiments::find_key_table("");
  std::istringstream lines(starter);
  std::string text;
  for (std::string line; std::getline(lines, line); text += line + "\n") {
    const std::size_t first = line.find_first_not_of("# "), equals = line.find(" = ");
    if (first == std::string::npos) continue;
    if (const std::size_t name = line.find_first_not_of('[', first); line[first] == '[')
      table = experiments::find_key_table(line.substr(name, line.find(']') - name));
    if (table == nullptr || equals == std::string::npos || line.find(" #", first) != std::string::npos ||
        line.find('{') != std::string::npos)
      continue;
    const experiments::Key* const key = table->find(line.substr(first, equals - first));
    if (key == nullptr) continue;
    const std::string meaning = short_meaning(*key);
    if (meaning.empty() || column + meaning.size() > width) continue;
    line.resize(std::max(column, line.size() + 2), ' ');
    line += "# " + meaning;
  }
  return text;
}

std::string with(std::string text, const std::string& value) {
  return text.replace(text.find("%s"), 2, value);
}

/// "beam", "chain", "frame", "space_frame", "system".
const std::vector<std::string>& starter_structures() {
  static const std::vector<std::string> kinds{"beam", "chain", "frame", "space_frame", "system"};
  return kinds;
}

/// The whole file for one of these.
std::string starter_file(const std::string& structure) {
  if (structure == "beam") return annotated(beam_starter);
  const std::vector<StructureStarter>& kinds = structure_starters();
  const StructureStarter& kind =
      *std::find_if(kinds.begin(), kinds.end(), [&](const auto& one) { return structure == one.name; });
  const std::string place = kind.place, described = kind.text;
  return annotated(head + described +
                   with(with(with(tail, "release"), place + "\ndeflection_m = 0.01\n"), place));
}

namespace fs = std::filesystem;
using experiments::InputError;

int run_new(const Values& values) {
  const fs::path file = values.texts("file")[0];
  const std::string starter = starter_file(values.text("structure"));
  if (file == "-") {
    std::cout << starter;
    return 0;
  }
  if (fs::is_directory(file))
    throw InputError({file.string()}, "a directory; expected the name of a new file");
  if (fs::exists(file) && !values.has("force"))
    throw InputError({file.string()}, "exists; choose another name, or replace it with --force");
  const fs::path folder = fs::absolute(file).parent_path();
  if (!fs::is_directory(folder)) throw InputError({file.string()}, "no folder '" + folder.string() + "'");
  experiments::write_file(file, starter);
  std::cout << "Written: " << file.string()
            << "\nNext: put your structure and record in, then: beamid validate " << file.string() << "\n";
  return 0;
}

}  // namespace

Command new_command() {
  return {
      "new",
      "FILE [--structure KIND] [--force]",
      "a commented experiment file to start from",
      {{.name = "file", .required = true, .hint = "('-' for standard output)"}},
      {{"Options",
        {text("structure", "KIND", "what the file describes: " + experiments::joined(starter_structures()))
             .one_of(starter_structures())
             .by_default("beam"),
         flag("force", "replace a file that exists")}}},
      "  beamid new cantilever.toml\n  beamid new building.toml --structure chain\n  beamid new - | less\n",
      run_new};
}

}  // namespace beamid::apps
