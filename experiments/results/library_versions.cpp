#include <fmt/format.h>
#include <hdf5.h>
#include <vtkVersionMacros.h>

#include <toml++/toml.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "experiments/results/results.hpp"

namespace beamid::experiments {

std::vector<std::pair<std::string, std::string>> library_versions() {
  const auto joined = [](int major, int minor, int patch) {
    return fmt::format("{}.{}.{}", major, minor, patch);
  };
#ifdef __clang__
  const std::string compiler = "Clang " __VERSION__;
#else
  const std::string compiler = "GCC " __VERSION__;
#endif
  return {{"beamid", BEAMID_VERSION},
          {"compiler", compiler},
          {"Eigen", joined(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"fmt", joined(FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"HDF5", joined(H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE)},
          {"nlohmann-json",
           joined(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
          {"toml++", joined(TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
          {"VTK", VTK_VERSION}};
}

}  // namespace beamid::experiments
