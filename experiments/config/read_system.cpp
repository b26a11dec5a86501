
#include "experiments/config/readers.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/record/read_apart.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/matrix_market.hpp"

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

namespace {

struct GivenMatrices {
  std::string mass, damping, stiffness;  // names of files; empty: none
};

struct GivenSystem : GivenMatrices {
  std::optional<std::vector<std::string>> labels;
  std::optional<std::vector<double>> base_motion;
};

struct GivenFactor : GivenMatrices {
  std::string name;
  double value = 1.0;
};

const Schema<GivenSystem>& system_keys() {
  using S = GivenSystem;
  static const Schema<S> keys =
      Schema<S>("system")
          .key("mass", &S::mass,
               "M [kg]: a Matrix Market file beside the experiment file, or a matrix of a MATLAB file, "
               "`\"model.mat:M\"`",
               "\"M.mtx\"")
          .required()
          .key("stiffness", &S::stiffness, "of K [N/m], or of K_0 where parameters add theirs", "\"K.mtx\"")
          .required()
          .key("damping", &S::damping, "of C [N s/m]; beside `[damping]` both count", "\"C.mtx\"")
          .fallback("none")
          .key("labels", &S::labels, "names of the unknowns, in the order of the rows",
               "[\"floor1\", \"floor2\"]")
          .fallback("their numbers, `\"1\"` on")
          .key("base_motion", &S::base_motion, any_number,
               "how far each unknown goes when all supports move by 1 m: 1 for a displacement along the "
               "motion, 0 across it and for rotations; without it the base cannot move",
               "[1, 1]")
          .fallback("none")
          .tables({"parameters"});
  return keys;
}

const Schema<GivenFactor>& system_parameter_keys() {
  using P = GivenFactor;
  static const Schema<P> keys =
      Schema<P>("system.parameters")
          .key("name", &P::name, "what `[[parameters]]` with `quantity = \"factor\"` calls it", "\"k1\"")
          .required()
          .key("value", &P::value, "theta of K = K_0 + sum theta_j K_j, likewise M and C", "1.0")
          .key("mass", &P::mass, "Matrix Market file of M_j", "\"M1.mtx\"")
          .fallback("zero")
          .key("damping", &P::damping, "of C_j", "\"C1.mtx\"")
          .fallback("zero")
          .key("stiffness", &P::stiffness, "of K_j", "\"K1.mtx\"")
          .fallback("zero")
          .at_least_one({"mass", "damping", "stiffness"});
  return keys;
}

const bool system_keys_registered[] = {
    register_keys([]() -> const KeyTable& { return system_keys(); }),
    register_keys([]() -> const KeyTable& { return system_parameter_keys(); })};

// "model.mat:K" is the matrix K of model.mat.
std::pair<std::string, std::string> matrix_source(const std::string& file) {
  const std::size_t colon = file.rfind(".mat:");
  if (colon == std::string::npos) return {file, ""};
  return {file.substr(0, colon + 4), file.substr(colon + 5)};
}

/// @param size rows and columns it must have; 0: any number of both, the same
fem::SparseMatrix matrix_of(const TomlTable& table, const char* key, const std::string& file,
                            Eigen::Index size) {
  if (file.empty()) {
    if (table.contains(key)) table.refuse(key, "the name of a Matrix Market or MATLAB file");
    return {};
  }
  const auto [name, variable] = matrix_source(file);
  const auto path = std::filesystem::path(table.place().file).parent_path() / name;
  if (!std::filesystem::is_regular_file(path))
    throw InputError(
        table.value_place(key),
        fmt::format("'{}' is no file; expected a Matrix Market or a MATLAB file", path.string()));
  fem::SparseMatrix matrix =
      path.extension() == ".mat" ? read_mat_matrix(path, variable) : read_matrix_market(path);
  const Eigen::Index expected = size > 0 ? size : matrix.rows();
  if (matrix.rows() != expected || matrix.cols() != expected)
    throw InputError(table.value_place(key), fmt::format("'{}' is {} x {}; expected {} x {}", file,
                                                         matrix.rows(), matrix.cols(), expected, expected));
  return matrix;
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && name.size() <= 100 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace

fem::MatrixSystem read_system(const TomlTable& table) {
  const GivenSystem given = system_keys().read(table);
  fem::MatrixSystem system;
  system.mass = matrix_of(table, "mass", given.mass, 0);
  const Eigen::Index n = system.mass.rows();
  system.stiffness = matrix_of(table, "stiffness", given.stiffness, n);
  system.damping = matrix_of(table, "damping", given.damping, n);
  for (const TomlTable& one : table.find_tables("parameters")) {
    const GivenFactor factor = system_parameter_keys().read(one);
    if (!is_plain_name(factor.name))
      one.refuse("name", "at most 100 small letters, digits and underscores, as in a key");
    system.parameters.push_back({factor.name, factor.value, matrix_of(one, "mass", factor.mass, n),
                                 matrix_of(one, "damping", factor.damping, n),
                                 matrix_of(one, "stiffness", factor.stiffness, n)});
  }
  if (given.labels)
    system.labels = *given.labels;
  else
    for (Eigen::Index i = 0; i < n; ++i) system.labels.push_back(fmt::format("{}", i + 1));
  if (given.base_motion)
    system.base_motion =
        Eigen::VectorXd::Map(given.base_motion->data(), static_cast<Eigen::Index>(given.base_motion->size()));
  at_place(table.place(), [&] { fem::validate(system); });
  return system;
}

}  // namespace beamid::experiments
