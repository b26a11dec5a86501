#include "experiments/config/key_tables.hpp"
#include "experiments/config/readers.hpp"

namespace beamid::experiments {
namespace {

using Kind = Excitation::Kind;

constexpr Kind all_kinds[] = {Kind::release, Kind::step, Kind::impulse, Kind::harmonic,
                              Kind::random,  Kind::base, Kind::table,   Kind::free};

/// An excitation as a file describes it: the amplitude in the unit of its kind.
struct DescribedExcitation : Excitation {
  std::string kind_name = to_string(Kind::release);
  std::optional<double> force_amplitude, acceleration_amplitude;
};

const std::vector<std::string>& excitation_kinds() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Kind kind : all_kinds) all.emplace_back(to_string(kind));
    return all;
  }();
  return names;
}

/// The same keys for [excitation] and for each of [[excitations]].
const Schema<DescribedExcitation>& with_excitation_keys(Schema<DescribedExcitation>& table) {
  using E = DescribedExcitation;
  constexpr int most_modes = 1000;
  return table.selected_by("kind")
      .key("kind", &E::kind_name, "see below", "\"impulse\"")
      .one_of(excitation_kinds())
      .key("position_m", &E::position, on_beam, "where the force acts or the beam is displaced", "1.1")
      .fallback("the tip, or midspan where the tip is held")
      .with({"release", "static", "impulse", "harmonic", "random", "table", "none"})
      .key("at", &E::at, "in place of `position_m`, of a frame or a system", "\"ridge.x\"")
      .with({"release", "static", "impulse", "harmonic", "random", "table", "none"})
      .key("deflection_m", &E::deflection,
           "release, none: at that point, in the static shape of a force there", "0.012")
      .fallback("`0.012` for release, else `0`")
      .with({"release", "none"})
      .key("velocity_m_per_s", &E::velocity, "none: at that point, in the same shape", "0.1")
      .with({"none"})
      .key("mode", &E::mode, {1, most_modes}, "none: the shape of this mode instead of the static one", "2")
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
      .key("amplitude_n", &E::force_amplitude,
           "harmonic: a sin(2 pi f t); random: root mean square of normal numbers", "2")
      .fallback("-")
      .needed_with({"harmonic", "random"})
      .key("amplitude_m_per_s2", &E::acceleration_amplitude, "base: likewise", "1.5")
      .fallback("- (or `file`)")
      .with({"base"})
      .key("frequency_hz", &E::frequency_hz, positive,
           "harmonic, base; random: 2 f numbers a second, straight between them", "4")
      .fallback("- (or `file`)")
      .needed_with({"harmonic", "random"})
      .with({"harmonic", "random", "base"})
      .key("file", &E::file, "table: a record with times and forces; base: with times and accelerations",
           "\"hammer.csv\"")
      .fallback("-")
      .needed_with({"table"})
      .with({"base", "table"})
      .excludes({"amplitude_m_per_s2", "frequency_hz"});
}

const Schema<DescribedExcitation>& excitation_keys() {
  static Schema<DescribedExcitation> table("excitation");
  static const Schema<DescribedExcitation>& keys = with_excitation_keys(table);
  return keys;
}

const Schema<DescribedExcitation>& simultaneous_excitation_keys() {
  static Schema<DescribedExcitation> table("excitations");
  static const Schema<DescribedExcitation>& keys = with_excitation_keys(table);
  return keys;
}

const bool excitation_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return excitation_keys(); }),
    register_keys([]() -> const KeyTable& { return simultaneous_excitation_keys(); })};

Excitation read_with(const Schema<DescribedExcitation>& keys, const TomlTable& table,
                     const fem::Structure& structure) {
  DescribedExcitation read = keys.read(table, structure.extent());
  read.at = read_place(table, structure, read.kind_name != to_string(Kind::base));
  for (const Kind kind : all_kinds)
    if (read.kind_name == to_string(kind)) read.kind = kind;
  if (read.file && read.file->empty()) table.refuse("file", "the name of a file");
  if (read.kind == Kind::base && !read.file)
    for (const char* const key : {"amplitude_m_per_s2", "frequency_hz"})
      if (!table.contains(key)) table.miss(key, keys.find(key)->expected() + ", or a file");
  read.amplitude = read.force_amplitude ? *read.force_amplitude : read.acceleration_amplitude.value_or(0.0);
  if (read.kind == Kind::random && read.amplitude < 0.0)
    table.refuse("amplitude_n", "a root mean square: not negative");
  read.place = table.place();
  return read;
}

bool is_start(const Excitation& one) {
  return one.kind == Kind::release || one.kind == Kind::free ||
         (one.kind == Kind::impulse && !(one.duration > 0.0));
}

}  // namespace

Excitation read_excitation(const TomlTable& table, const fem::Structure& structure) {
  return read_with(excitation_keys(), table, structure);
}

std::vector<Excitation> read_simultaneous_excitations(const TomlTable& root,
                                                      const fem::Structure& structure) {
  std::vector<Excitation> all;
  const std::vector<TomlTable> tables = root.find_tables("excitations");
  if (!tables.empty() && root.contains("excitation"))
    throw InputError(root.key_place("excitations"), "excitations beside excitation; expected one of them");
  for (const TomlTable& table : tables) {
    all.push_back(read_with(simultaneous_excitation_keys(), table, structure));
    if (all.size() > 1 && is_start(all.back()))
      throw InputError(
          table.place(),
          "only the first of [[excitations]] may state how the motion starts; expected a force or "
          "the motion of the base");
  }
  return all;
}

}  // namespace beamid::experiments
