#include "experiments/config/read_frame_attachments.hpp"

#include "experiments/config/frame_description.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/config/member_keys.hpp"

namespace beamid::experiments {
namespace {

using fem::Frame;

std::vector<std::string> support_names() {
  std::vector<std::string> names;
  for (const auto& kind : frame_support_kinds()) names.push_back(kind.first);
  return names;
}

struct NamedFrameSupport {
  std::string kind;
};

const Schema<NamedFrameSupport>& frame_support_keys() {
  static const Schema<NamedFrameSupport> keys =
      at_joint(Schema<NamedFrameSupport>("frame.supports"), "which joint is held", "1")
          .key("kind", &NamedFrameSupport::kind, "how: see below", "\"pinned\"")
          .one_of(support_names())
          .required();
  return keys;
}

const Schema<Frame::Body>& frame_body_keys() {
  using B = Frame::Body;
  static const Schema<B> keys =
      at_joint(Schema<B>("frame.bodies"), "where", "2")
          .key("mass_kg", &B::mass, not_negative, "its mass", "120")
          .key("rotary_inertia_kg_m2", &B::rotary_inertia, not_negative, "about its own centre", "3.5")
          .at_least_one({"mass_kg", "rotary_inertia_kg_m2"});
  return keys;
}

const Schema<Frame::Spring>& frame_spring_keys() {
  using S = Frame::Spring;
  static const Schema<S> keys =
      at_joint(Schema<S>("frame.springs"), "where", "3")
          .key("translational_x_n_per_m", &S::x, not_negative, "k of a force along x", "2e5")
          .key("translational_y_n_per_m", &S::y, not_negative, "k of a force along y", "2e5")
          .key("rotational_n_m_per_rad", &S::rotational, not_negative, "k of a moment", "1e4")
          .at_least_one({"translational_x_n_per_m", "translational_y_n_per_m", "rotational_n_m_per_rad"});
  return keys;
}

const Schema<Frame::Dashpot>& frame_dashpot_keys() {
  using D = Frame::Dashpot;
  static const Schema<D> keys =
      at_joint(Schema<D>("frame.dashpots"), "where, against the ground", "3")
          .key("translational_x_n_s_per_m", &D::x, not_negative, "c of a velocity along x", "150")
          .key("translational_y_n_s_per_m", &D::y, not_negative, "c of a velocity along y", "150")
          .key("rotational_n_m_s_per_rad", &D::rotational, not_negative, "c of a turning", "20")
          .at_least_one(
              {"translational_x_n_s_per_m", "translational_y_n_s_per_m", "rotational_n_m_s_per_rad"});
  return keys;
}

const bool frame_attachment_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return frame_support_keys(); }),
    register_keys([]() -> const KeyTable& { return frame_body_keys(); }),
    register_keys([]() -> const KeyTable& { return frame_spring_keys(); }),
    register_keys([]() -> const KeyTable& { return frame_dashpot_keys(); })};

}  // namespace

void read_frame_attachments(const TomlTable& table, Frame& frame) {
  for (const TomlTable& one : table.find_tables("supports")) {
    const std::string name = frame_support_keys().read(one).kind;
    for (const auto& [kind, support] : frame_support_kinds())
      if (kind == name) frame.supports.push_back(support);
    frame.supports.back().joint = read_joint(one, "joint", frame.joints.size());
  }
  const auto read = [&](const char* name, const auto& keys, auto& attachments) {
    for (const TomlTable& one : table.find_tables(name)) {
      attachments.push_back(keys.read(one));
      attachments.back().joint = read_joint(one, "joint", frame.joints.size());
    }
  };
  read("bodies", frame_body_keys(), frame.bodies);
  read("springs", frame_spring_keys(), frame.springs);
  read("dashpots", frame_dashpot_keys(), frame.dashpots);
}

}  // namespace beamid::experiments
