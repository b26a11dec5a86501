// Mode shapes as a model that swings, and a motion in time: glTF 2.0, read by viewers and slides, drawn by
// experiments/results/page/modes.js.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace beamid::experiments {

/// Points of a structure and how each mode moves them. z is upwards here, y in the file, as glTF wants it.
struct SwingModel {
  enum class Kind { points = 0, lines = 1, triangles = 4 };  ///< as glTF numbers them
  struct Part {
    Kind kind = Kind::lines;
    Eigen::Matrix3Xd points;        ///< at rest [m]
    std::vector<unsigned> corners;  ///< indices of points: one, two or three for each point, line, triangle
    std::vector<Eigen::Matrix3Xd> motion;  ///< for each of the model's motions, (3 x points), largest about 1
  };
  struct Mode {
    std::string name;  ///< "mode 1, 1.8649 Hz"
    double frequency_hz = 0;
    std::optional<double> damping_ratio = {};
    int real = 0;                        ///< which motion is in phase
    std::optional<int> quadrature = {};  ///< which is a quarter of a period ahead; absent: the shape is real
    std::optional<int> beside = {};      ///< the mode that swings beside it at first
  };
  std::vector<Part> parts;
  std::vector<Mode> modes;
};

/// A motion in time: the sum of a model's motions by their weights.
struct MotionHistory {
  Eigen::VectorXd time;           ///< (samples) [s], ascending
  Eigen::MatrixXd weights;        ///< (motions x samples) [m]
  double largest = 0.0;           ///< displacement of any point at any time [m]
  double residual_percent = 0.0;  ///< of the motion, what its shapes do not hold (root mean square)
};

/// The bytes of a .glb file: one mesh with a morph target for each motion and an animation of two seconds for
/// each mode. A target moves its points by a tenth of the structure's largest extent.
///
/// `extras` of the mesh hold the modes with their frequencies [Hz], damping ratios and targets, and
/// "moves_m", the tenth. The same model gives the same bytes.
/// @throws std::invalid_argument on parts whose motions have other sizes than their points, and without any.
std::string binary_gltf(const SwingModel& model);

/// The same with one animation, of the motion at its own speed; the model needs no modes. It is magnified:
/// its largest displacement is a tenth of the structure's largest extent. `extras` hold "moves_m" and
/// "motion" with "largest_m" [m], the displacement that this stands for, and "residual_percent".
/// @throws std::invalid_argument on a history without samples, or with other numbers of weights than motions.
std::string binary_gltf(const SwingModel& model, const MotionHistory& history);

}  // namespace beamid::experiments
