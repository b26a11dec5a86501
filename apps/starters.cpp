#include "apps/starters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "apps/structure_starters.hpp"
#include "experiments/config/key_tables.hpp"

namespace beamid::apps {
namespace {

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

# [prior]                           # known beforehand; what is left out is worked out from beam and record
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

}  // namespace

const std::vector<std::string>& starter_structures() {
  static const std::vector<std::string> kinds{"beam", "chain", "frame", "space_frame", "system"};
  return kinds;
}

std::string starter_file(const std::string& structure) {
  if (structure == "beam") return annotated(beam_starter);
  const std::vector<StructureStarter>& kinds = structure_starters();
  const StructureStarter& kind =
      *std::find_if(kinds.begin(), kinds.end(), [&](const auto& one) { return structure == one.name; });
  const std::string place = kind.place, described = kind.text;
  return annotated(head + described +
                   with(with(with(tail, "release"), place + "\ndeflection_m = 0.01\n"), place));
}

}  // namespace beamid::apps
