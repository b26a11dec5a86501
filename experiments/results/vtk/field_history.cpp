#include "experiments/results/vtk/field_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/results/vtk/vtu_file.hpp"
#include "fem/response/response.hpp"

namespace beamid::experiments {
namespace {

std::string frame_file(Eigen::Index frame) {
  return fmt::format("frame_{:04d}.vtu", frame);
}

void check_field_history(const fem::StructuralSystem& system, const fem::Response& response) {
  const auto frames = static_cast<Eigen::Index>(response.frames.size());
  if (frames == 0) throw std::invalid_argument("the response stores no frames; expected one at least");
  const auto check_field = [&](const char* name, const Eigen::MatrixXd& field) {
    if (field.rows() != system.size() || field.cols() != frames)
      throw std::invalid_argument(fmt::format("the response's {} field is {} x {}; expected {} x {}", name,
                                              field.rows(), field.cols(), system.size(), frames));
  };
  check_field("displacement", response.field_displacement);
  check_field("velocity", response.field_velocity);
  check_field("acceleration", response.field_acceleration);
  const auto [first, last] = std::minmax_element(response.frames.begin(), response.frames.end());
  if (*first < 0 || *last >= response.time.size())
    throw std::invalid_argument(fmt::format("frames of the response are samples {} to {}; expected 0 to {}",
                                            *first, *last, response.time.size() - 1));
}

}  // namespace

std::vector<std::string> field_history_files(Eigen::Index frames) {
  std::vector<std::string> files{"response.pvd"};
  for (Eigen::Index frame = 0; frame < frames; ++frame) files.push_back(frame_file(frame));
  return files;
}

void write_field_history(const std::filesystem::path& folder, const Picture& picture,
                         const fem::Response& response) {
  const fem::StructuralSystem& system = picture.system;
  check_field_history(system, response);
  const BeamGrid grid = beam_grid(picture);
  std::vector<std::pair<double, std::string>> series;
  for (Eigen::Index frame = 0; frame < response.field_displacement.cols(); ++frame) {
    const NodalMotion motion = nodal_motion(system, response.field_displacement.col(frame));
    const NodalMotion velocity = nodal_motion(system, response.field_velocity.col(frame));
    const NodalMotion acceleration = nodal_motion(system, response.field_acceleration.col(frame));
    write_vtu(folder / frame_file(frame), grid,
              {{"Displacement", translation_of_points(grid, motion)},
               {"Velocity", translation_of_points(grid, velocity)},
               {"Acceleration", translation_of_points(grid, acceleration)},
               {"Rotation", rotation_of_points(grid, motion)}});
    series.emplace_back(response.time[response.frames[frame]], frame_file(frame));
  }
  write_pvd(folder / "response.pvd", series);
}

}  // namespace beamid::experiments
