// The motion of a structure under sampled inputs.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "fem/structural_system.hpp"

namespace beamid::fem {

/// What sets the structure in motion.
struct Loading {
  Eigen::VectorXd initial_displacement;  ///< q(0) (n); empty: zero
  Eigen::VectorXd initial_velocity;      ///< q'(0) (n); empty: zero. An impulse p on input i is M^-1 E_i p
  Eigen::MatrixXd inputs;  ///< f (m x N), sampled at the time grid, linear in between; empty: zero
};

/// t_k = k interval, k = 0..samples-1.
struct TimeGrid {
  double interval = 0.0;  ///< [s]
  Eigen::Index samples = 0;
  std::vector<Eigen::Index> frames = {};  ///< samples at which the whole field is kept, ascending
};

/// The motion at the samples. Where the base is accelerated all of it is relative to the base: the absolute
/// acceleration is `acceleration` plus the base's own.
struct Response {
  Eigen::VectorXd time;                                  ///< (N) [s]
  Eigen::MatrixXd displacement, velocity, acceleration;  ///< of the outputs (p x N) [m, m/s, m/s2]
  std::vector<Eigen::Index> frames;                      ///< as asked for
  Eigen::MatrixXd field_displacement, field_velocity, field_acceleration;  ///< q, q', q'' (n x frames)
  std::vector<std::string> remarks;  ///< what the method left out or estimates, a sentence each
};

/// A method by name, with the options that differ from their fallbacks.
struct ResponseMethod {
  std::string name = "modal";
  std::map<std::string, double> options = {};
};

/// An option that a method understands.
struct ResponseOption {
  std::string name;
  double fallback = 0.0;
  std::string unit;         ///< empty when dimensionless
  std::string description;  ///< one line
};

/// What is known of a method.
struct ResponseMethodDescription {
  std::string name;
  std::string summary;  ///< one line
  std::string source;   ///< keys in docs/references.md
  std::vector<ResponseOption> options;
};

/// All methods (one file each, in fem/response/methods), by name.
std::vector<ResponseMethodDescription> response_methods();

/// Motion of M q'' + C q' + K q = E f + nonlinear forces, C being system.damping plus what the law gives.
///
/// @throws std::invalid_argument when sizes differ, the grid or a frame is impossible, the method or an
/// option is unknown or out of range, or the method cannot treat the law or the nonlinear forces;
/// std::runtime_error when an integration fails, naming the method and the time.
Response respond(const StructuralSystem& system, const DampingLaw& damping, const Loading& loading,
                 const TimeGrid& grid, const ResponseMethod& method = {});

}  // namespace beamid::fem
