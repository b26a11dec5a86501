// An experiment as its file describes it: structure, record, excitation, sensors, methods and settings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/models/joint_model.hpp"
#include "experiments/models/springs/spring_law.hpp"
#include "experiments/models/unknown.hpp"
#include "experiments/record/record.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/response/frequency_response.hpp"
#include "fem/response/response.hpp"
#include "fem/structural_system.hpp"
#include "fem/structure.hpp"
#include "filters/running_filter.hpp"

namespace beamid::experiments {

// What is done with a beam: [excitation], [[sensors]], [simulation] and [frequency_response] of an experiment
// file.

// [identifiability] of an experiment file.

/// What `beamid identifiability` assumes of the test and tries out.
struct IdentifiabilitySettings {
  bool force_measured = true;  ///< false: the record begins when the force has ended
  int places = 40;             ///< along the beam, to which a sensor is moved, at most
  int more_sensors = 5;        ///< added one by one to those described
};

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

// The sensors and the logger of a virtual test.

/// Of one channel. Shares are of the channel's largest true reading, so that they mean the same for every
/// quantity.
struct SensorDefects {
  double clipping = 0.0;      ///< readings end at +- this share; 0: nowhere
  double resolution = 0.0;    ///< step of the converter, a share; 0: none
  double offset = 0.0;        ///< a share
  double drift = 0.0;         ///< change of the offset over the record, a share
  double startup = 0.0;       ///< further offset at the first sample, a share; it fades exponentially
  double startup_time = 0.2;  ///< time constant of that [s]
  double rattle = 0.0;        ///< standard deviation of the noise of a loose contact, a share
  double rattle_above = 0.5;  ///< it rattles where the true reading is beyond +- this share
  bool dead = false;          ///< nothing but the offset, whatever moves

  bool operator==(const SensorDefects&) const = default;
};

/// Of the logger that all channels share.
struct Acquisition {
  double pretrigger = 0.0;        ///< recorded before the excitation begins [s]
  double jitter = 0.0;            ///< standard deviation of the intervals, a share of their mean
  double median_shortfall = 0.0;  ///< by which the median interval is shorter than the mean, a share of it
  int gaps = 0;                   ///< how often samples are missing
  std::pair<double, double> gap{0.01, 0.3};    ///< shortest and longest gap [s]
  double repeated = 0.0;                       ///< share of samples that show the reading before once more
  bool force = true;                           ///< the exciting force is measured, but for a release
  double force_noise = 0.0, base_noise = 0.0;  ///< standard deviations of that record [N], [m/s2]
  std::vector<SensorDefects> sensors = {};     ///< in the order of the sensors; missing ones have no defect

  bool operator==(const Acquisition&) const = default;

  /// Whether every reading is there, where and as the sensor gave it.
  bool perfect() const {
    Acquisition ideal;
    ideal.gap = gap;
    ideal.force = force;
    ideal.force_noise = force_noise;
    ideal.base_noise = base_noise;
    ideal.sensors.resize(sensors.size());
    return *this == ideal;
  }
  bool even() const { return !(jitter > 0) && gaps == 0; }  ///< samples at equal intervals throughout
  SensorDefects of(std::size_t sensor) const {
    return sensor < sensors.size() ? sensors[sensor] : SensorDefects{};
  }
};

/// The largest share of the jitter by which a median can fall short of the mean here: late samples are drawn
/// from a gamma distribution, which can do no more.
inline constexpr double largest_shortfall = 0.41;

// One structure and what is done with it, as its TOML file describes it (docs/configuration.md).

// Forces nobody measured and places where nothing was: [[unknown_forces]], [[virtual_sensors]], [fatigue].

/// A force that acted without being measured, as a random process (filters/latent_inputs.hpp).
struct UnknownForce {
  enum class Process { ornstein_uhlenbeck, matern, random_walk };
  std::string name = {};
  Quantity quantity = Quantity::force;  ///< or base_acceleration
  std::optional<double> position = {};  ///< of a force [m]; absent: the natural point
  std::string at = {};                  ///< in its place, of a structure whose places have names
  Process process = Process::matern;
  std::optional<double> deviation = {};         ///< [N or m/s2]; absent: from the record
  std::optional<double> correlation_time = {};  ///< [s]; absent: from the record, 1 of a random walk
  Place place = {};                             ///< of the table, for messages
};

/// What would be measured where nothing was.
struct VirtualSensor {
  std::string name = {};
  Quantity quantity = Quantity::displacement;
  bool bending_moment = false;          ///< M = E I w'': read as the strain of a fibre at c = -E I
  std::optional<double> position = {};  ///< [m]; absent: the natural point
  double distance = 0.0;                ///< strain: of the surface from the axis, c of -c w'' [m]
  std::string at = {};
};

/// Cycles N of a strain range r to failure: N = cycles (strain_range / r)^exponent [basquin1910].
struct FatigueLaw {
  double exponent = 5.0;
  double strain_range = 0.0;
  double cycles = 2e6;
};

/// A structure, a test of it and what is done with the record: all that an experiment file may say, in SI
/// units.
struct Experiment {
  std::optional<TomlTable> file;  ///< what it was read from, with what was set from outside
  std::string title;
  bool is_described = true;    ///< else made from a record alone: one mode of a mass of 1 kg
  bool mass_is_stated = true;  ///< of such a mode: else K and C are not said
  fem::Structure structure;
  std::vector<StoreySpring> storey_springs;  ///< of a chain, those that follow laws; the others are linear
  int elements = 40;                         ///< of a beam, or of each member of a frame
  fem::DampingLaw damping;
  Excitation excitation;
  std::vector<Excitation> further_excitations;  ///< that act at the same time, forces and the base's motion
  std::vector<Sensor> sensors;                  ///< none: displacement and acceleration at the natural point
  Acquisition acquisition;                      ///< of a virtual test
  Simulation simulation;
  FrequencyResponseSettings frequency_response;
  std::optional<std::string> record_file;  ///< relative to the TOML file's folder
  RecordFormat format;
  Choice reduction{"rayleigh", {}};
  bool reduction_is_stated = false;  ///< by [reduction] of the file
  std::vector<Choice>
      reductions;  ///< to be compared, in the order of the file; none: a choice of the command
  Choice model{"sdof", {}};
  std::vector<ParameterChoice> parameters;  ///< none: what the model asks about by itself
  Choice filter{"ekf", {}};
  std::string discretisation = "exponential";
  filters::OnFailure on_failure = filters::OnFailure::stop;
  std::string smoother;                      ///< of the history of an identification; empty: none
  std::vector<Choice> filters;               ///< to be compared; none: `filter`
  std::vector<std::string> discretisations;  ///< likewise; none: `discretisation`
  int passes = 3;                            ///< over the record, of every run of a comparison
  IdentifiabilitySettings identifiability;
  std::vector<PartOfStructure> parts;  ///< to be identified one by one
  std::vector<UnknownForce> unknown_forces;
  std::vector<VirtualSensor> virtual_sensors;
  std::optional<FatigueLaw> fatigue;
  Prior prior;
  std::map<Quantity, double> noise;     ///< standard deviation per quantity [SI]; absent: from the record
  Choice noise_method{"residual", {}};  ///< how absent ones are found: residual, likelihood, before_event
  std::string estimator = "filter";     ///< of an identification: filter, batch or both
};

/// The record with a position for every channel, and a distance from the axis for every strain gauge. A
/// channel that has none is given that of, in this order:
///
/// 1. the sensor of its quantity in [[sensors]] that has its name, or is the only one of that quantity;
/// 2. its name, as simulated records have it: "tip", "root", "x0.25m";
/// 3. the beam's natural point, where that is no guess between several places: no other channel of its
/// quantity
///    is left without a position, and [[sensors]] names none.
///
/// @throws std::invalid_argument where none of that holds: a model would read the channel at the wrong place.
Record with_places(Record record, const Experiment& experiment);

/// "tip: acceleration at 0.5 m".
std::string channel_text(const Channel& channel);

/// The same of all, separated by commas.
std::string channels_text(const Record& record);

/// Name, quantity, unit and position of every channel, for results.json.
nlohmann::ordered_json channel_values(const Record& record);

// What a run does when its filter fails, by name.

/// @throws std::invalid_argument "on_failure is 'inflat'; expected stop, inflate, report"
filters::OnFailure failure_response(const std::string& name);
const char* to_string(filters::OnFailure response);

}  // namespace beamid::experiments
