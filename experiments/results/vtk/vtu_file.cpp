#include "experiments/results/vtk/vtu_file.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstring>
#include <stdexcept>

#include "experiments/results/result_directory.hpp"
#include "experiments/results/vtk/drawing.hpp"
#include "experiments/results/vtk/vtu_text.hpp"

namespace beamid::experiments {
namespace {

namespace fs = std::filesystem;
constexpr const char* vtk_library_name = "libbeamid_vtk.so";

void vtk_asker() {}  // a place in this program or module

void add_above(const fs::path& file, std::vector<fs::path>& places) {
  for (fs::path folder = file.parent_path();; folder = folder.parent_path()) {
    places.push_back(folder / "lib/beamid/vtk" / vtk_library_name);
    if (folder == folder.parent_path()) return;
  }
}

/// Where it may be, the most likely place first.
std::vector<fs::path> places_of_library() {
  std::vector<fs::path> places;
  std::error_code missing;
  Dl_info found{};
  // Of a program it is the name as it was called: without a slash no path.
  if (dladdr(reinterpret_cast<void*>(&vtk_asker), &found) != 0 && std::strchr(found.dli_fname, '/') &&
      fs::exists(found.dli_fname, missing))
    add_above(fs::canonical(found.dli_fname, missing), places);
  if (const fs::path program = fs::read_symlink("/proc/self/exe", missing); !program.empty())
    add_above(program, places);
  for (const char* prefix : {"/usr/local", "/usr"}) add_above(fs::path(prefix) / "bin/beamid", places);
  return places;
}

void* opened_library() {
  std::error_code missing;
  for (const fs::path& place : places_of_library())
    if (fs::exists(place, missing)) return dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
  return dlopen(vtk_library_name, RTLD_NOW | RTLD_LOCAL);
}

VtuText* loaded_function() {
  constexpr const char* remedy = "; meshes for ParaView are omitted (Debian package beamid-paraview)";
  void* const library = opened_library();
  if (library == nullptr) throw NotDrawn(std::string(dlerror()) + remedy, true);
  const auto* const version = static_cast<const char* const*>(dlsym(library, "beamid_vtk_made_for"));
  void* const function = dlsym(library, "beamid_vtu_text");
  if (version == nullptr || function == nullptr || std::string(*version) != BEAMID_VERSION)
    throw NotDrawn(std::string(vtk_library_name) + " is not of beamid " BEAMID_VERSION + remedy, true);
  return reinterpret_cast<VtuText*>(function);
}

/// The function of libbeamid_vtk.so, which is loaded when it is first used.
VtuText& vtu_text() {
  static VtuText* const function = loaded_function();  // a failure is tried anew
  return *function;
}

}  // namespace

void write_vtu(const std::filesystem::path& file, const BeamGrid& grid,
               const std::vector<PointArray>& arrays) {
  std::string text;
  if (!vtu_text()(grid, arrays, text)) throw std::runtime_error("VTK cannot write '" + file.string() + "'");
  write_file(file, text);
}

void write_pvd(const std::filesystem::path& file, const std::vector<std::pair<double, std::string>>& steps) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const auto& [time, name] : steps)
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", time, name);
  write_file(file, text + "  </Collection>\n</VTKFile>\n");
}

}  // namespace beamid::experiments
