#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_place.hpp"
#include "experiments/config/read_simulation.hpp"

namespace beamid::experiments {
namespace {

using Kind = Excitation::Kind;

/// An excitation as a file describes it: the amplitude in the unit of its kind.
struct DescribedExcitation : Excitation {
  std::string kind_name = to_string(Kind::release);
  std::optional<double> force_amplitude, acceleration_amplitude;
};

const std::vector<std::string>& excitation_kinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Kind kind :
         {Kind::release, Kind::step, Kind::impulse, Kind::harmonic, Kind::base, Kind::table, Kind::free})
      all.emplace_back(to_string(kind));
    return all;
  }();
  return names;
}

const Schema<DescribedExcitation>& excitation_keys() {
  using E = DescribedExcitation;
  constexpr int most_modes = 1000;
  static const Schema<E> keys =
      Schema<E>("excitation")
          .selected_by("kind")
          .key("kind", &E::kind_name, "see below", "\"impulse\"")
          .one_of(excitation_kinds())
          .key("position_m", &E::position, on_beam, "where the force acts or the beam is displaced", "1.1")
          .fallback("the tip, or midspan where the tip is held")
          .with({"release", "static", "impulse", "harmonic", "table", "none"})
          .key("at", &E::at, "in place of `position_m`, of a frame or a system", "\"ridge.x\"")
          .with({"release", "static", "impulse", "harmonic", "table", "none"})
          .key("deflection_m", &E::deflection,
               "release, none: at that point, in the static shape of a force there", "0.012")
          .fallback("`0.012` for release, else `0`")
          .with({"release", "none"})
          .key("velocity_m_per_s", &E::velocity, "none: at that point, in the same shape", "0.1")
          .with({"none"})
          .key("mode", &E::mode, {1, most_modes}, "none: the shape of this mode instead of the static one",
               "2")
          .with({"none"})
          .key("force_n", &E::force, "static: constant from t = 0 on", "10")
          .fallback("-")
          .needed_with({"static"})
          .key("momentum_n_s", &E::momentum, "impulse", "0.5")
          .fallback("-")
          .needed_with({"impulse"})
          .key("duration_s", &E::duration, not_negative,
               "impulse: half a sine of this duration; release: the time a hand takes to let go; 0 for an "
               "instant",
               "0.004")
          .with({"release", "impulse"})
          .key("amplitude_n", &E::force_amplitude, "harmonic: a sin(2 pi f t)", "2")
          .fallback("-")
          .needed_with({"harmonic"})
          .key("amplitude_m_per_s2", &E::acceleration_amplitude, "base: likewise", "1.5")
          .fallback("- (or `file`)")
          .with({"base"})
          .key("frequency_hz", &E::frequency_hz, positive, "harmonic, base", "4")
          .fallback("- (or `file`)")
          .needed_with({"harmonic"})
          .with({"harmonic", "base"})
          .key("file", &E::file, "table: a record with times and forces; base: with times and accelerations",
               "\"hammer.csv\"")
          .fallback("-")
          .needed_with({"table"})
          .with({"base", "table"})
          .excludes({"amplitude_m_per_s2", "frequency_hz"});
  return keys;
}

const bool excitation_keys_registered = register_keys([]() -> const KeyTable& { return excitation_keys(); });

}  // namespace

Excitation read_excitation(const TomlTable& table, const fem::Structure& structure) {
  DescribedExcitation read = excitation_keys().read(table, structure.extent());
  read.at = read_place(table, structure, read.kind_name != to_string(Kind::base));
  for (const Kind kind : {Kind::step, Kind::impulse, Kind::harmonic, Kind::base, Kind::table, Kind::free})
    if (read.kind_name == to_string(kind)) read.kind = kind;
  if (read.file && read.file->empty()) table.refuse("file", "the name of a file");
  if (read.kind == Kind::base && !read.file)
    for (const char* const key : {"amplitude_m_per_s2", "frequency_hz"})
      if (!table.contains(key)) table.miss(key, excitation_keys().find(key)->expected() + ", or a file");
  read.amplitude = read.force_amplitude ? *read.force_amplitude : read.acceleration_amplitude.value_or(0.0);
  read.place = table.place();
  return read;
}

}  // namespace beamid::experiments
