#include "experiments/config/member_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fem/buckling.hpp"

namespace beamid::experiments {
namespace {

// On a mesh that serves for the buckling of members alone, too.
template <class AnyFrame>
void refuse_buckled_frame(const TomlTable& table, const AnyFrame& frame, std::size_t most_members) {
  const bool pressed = std::any_of(frame.members.begin(), frame.members.end(),
                                   [](const auto& member) { return member.axial_load > 0.0; });
  if (!pressed || frame.members.size() > most_members) return;
  const auto factor = fem::buckling_factor(frame);
  if (factor && *factor <= 1.0)
    throw InputError(
        table.place(),
        fmt::format("the frame buckles at {:.6g} times the axial_load_n of its members; expected "
                    "loads that it bears",
                    *factor));
}

}  // namespace

const Schema<GivenMember>& common_member_keys() {
  using M = GivenMember;
  static const Schema<M> keys =
      Schema<M>("members")
          .key("stiffness_factor", &M::stiffness_factor, positive,
               "of E I, E A, kappa G A and in space G J: `0.8` for a member that has lost a fifth", "0.8")
          .key("group", &M::group,
               "members of one group share a factor that `[[parameters]]` can ask about, `quantity = "
               "\"factor\"` with the group as `name`",
               "\"columns\"")
          .fallback("none")
          .key("axial_load_n", &M::axial_load,
               "P, positive in compression: what the member carries at rest, which softens it", "5e4");
  return keys;
}

void check_elements_per_member(const TomlTable& table, std::size_t members) {
  table.find_whole_number("elements_per_member", 1, std::max(1, most_elements / static_cast<int>(members)));
}

void refuse_buckled(const TomlTable& table, const fem::Frame& frame) {
  refuse_buckled_frame(table, frame, 150);
}

void refuse_buckled(const TomlTable& table, const fem::SpaceFrame& frame) {
  refuse_buckled_frame(table, frame, 75);  // of twice the coordinates
}

}  // namespace beamid::experiments
