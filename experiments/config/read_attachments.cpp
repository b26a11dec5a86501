#include "experiments/config/read_attachments.hpp"

#include <fmt/format.h>

#include "experiments/config/useless_keys.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

double value(const TomlTable& table, const std::string& key, Sign sign = Sign::not_negative) {
  return table.find_number(key, sign).value_or(0.0);
}

void require_one(const TomlTable& table, const std::vector<std::string>& keys) {
  if (given_keys(table, keys).empty())
    throw InputError(table.place(), fmt::format("{} has no effect; expected at least one of {}", table.name(),
                                                joined(keys)));
}

struct LoadedStretch {
  double from, to;
};

LoadedStretch stretch(const TomlTable& table, double length) {
  const LoadedStretch read{position_on_beam(table, "from_m", length),
                           position_on_beam(table, "to_m", length)};
  if (read.from >= read.to) table.refuse("to_m", fmt::format("a number above from_m, {}", read.from));
  return read;
}

fem::Support support(const TomlTable& table, double length) {
  const std::vector<std::string> kinds{"clamped", "pinned", "guided"};
  const auto kind = table.find_text("kind", kinds);
  const double position = position_on_beam(table, "position_m", length);
  if (!kind) table.miss("kind", "one of " + joined(kinds));
  return {position, *kind != "guided", *kind != "pinned"};
}

}  // namespace

double position_on_beam(const TomlTable& table, const std::string& key, double length) {
  const std::string expected = fmt::format("a number from 0 to the beam's length, {}", length);
  const auto position = table.find_number(key);
  if (!position) table.miss(key, expected);
  if (*position < 0.0 || *position > length) table.refuse(key, expected);
  return *position;
}

void read_attachments(const TomlTable& table, fem::Beam& beam) {
  const double length = beam.length();
  for (const TomlTable& body : table.find_tables("bodies")) {
    const double mass = value(body, "mass_kg"), inertia = value(body, "rotary_inertia_kg_m2");
    const double eccentricity = value(body, "eccentricity_m", Sign::any);
    beam.bodies.push_back({position_on_beam(body, "position_m", length), mass, inertia, eccentricity});
    require_one(body, {"mass_kg", "rotary_inertia_kg_m2"});
  }
  for (const TomlTable& one : table.find_tables("supports")) beam.supports.push_back(support(one, length));
  for (const TomlTable& spring : table.find_tables("springs")) {
    const double translational = value(spring, "translational_n_per_m");
    const double rotational = value(spring, "rotational_n_m_per_rad");
    const double cubic = value(spring, "cubic_n_per_m3", Sign::any);
    beam.springs.push_back(
        {position_on_beam(spring, "position_m", length), translational, rotational, cubic});
    require_one(spring, {"translational_n_per_m", "rotational_n_m_per_rad", "cubic_n_per_m3"});
  }
  for (const TomlTable& dashpot : table.find_tables("dashpots")) {
    const double translational = value(dashpot, "translational_n_s_per_m");
    const double rotational = value(dashpot, "rotational_n_m_s_per_rad");
    const double quadratic = value(dashpot, "quadratic_n_s2_per_m2");
    beam.dashpots.push_back(
        {position_on_beam(dashpot, "position_m", length), translational, rotational, quadratic});
    require_one(dashpot, {"translational_n_s_per_m", "rotational_n_m_s_per_rad", "quadratic_n_s2_per_m2"});
  }
  for (const TomlTable& absorber : table.find_tables("absorbers")) {
    const double damping = value(absorber, "damping_n_s_per_m");
    const double mass = absorber.number("mass_kg", Sign::positive);
    const double stiffness = absorber.number("stiffness_n_per_m", Sign::positive);
    beam.absorbers.push_back({position_on_beam(absorber, "position_m", length), mass, stiffness, damping});
  }
  for (const TomlTable& damage : table.find_tables("damages")) {
    const LoadedStretch where = stretch(damage, length);
    const auto loss = damage.find_number("loss", Sign::not_negative);
    if (!loss) damage.miss("loss", "a number from 0 to below 1");
    if (*loss >= 1.0) damage.refuse("loss", "a number from 0 to below 1");
    beam.damages.push_back({where.from, where.to, *loss});
  }
  for (const TomlTable& added : table.find_tables("added_masses")) {
    const LoadedStretch where = stretch(added, length);
    beam.added_masses.push_back(
        {where.from, where.to, added.number("mass_per_length_kg_per_m", Sign::not_negative)});
  }
}

}  // namespace beamid::experiments
