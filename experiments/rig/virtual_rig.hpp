// The test rig of the study, simulated on the continuum.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "experiments/config/experiment.hpp"
#include "experiments/record/record.hpp"
#include "fem/beam.hpp"
#include "fem/free_decay.hpp"
#include "fem/modes.hpp"
#include "fem/response/response.hpp"

namespace beamid::experiments {

/// A cantilever pulled at the tip by a static force and released from rest; an accelerometer on the tip.
struct Release {
  fem::Beam beam;
  int elements = 80;
  int modes = 8;  ///< kept in the motion
  double first_damping_ratio = 0.002;
  double higher_damping_ratio = 0.005;  ///< of every mode above the first
  double tip_deflection = 0.012;        ///< [m]
  double duration = 25.0;               ///< [s]
  double sampling_rate = 1000.0;        ///< [Hz]
};

/// What the tip does, exactly, and which modes it is made of.
struct ReleasedBeam {
  Eigen::VectorXd time;              ///< (N) [s], from the release
  fem::Motion tip;                   ///< (N each)
  fem::Modes modes;                  ///< k modes
  Eigen::VectorXd modal_amplitudes;  ///< (k) at the tip [m]
};

/// Finite elements, modes, and exact modal superposition.
ReleasedBeam release(const Release& settings);

/// The tip's acceleration as an accelerometer with white noise of the given deviation [m/s2] records it.
Record measure_acceleration(const ReleasedBeam& beam, double noise, std::uint64_t seed, std::uint64_t stream);

// What cheap sensors and loggers do to the readings of a test.

/// Instants (N) of the samples [s], the first at 0, the last at (N - 1) / rate. The intervals are
///
///     dt = (a + g) / rate,   g of a gamma distribution, a such that the mean is 1 / rate,
///
/// whose shape is found from the shortfall of the median and whose scale from the jitter: a loop that waits
/// the same time after every sample and is held up now and then. Without a shortfall they are normal. None is
/// shorter than a twentieth of the mean. Stamps are true: a reading belongs to its instant.
/// @throws std::invalid_argument when the shortfall is beyond largest_shortfall times the jitter.
Eigen::VectorXd sample_instants(const Acquisition& acquisition, Eigen::Index count, double rate,
                                std::uint64_t seed);

/// What a channel shows (N) of true readings (N) at instants (N): rattle, drift, start-up and offset are
/// added, the sum is clipped, then rounded.
/// @param noise (N) of the sensor itself. @param stream of the rattle, within the seed.
Eigen::VectorXd shown_readings(const SensorDefects& sensor, const Eigen::VectorXd& time,
                               const Eigen::VectorXd& readings, const Eigen::VectorXd& noise,
                               std::uint64_t seed, std::uint64_t stream);

/// Repeats the reading before in the asked share of the samples, of all channels at once, and takes the
/// samples of the gaps out: one gap somewhere in each of as many equal parts of the record, its length drawn
/// evenly on a logarithmic scale.
void lose_samples(const Acquisition& acquisition, Record& record, std::uint64_t seed);

// From an excitation to the loads of a structural system.

/// What an excitation is on one mesh and one time grid.
struct ExcitationHistory {
  fem::Loading loading;
  Eigen::VectorXd base_acceleration;  ///< (N) [m/s2]; empty: the base rests
  std::vector<std::string> notes;     ///< what a reader should know, a sentence each
};

/// @param input number of the input (and output) that the excitation acts on.
/// @param folder in which the excitation's file is looked for.
/// @param seed of random forces.
/// @throws InputError at the excitation's place when it cannot be followed: a pulse or a letting go shorter
/// than four steps, a static shape of a beam that moves without strain, a file without force, nothing that
/// moves.
ExcitationHistory excite(const Excitation& excitation, const fem::StructuralSystem& system,
                         Eigen::Index input, const fem::TimeGrid& grid, const std::filesystem::path& folder,
                         std::uint64_t seed = 1);

/// Whether the excitation goes on while the record runs: a force, or a motion of the base.
bool has_force_history(const Excitation& excitation);

/// What a further force or the motion of the base adds.
void add(const ExcitationHistory& further, ExcitationHistory& to);

}  // namespace beamid::experiments
