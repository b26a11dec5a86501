#include "apps/structure_starters.hpp"

namespace beamid::apps {
namespace {

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

[[parameters]]                      # what is asked: the storey between two floors
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

[[parameters]]                      # what is asked: the factors of groups
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

[[parameters]]                      # what is asked: the factors of groups
quantity = "factor"
name = "columns"
[[parameters]]
quantity = "damping_ratio"

[reduction]
method = "modal_truncation"
modes = 6
)toml";

constexpr const char* system_starter = R"toml(title = "matrices of one's own"

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

[[parameters]]                      # what is asked
quantity = "factor"
name = "k1"
[[parameters]]
quantity = "damping_ratio"

[reduction]
method = "none"                     # many unknowns take less time with one: modal_truncation, craig_bampton, ...
)toml";

}  // namespace

const std::vector<StructureStarter>& structure_starters() {
  static const std::vector<StructureStarter> kinds{{"chain", chain_starter, "position_m = 9"},
                                                   {"frame", frame_starter, "at = \"left.x\""},
                                                   {"space_frame", space_frame_starter, "at = \"a.x\""},
                                                   {"system", system_starter, "at = \"2\""}};
  return kinds;
}

}  // namespace beamid::apps
