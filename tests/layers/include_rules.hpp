// Who may include whom (docs/decisions/0001-registry-and-layers.md), as a function of a file's path and text.
#pragma once

#include <algorithm>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace beamid::layers {

/// One `#include` line; `quoted` when written with "..." and not with <...>.
struct Include {
  int line = 0;
  std::string target;
  bool quoted = false;
};

inline std::vector<Include> includes_of(const std::string& source) {
  static const std::regex directive(R"re(^\s*#\s*include\s*(["<])([^">]+)[">].*)re");
  std::vector<Include> found;
  std::istringstream lines(source);
  std::string text;
  for (int line = 1; std::getline(lines, text); ++line)
    if (std::smatch match; std::regex_match(text, match, directive))
      found.push_back({line, match[2], match[1] == "\""});
  return found;
}

inline bool starts_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const std::string& beginning) { return text.starts_with(beginning); });
}

inline std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// Folders and single headers of the project that a folder's files may include.
inline const std::map<std::string, std::vector<std::string>>& allowed_within_project() {
  static const std::map<std::string, std::vector<std::string>> allowed{
      {"fem", {"fem/"}},
      {"filters", {"filters/"}},
      {"reduction", {"reduction/", "fem/", "filters/registry.hpp"}},
      {"experiments", {"experiments/", "reduction/", "filters/", "fem/"}},
      {"apps", {"apps/", "experiments/", "reduction/", "filters/", "fem/"}}};
  return allowed;
}

/// A library, by how its headers begin, and where it may be seen. Places ending in "/" are folders.
struct Library {
  std::string name;
  std::vector<std::string> headers, places;
  bool in_headers =
      false;  ///< whether any header may show it; else only those that .cpp files of `places` share
};

inline const std::vector<Library>& libraries() {
  static const std::vector<Library> known{
      {"SuiteSparse",
       {"umfpack", "cholmod", "klu", "SuiteSparse", "suitesparse/", "Eigen/UmfPack", "Eigen/Cholmod",
        "Eigen/KLU", "Eigen/SPQR"},
       {"fem/"}},
      {"Spectra", {"Spectra/"}, {"fem/"}},
      {"SUNDIALS",
       {"sundials/", "cvode", "arkode/", "ida", "kinsol/", "nvector/", "sunmatrix/", "sunlinsol/",
        "sunnonlinsol/", "sundials_functions.hpp"},
       {"filters/schemes/cvode.cpp", "fem/"}},
      {"Eigen",
       {"Eigen/", "unsupported/Eigen/"},
       {"fem/", "reduction/", "filters/", "experiments/", "apps/"},
       true},
      {"VTK", {"vtk"}, {"experiments/results/vtk/module/", "experiments/results/library_versions.cpp"}},
      {"toml++", {"toml"}, {"experiments/text/", "experiments/results/library_versions.cpp"}},
      {"nlohmann-json", {"nlohmann/"}, {"experiments/", "apps/"}, true},
      {"fmt", {"fmt/"}, {"experiments/", "apps/"}, true},
      {"HDF5", {"hdf5"}, {"experiments/"}},
      {"MPI", {"mpi.h"}, {"experiments/sweep/mpi_processes.cpp"}},
      {"matio", {"matio"}, {"experiments/record/files/"}},
      {"zlib", {"zlib"}, {"experiments/record/files/"}},
      {"libsndfile", {"sndfile"}, {"experiments/record/files/"}},
      {"libmseed", {"libmseed"}, {"experiments/record/files/"}},
      {"libfreexl", {"freexl"}, {"experiments/record/files/"}},
      {"UDUNITS-2", {"udunits2"}, {"experiments/record/"}},
      {"oneTBB", {"tbb/", "oneapi/"}, {"experiments/"}},
      {"Boost.Math", {"boost/math/"}, {"fem/", "filters/", "experiments/"}},
      {"pybind11", {"pybind11/"}, {"apps/python/"}},
      {"Boost.Program_options", {"boost/program_options"}, {"apps/values.cpp"}},
      {"POSIX", {"unistd.h", "fcntl.h", "poll.h", "spawn.h", "signal.h", "sys/"}, {"experiments/", "apps/"}},
      {"the dynamic linker", {"dlfcn.h", "needed_library.hpp"}, {"fem/", "filters/", "experiments/"}, true},
      {"the C library's allocator", {"malloc.h"}, {"apps/main.cpp"}}};
  return known;
}

/// The rooms of experiments/, from the ground up: a file includes its own room and those below it.
inline const std::vector<std::string>& floors() {
  static const std::vector<std::string> from_the_ground{"signal",   "text",   "record", "results",
                                                        "modal",    "models", "config", "rig",
                                                        "identify", "sweep",  "studies"};
  return from_the_ground;
}

/// "identify" of "experiments/identify/engine/comparison.hpp"; empty outside experiments/.
inline std::string room_of(const std::string& path) {
  constexpr std::string_view house = "experiments/";
  if (path.rfind(house, 0) != 0) return "";
  const std::size_t end = path.find('/', house.size());
  return end == std::string::npos ? "a loose file" : path.substr(house.size(), end - house.size());
}

/// What is wrong with an include between rooms; empty when it leads down or stays.
inline std::string upward(const std::string& file, const std::string& target) {
  const std::string from = room_of(file), to = room_of(target);
  if (from.empty() || to.empty()) return "";
  const auto floor = [](const std::string& room) {
    return std::find(floors().begin(), floors().end(), room);
  };
  for (const std::string& room : {from, to})
    if (floor(room) == floors().end()) return "experiments/ has no room '" + room + "'";
  return floor(to) > floor(from)
             ? "room " + from + " includes \"" + target + "\" of " + to + ", a room above it"
             : "";
}

/// What is wrong with one include of `file` (a path from the repository's root); empty when it is allowed.
inline std::string objection(const std::string& file, const Include& include) {
  const std::string folder = file.substr(0, file.find('/'));
  if (include.quoted) {
    const auto rule = allowed_within_project().find(folder);
    if (rule == allowed_within_project().end()) return "no rule for folder '" + folder + "'";
    if (starts_with_any(include.target, rule->second)) return upward(file, include.target);
    return folder + " includes \"" + include.target +
           "\"; expected a path from the root below: " + joined(rule->second);
  }
  for (const Library& library : libraries()) {
    if (!starts_with_any(include.target, library.headers)) continue;
    if (starts_with_any(file, library.places)) return "";
    return "<" + include.target + "> belongs to " + library.name + "; expected only in " +
           joined(library.places);
  }
  if (include.target.find_first_of("./") == std::string::npos) return "";  // the standard library
  return "<" + include.target + "> belongs to no library that tests/layers/include_rules.hpp knows";
}

/// Every objection to a file, as "file:line: objection".
inline std::vector<std::string> objections(const std::string& file, const std::string& source) {
  std::vector<std::string> found;
  for (const Include& include : includes_of(source))
    if (const std::string text = objection(file, include); !text.empty())
      found.push_back(file + ":" + std::to_string(include.line) + ": " + text);
  return found;
}

/// Objections to headers that show a library to files which should not see it. `texts`: every source by its
/// path.
inline std::vector<std::string> leaks(const std::map<std::string, std::string>& texts) {
  std::vector<std::string> found;
  for (const auto& [header, text] : texts)
    for (const Include& shown : includes_of(text))
      for (const Library& library : libraries()) {
        if (!header.ends_with(".hpp") || shown.quoted || library.in_headers) continue;
        if (!starts_with_any(shown.target, library.headers)) continue;
        for (const auto& [file, source] : texts)
          for (const Include& include : includes_of(source))
            if (include.target == header &&
                !(file.ends_with(".cpp") && starts_with_any(file, library.places)))
              found.push_back(file + ":" + std::to_string(include.line) + ": \"" + header + "\" shows " +
                              library.name + "; expected only in .cpp files of " + joined(library.places));
      }
  return found;
}

}  // namespace beamid::layers
