#include "experiments/config/read_parts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/key_tables.hpp"

namespace beamid::experiments {
namespace {

const Schema<PartOfStructure>& part_keys() {
  using P = PartOfStructure;
  static const Schema<P> keys =
      Schema<P>("substructures")
          .key("name", &P::name, "printed with its estimates", "\"floors 5 to 8\"")
          .required()
          .key("from_m", &P::from, on_beam, "section where it begins, whose motion is measured", "4")
          .fallback("the structure's own beginning")
          .key("to_m", &P::to, on_beam, "section where it ends, likewise", "9")
          .fallback("the structure's own end")
          .key("supports", &P::supports,
               "of a frame or a system, in place of both: the places that bound it, whose accelerations are "
               "measured",
               "[\"u4\", \"u9\"]")
          .fallback("none")
          .key("inside", &P::inside, "with `supports`: a place of the part", "\"u6\"")
          .key("highest_hz", &P::highest_hz, positive,
               "of a span of a beam: lines of the record's spectrum are used up to here", "40")
          .fallback("0.6 of half the sampling rate");
  return keys;
}

const bool part_keys_registered = register_keys([]() -> const KeyTable& { return part_keys(); });

void check_sections(const TomlTable& table, const PartOfStructure& part) {
  if (!part.from && !part.to)
    throw InputError(table.place(), "a substructure without a section; expected from_m, to_m or both");
  if (part.from && part.to && !(*part.from < *part.to)) table.refuse("to_m", "a section beyond from_m");
  for (const char* const key : {"supports", "inside"})
    if (table.contains(key))
      throw InputError(table.key_place(key), fmt::format("{} names places, which a beam and a chain do not "
                                                         "have; expected from_m and to_m",
                                                         key));
}

void check_places(const TomlTable& table, const PartOfStructure& part, const fem::Structure& structure) {
  for (const char* const key : {"from_m", "to_m"})
    if (table.contains(key))
      throw InputError(table.key_place(key),
                       fmt::format("{} is a position, which a {} does not have; expected "
                                   "supports and inside",
                                   key, structure.kind()));
  if (part.supports.empty()) table.miss("supports", "the places that bound the part");
  if (part.inside.empty()) table.miss("inside", "a place of the part");
  const std::vector<std::string> known = fem::place_names(structure);
  const auto check = [&](const char* key, const std::string& place) {
    if (std::find(known.begin(), known.end(), place) == known.end())
      throw InputError(table.value_place(key), fmt::format("no place '{}' in the {}; expected one of: {}",
                                                           place, structure.kind(), fmt::join(known, ", ")));
  };
  for (const std::string& place : part.supports) check("supports", place);
  check("inside", part.inside);
}

}  // namespace

std::vector<PartOfStructure> read_parts(const TomlTable& root, const fem::Structure& structure) {
  std::vector<PartOfStructure> parts;
  for (const TomlTable& table : root.find_tables("substructures")) {
    PartOfStructure part = part_keys().read(table, structure.extent());
    part.place = table.place();
    if (structure.has_positions())
      check_sections(table, part);
    else
      check_places(table, part, structure);
    for (const PartOfStructure& other : parts)
      if (other.name == part.name)
        throw InputError(table.value_place("name"),
                         fmt::format("two substructures are called '{}'; expected a name each", part.name));
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace beamid::experiments
