// The study's test, a release from a static deflection, as a record of it shows it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "fem/assembly.hpp"
#include "fem/free_decay.hpp"
#include "fem/modes.hpp"

namespace beamid::experiments {

/// A record of ten periods of the first mode. It holds the modes below half its sampling rate and no others,
/// for full and reduced models alike, as the anti-aliasing filter of an instrument leaves them: without that
/// limit the acceleration of a release depends on how many modes the mesh has, which is no property of the
/// beam.
struct ReleaseTest {
  fem::Point point;           ///< where it is pulled and let go
  double deflection = 0.012;  ///< there [m]
  double sampling_rate_hz = 0.0;
  Eigen::Index samples = 0;  ///< none: the beam can move without strain and has no static deflection
  Eigen::VectorXd initial;   ///< q(0) on the mesh (n)
  fem::DampingLaw damping;   ///< in time: a hysteretic law stands here as the ratios it shows

  double limit_hz() const { return 0.5 * sampling_rate_hz; }
  Eigen::VectorXd time() const;  ///< (N) [s]
};

/// @param damping in force. @param input that of the point, by its number in the system.
/// @param first_hz frequency of the first mode with strain. @param notes what a reader should know.
ReleaseTest plan_release(const Experiment& experiment, const fem::DampingLaw& damping,
                         const fem::StructuralSystem& system, Eigen::Index input, const fem::Point& point,
                         double first_hz, std::vector<std::string>& notes);

/// The motion of output 0 by exact modal superposition, after the mesh's deflection at the release was
/// projected on the model's modes, z_i = psi_i^T M q(0): every mode keeps the amplitude that the shapes leave
/// it.
/// @param system full or reduced, @param modes its lowest. @param shapes psi, the same on the mesh (n x k).
/// @param mass of the mesh (n x n).
fem::Motion decay(const ReleaseTest& test, const fem::StructuralSystem& system, const fem::Modes& modes,
                  const Eigen::MatrixXd& shapes, const fem::SparseMatrix& mass);

}  // namespace beamid::experiments
