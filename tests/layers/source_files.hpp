// The project's own sources, as the tests of its structure read them.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace beamid::layers {

/// Whole text of a file given by its path from the repository's root.
inline std::string text_of(const std::string& file) {
  std::ifstream stream(std::filesystem::path(BEAMID_SOURCE_DIR) / file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Sorted paths, from the repository's root, of the .hpp and .cpp files below a folder.
inline std::vector<std::string> sources_below(const std::string& folder) {
  const std::filesystem::path root(BEAMID_SOURCE_DIR);
  std::set<std::string> files;
  if (!std::filesystem::exists(root / folder)) return {};
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder))
    if (entry.path().extension() == ".hpp" || entry.path().extension() == ".cpp")
      files.insert(std::filesystem::relative(entry.path(), root).generic_string());
  return {files.begin(), files.end()};
}

/// Names of the extensions in a folder: the .cpp files in it, not below it, except those with a header, which
/// only help the others.
inline std::set<std::string> extensions_in(const std::string& folder) {
  std::set<std::string> names;
  for (const std::string& file : sources_below(folder)) {
    std::filesystem::path path(file);
    const std::string header = path.replace_extension(".hpp").generic_string();
    if (path.parent_path() == folder && file.ends_with(".cpp") &&
        !std::filesystem::exists(std::filesystem::path(BEAMID_SOURCE_DIR) / header))
      names.insert(path.stem().string());
  }
  return names;
}

}  // namespace beamid::layers
