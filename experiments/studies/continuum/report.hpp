// The lowest modes of any structure, as `beamid modes` reports them.
#pragma once

#include <complex>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "experiments/config/experiment.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/results/results.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "experiments/text/progress.hpp"
#include "fem/assembly.hpp"

namespace beamid::experiments {

// What `beamid frf` prints and writes.

// Frequency responses between points of a beam, with their resonances and anti-resonances.

/// A largest or smallest magnitude between two of the grid's frequencies, refined.
struct Extremum {
  /// An anti-resonance turns the sign of the response; a minimum does not.
  enum class Kind { resonance, anti_resonance, minimum };
  Kind kind = Kind::resonance;
  double frequency_hz = 0.0;
  std::complex<double> response;  ///< infinite at a resonance without damping
};

const char* to_string(Extremum::Kind kind);

struct PairResponse {
  fem::Point input, output;
  std::string name;               ///< "tip", "tip_root": input, output
  Eigen::VectorXcd response;      ///< at the grid's frequencies, of the kind asked for
  std::vector<Extremum> extrema;  ///< frequencies ascending
};

struct FrequencyResponses {
  fem::StructuralSystem system;
  Eigen::VectorXd frequency_hz;            ///< the grid
  Eigen::VectorXd natural_frequencies_hz;  ///< of the undamped modes up to the grid's end, 200 at most
  fem::FrequencyResponseMethod method;     ///< as used
  std::vector<PairResponse> pairs;
  std::vector<std::string> notes, warnings;
};

/// @throws std::invalid_argument when a point cannot move or the method cannot treat the damping;
/// std::runtime_error where an undamped structure resonates at a frequency asked for.
FrequencyResponses respond_to_frequencies(const Experiment& experiment, const Progress& progress);

/// The table resonances, frf.csv, results.json, and a figure of magnitude and phase.
Results report(const Experiment& experiment, const FrequencyResponses& found);

/// @param count of modes, cut to what the mesh has. @param surface draw the real sections for ParaView
/// @throws std::invalid_argument when the structure is impossible; std::runtime_error when its modes are not
/// found.
Results modes_study(const Experiment& experiment, Eigen::Index count, bool surface, const Progress& progress);

// What `beamid simulate` prints and writes.

/// The table sensors, record.csv, results.json, a figure of each sensor's history and spectrum, and the
/// motion of the whole beam for ParaView where frames were kept.
/// @param surface draw the real sections instead of a line.
/// @param motion what the page plays and motion.glb holds; none: neither.
Results report(const Experiment& experiment, const std::shared_ptr<const SimulatedTest>& test, bool surface,
               const std::shared_ptr<const WholeMotion>& motion = {});

}  // namespace beamid::experiments
