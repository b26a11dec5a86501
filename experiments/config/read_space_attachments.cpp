#include "experiments/config/read_space_attachments.hpp"

#include "experiments/config/key_tables.hpp"
#include "experiments/config/member_keys.hpp"
#include "experiments/config/vector_keys.hpp"

namespace beamid::experiments {
namespace {

using fem::SpaceFrame;

/// What the keys of vectors and lists hold.
struct GivenSpaceSupport {
  std::string kind;
  std::vector<std::string> holds;
};
struct GivenSpaceBody {
  double mass = 0.0;
  std::vector<double> inertia, offset;
};
struct GivenSpaceCoefficients {
  std::vector<double> translational, rotational;
};

const Schema<GivenSpaceSupport>& space_support_keys() {
  using S = GivenSpaceSupport;
  static const Schema<S> keys =
      at_joint(Schema<S>("space_frame.supports"), "which joint is held", "1")
          .key("kind", &S::kind, "all six motions, or the displacements alone", "\"pinned\"")
          .one_of({"clamped", "pinned"})
          .fallback("either this")
          .key("holds", &S::holds,
               "the displacements `x`, `y`, `z` and rotations `rx`, `ry`, `rz` that it holds",
               "[\"z\", \"rx\"]")
          .fallback("or this")
          .exactly_one("what the support holds", {"kind", "holds"});
  return keys;
}

const Schema<GivenSpaceBody>& space_body_keys() {
  using B = GivenSpaceBody;
  static const Schema<B> keys =
      at_joint(Schema<B>("space_frame.bodies"), "where", "2")
          .key("mass_kg", &B::mass, not_negative, "its mass", "120")
          .key("inertia_kg_m2", &B::inertia, not_negative, "about x, y and z through its own centre",
               "[3.5, 3.5, 5.0]")
          .fallback("none")
          .key("offset_m", &B::offset, "of its centre from the joint, rigidly: x, y, z", "[0, 0, 0.4]")
          .fallback("none")
          .at_least_one({"mass_kg", "inertia_kg_m2"});
  return keys;
}

struct CoefficientKey {
  const char *name, *meaning, *example;
};

/// Of springs or dashpots against the ground.
Schema<GivenSpaceCoefficients> coefficient_keys(const char* table, const char* joint,
                                                const CoefficientKey& translational,
                                                const CoefficientKey& rotational) {
  using G = GivenSpaceCoefficients;
  return at_joint(Schema<G>(table), joint, "3")
      .key(translational.name, &G::translational, not_negative, translational.meaning, translational.example)
      .fallback("none")
      .key(rotational.name, &G::rotational, not_negative, rotational.meaning, rotational.example)
      .fallback("none")
      .at_least_one({translational.name, rotational.name});
}

const Schema<GivenSpaceCoefficients>& space_spring_keys() {
  static const auto keys =
      coefficient_keys("space_frame.springs", "where",
                       {"translational_n_per_m", "k of forces along x, y and z", "[2e5, 2e5, 0]"},
                       {"rotational_n_m_per_rad", "k of moments about x, y and z", "[0, 0, 1e4]"});
  return keys;
}

const Schema<GivenSpaceCoefficients>& space_dashpot_keys() {
  static const auto keys =
      coefficient_keys("space_frame.dashpots", "where, against the ground",
                       {"translational_n_s_per_m", "c of velocities along x, y and z", "[150, 150, 0]"},
                       {"rotational_n_m_s_per_rad", "c of turning about x, y and z", "[0, 0, 20]"});
  return keys;
}

const bool space_attachment_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return space_support_keys(); }),
    register_keys([]() -> const KeyTable& { return space_body_keys(); }),
    register_keys([]() -> const KeyTable& { return space_spring_keys(); }),
    register_keys([]() -> const KeyTable& { return space_dashpot_keys(); })};

SpaceFrame::Support read_space_support(const TomlTable& table, const SpaceFrame& frame) {
  const GivenSpaceSupport given = space_support_keys().read(table);
  const bool all = given.kind == "clamped", pinned = all || given.kind == "pinned";
  SpaceFrame::Support support{
      read_joint(table, "joint", frame.joints.size()), pinned, pinned, pinned, all, all, all};
  set_named(table, "holds", given.holds,
            {{"x", &support.x},
             {"y", &support.y},
             {"z", &support.z},
             {"rx", &support.rx},
             {"ry", &support.ry},
             {"rz", &support.rz}});
  return support;
}

}  // namespace

void read_space_attachments(const TomlTable& table, SpaceFrame& frame) {
  for (const TomlTable& one : table.find_tables("supports"))
    frame.supports.push_back(read_space_support(one, frame));
  for (const TomlTable& one : table.find_tables("bodies")) {
    const GivenSpaceBody given = space_body_keys().read(one);
    frame.bodies.push_back({read_joint(one, "joint", frame.joints.size()), given.mass,
                            vector_of(one, "inertia_kg_m2", given.inertia),
                            vector_of(one, "offset_m", given.offset)});
  }
  for (const TomlTable& one : table.find_tables("springs")) {
    const GivenSpaceCoefficients given = space_spring_keys().read(one);
    frame.springs.push_back({read_joint(one, "joint", frame.joints.size()),
                             vector_of(one, "translational_n_per_m", given.translational),
                             vector_of(one, "rotational_n_m_per_rad", given.rotational)});
  }
  for (const TomlTable& one : table.find_tables("dashpots")) {
    const GivenSpaceCoefficients given = space_dashpot_keys().read(one);
    frame.dashpots.push_back({read_joint(one, "joint", frame.joints.size()),
                              vector_of(one, "translational_n_s_per_m", given.translational),
                              vector_of(one, "rotational_n_m_s_per_rad", given.rotational)});
  }
}

}  // namespace beamid::experiments
