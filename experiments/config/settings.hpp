// What is done with a beam: [excitation], [[sensors]], [simulation] and [frequency_response] of an experiment
// file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/record/record.hpp"
#include "experiments/text/input_error.hpp"
#include "fem/response/frequency_response.hpp"
#include "fem/response/response.hpp"

namespace beamid::experiments {

/// What sets the beam in motion. Absent values are worked out or zero.
struct Excitation {
  /// release: from rest in the static shape of a force; step: a constant force from t = 0 on; impulse: a
  /// momentum at once or a half sine; harmonic: amplitude sin(2 pi f t); random: normal numbers, 2 f a
  /// second, straight between them; base: the ground accelerates; table: a force from a file; free: from a
  /// given displacement and velocity.
  enum class Kind { release, step, impulse, harmonic, random, base, table, free };
  Kind kind = Kind::release;
  std::optional<double> position;  ///< of the force, or of the point displaced [m]; absent: the natural point
  std::optional<double> deflection;  ///< release, free: at that point [m]; release: 0.012 when absent
  double velocity = 0.0;             ///< free: at that point [m/s]
  std::optional<int> mode;           ///< free: the shape of this mode, from 1; absent: the static shape
  double force = 0.0;                ///< step [N]
  double momentum = 0.0;             ///< impulse [N s]
  double duration = 0.0;             ///< impulse: of the half sine [s]; 0: at once
  double amplitude = 0.0;            ///< harmonic, random (root mean square) [N], base [m/s2]
  double frequency_hz = 0.0;         ///< harmonic, random, base [Hz]
  std::optional<std::string>
      file;             ///< table, base: time and force [N] or acceleration [m/s2]; relative to the TOML file
  Place place = {};     ///< of the table, for messages
  std::string at = {};  ///< in place of the position, of a structure whose places have names
};

/// An instrument at one point, its noise white.
struct Sensor {
  std::string name;
  std::optional<double> position;              ///< [m]; absent: the natural point
  Quantity quantity = Quantity::acceleration;  ///< accelerations are absolute, the rest relative to the base
  double noise = 0.0;                          ///< standard deviation [SI]
  double distance = 0.0;                       ///< strain: of the surface from the axis, c of -c w'' [m]
  std::string place = {};                      ///< of a structure whose places have names: "ridge.x"
};

/// A part of a structure between sections whose motion was measured.
struct PartOfStructure {
  std::string name;
  std::optional<double> from, to;         ///< sections [m]; absent: as far as the structure goes
  std::vector<std::string> supports;      ///< in their place, where places have names
  std::string inside;                     ///< a place of the part, which says on which side of them it is
  std::optional<double> highest_hz = {};  ///< of a span: lines of the spectrum up to here [Hz]
  Place place = {};                       ///< of the table, for messages
};

/// How the test is simulated: [simulation].
struct Simulation {
  double duration = 5.0;          ///< [s]
  double sampling_rate = 1000.0;  ///< [Hz]
  int steps_per_sample = 1;       ///< of the integration
  fem::ResponseMethod method;
  int frames = 100;        ///< pictures of the whole beam, evenly spread
  std::uint64_t seed = 1;  ///< of the sensors' noise
};

/// A force here, motion there; absent: the natural point.
struct PointPair {
  std::optional<double> input, output;    ///< [m]
  std::string input_place, output_place;  ///< of a structure whose places have names
};

/// Which frequency responses are computed, and where: [frequency_response].
struct FrequencyResponseSettings {
  enum class Kind { receptance, mobility, accelerance };
  Kind kind = Kind::receptance;
  std::optional<double> from_hz,
      to_hz;  ///< absent: from a fifth of the first frequency to 1.2 times the third
  int points = 2000;
  bool logarithmic = true;
  std::vector<PointPair> pairs;  ///< none: the natural point's own
  /// An empty name: direct, or modal for a damping law that has no sparse matrix.
  fem::FrequencyResponseMethod method{"", 0, true};
};

const char* to_string(Excitation::Kind kind);
const char* to_string(FrequencyResponseSettings::Kind kind);

/// Unit of a frequency response: m/N, m/(N s), 1/kg.
const char* unit_of(FrequencyResponseSettings::Kind kind);

/// The same as the end of a column's name: m_per_n, m_per_n_s, per_kg.
const char* suffix_of(FrequencyResponseSettings::Kind kind);

}  // namespace beamid::experiments
