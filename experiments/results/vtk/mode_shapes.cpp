#include "experiments/results/vtk/mode_shapes.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "experiments/results/vtk/vtu_file.hpp"

namespace beamid::experiments {
namespace {

std::string series_file(Eigen::Index mode) {
  return fmt::format("mode_{}.vtu", mode + 1);
}

Eigen::VectorXd distinct_times(Eigen::VectorXd frequencies_hz) {
  const double highest = frequencies_hz.size() > 0 ? frequencies_hz.maxCoeff() : 0.0;
  const double step = 1e-9 * (highest > 0.0 ? highest : 1.0);
  for (Eigen::Index i = 1; i < frequencies_hz.size(); ++i)
    if (!(frequencies_hz[i] > frequencies_hz[i - 1])) frequencies_hz[i] = frequencies_hz[i - 1] + step;
  return frequencies_hz;
}

}  // namespace

std::vector<std::string> mode_shape_files(Eigen::Index modes) {
  std::vector<std::string> files{"modes.vtu", "modes.pvd"};
  for (Eigen::Index mode = 0; mode < modes; ++mode) files.push_back(series_file(mode));
  return files;
}

void write_mode_shapes(const std::filesystem::path& folder, const Picture& picture,
                       const Eigen::MatrixXd& shapes, const Eigen::VectorXd& frequencies_hz) {
  const fem::StructuralSystem& system = picture.system;
  if (shapes.rows() != system.size() || shapes.cols() != frequencies_hz.size())
    throw std::invalid_argument(
        fmt::format("mode shapes are {} x {}; expected {} x {}, a column for each frequency", shapes.rows(),
                    shapes.cols(), system.size(), frequencies_hz.size()));
  const BeamGrid grid = beam_grid(picture);
  const Eigen::VectorXd times = distinct_times(frequencies_hz);
  std::vector<PointArray> all;
  std::vector<std::pair<double, std::string>> series;
  for (Eigen::Index mode = 0; mode < shapes.cols(); ++mode) {
    const NodalMotion motion = scaled_mode(system, shapes.col(mode));
    const std::string name = fmt::format("Mode {} ({:.4f} Hz)", mode + 1, frequencies_hz[mode]);
    all.push_back({name, translation_of_points(grid, motion)});
    all.push_back({name + " rotation", rotation_of_points(grid, motion)});
    write_vtu(folder / series_file(mode), grid,
              {{"Mode", all[all.size() - 2].values}, {"Rotation", all.back().values}});
    series.emplace_back(times[mode], series_file(mode));
  }
  write_vtu(folder / "modes.vtu", grid, all);
  write_pvd(folder / "modes.pvd", series);
}

}  // namespace beamid::experiments
