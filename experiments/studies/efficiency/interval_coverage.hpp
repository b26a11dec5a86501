// How often the 95 % intervals of `identify` hold the truth, over seeded records with higher modes and noise.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "experiments/record/record.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

enum class NoiseColour {
  white,
  low_passed,  ///< first order, corner at 1.5 times the first frequency
  flicker,     ///< half white, half with a density of 1/f
};
const char* to_string(NoiseColour colour);

/// What is asked of the records.
enum class CoverageModel {
  oscillator,   ///< K and C of one degree of freedom, as `identify` does by itself
  one_mode,     ///< bending stiffness and damping ratio of the beam, reduced to its first mode
  three_modes,  ///< reduced to three
  mesh          ///< not reduced
};
/// "sdof", "one_mode", "three_modes", "mesh"
const char* to_string(CoverageModel model);
/// @throws std::invalid_argument on another name
CoverageModel coverage_model(const std::string& name);

struct CoverageSettings {
  CoverageModel model = CoverageModel::oscillator;
  std::vector<NoiseColour> colours{NoiseColour::white, NoiseColour::low_passed, NoiseColour::flicker};
  int runs = 2000;
  std::uint64_t seed = 1;
  double damping_ratio = 0.01;             ///< of the first mode; of the others half of it
  double noise = 0.02;                     ///< deviation, of the first mode's amplitude
  double cycles = 30;                      ///< of the first mode
  std::array<double, 2> higher{0.3, 0.1};  ///< amplitudes of the second and third mode, of the first one's
};

/// Frequency, or bending stiffness, and damping ratio (K and C stand in a fixed relation to frequency and
/// ratio: the mass is known).
struct CoverageCase {
  NoiseColour colour = NoiseColour::white;
  int runs = 0, failed = 0;
  std::array<int, 2> inside{};                  ///< of the 95 % intervals
  std::array<double, 2> mean{}, mean_square{};  ///< of errors over the deviation told
};

struct Coverage {
  CoverageSettings settings;
  std::vector<CoverageCase> cases;
};

/// The record of one run: acceleration at the tip of a steel cantilever with a tip mass, 60 samples a cycle;
/// of the beam itself 120, which a mesh needs to follow its third mode, and all modes damped alike.
Record covered_record(const CoverageSettings& settings, NoiseColour colour, std::uint64_t seed);

/// `identify` as it is without options, its preparation against higher modes included, on every record. The
/// numbers do not depend on the number of processors.
/// @throws std::invalid_argument when runs < 2.
Coverage interval_coverage(const CoverageSettings& settings, const Progress& progress);

Results report(const Coverage& coverage);

}  // namespace beamid::experiments
