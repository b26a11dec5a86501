
#include "experiments/config/readers.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/schema.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/memory_need.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::experiments {
namespace {

const Schema<Acquisition>& acquisition_keys() {
  using A = Acquisition;
  constexpr double most_jitter = 0.5, most_repeated = 0.9;
  constexpr int most_gaps = 1000;
  static const Schema<A> keys =
      Schema<A>("acquisition")
          .key("pretrigger_s", &A::pretrigger, not_negative,
               "recorded before the excitation begins, in whole samples; the beam is held where it starts",
               "0.5")
          .key("jitter", &A::jitter, {0.0, most_jitter},
               "standard deviation of the intervals between stamps, a share of their mean", "0.3")
          .key("median_shortfall", &A::median_shortfall, {0.0, most_jitter * largest_shortfall},
               "share of the mean interval by which the median one is shorter: a loop that is held up now "
               "and then",
               "0.08")
          .values("number, 0 to 0.41 of `jitter`")
          .key("gaps", &A::gaps, {0, most_gaps},
               "how often samples are missing: once, anywhere, in each of as many equal parts of the record",
               "3")
          .key("gap_s", &A::gap, "shortest and longest gap; drawn evenly on a logarithmic scale",
               "[0.02, 0.2]")
          .values("two numbers > 0")
          .key("repeated", &A::repeated, {0.0, most_repeated},
               "share of samples that show the reading before once more, under a stamp of their own", "0.04")
          .key("force", &A::force,
               "whether the record holds the exciting force, or the base's acceleration, as a channel; that "
               "of a release never is one",
               "false")
          .key("force_noise_n", &A::force_noise, not_negative,
               "standard deviation of the noise of that channel", "0.5")
          .key("base_noise_m_per_s2", &A::base_noise, not_negative, "likewise, of the base's acceleration",
               "0.01");
  return keys;
}

const bool acquisition_keys_registered =
    register_keys([]() -> const KeyTable& { return acquisition_keys(); });

}  // namespace

Acquisition read_acquisition(const TomlTable& root) {
  Acquisition acquisition;
  if (const auto table = root.find_table("acquisition")) {
    acquisition = acquisition_keys().read(*table);
    const double most = largest_shortfall * acquisition.jitter;
    if (acquisition.median_shortfall > most)
      table->refuse("median_shortfall", fmt::format("a number from 0 to {:g}", most));
    if (!(acquisition.gap.first > 0)) table->refuse("gap_s", "a shortest gap above 0");
  }
  acquisition.sensors = read_defects(root);
  return acquisition;
}

namespace {

std::vector<std::string> response_names() {
  std::vector<std::string> names;
  for (const auto& method : fem::response_methods()) names.push_back(method.name);
  return names;
}

const Schema<Simulation>& simulation_keys() {
  using S = Simulation;
  constexpr int most_steps = 1000, most_frames = 100000, largest_seed = 2147483647;
  static const Schema<S> keys =
      Schema<S>("simulation")
          .with_options()
          .key("duration_s", &S::duration, positive, "of the record", "25")
          .key("sampling_rate_hz", &S::sampling_rate, positive, "of the record", "1000")
          .key("steps_per_sample", &S::steps_per_sample, {1, most_steps},
               "steps of integration between two samples", "4")
          .key(
              "method", [](S& s) -> std::string& { return s.method.name; },
              "a name from `beamid list responses`", "\"newmark\"")
          .one_of(response_names())
          .values("text")
          .key("frames", &S::frames, {0, most_frames},
               "pictures of the whole beam for ParaView, evenly spread", "200")
          .key("seed", &S::seed, {0, largest_seed}, "of the sensors' noise", "7");
  return keys;
}

const bool simulation_keys_registered = register_keys([]() -> const KeyTable& { return simulation_keys(); });

}  // namespace

Simulation read_simulation(const TomlTable& table) {
  constexpr double most_samples = 2e7;
  Simulation simulation = simulation_keys().read(table);
  const double samples = simulation.duration * simulation.sampling_rate;
  if (samples < 1.0 || samples > most_samples)
    throw InputError(table.place(),
                     fmt::format("{} s at {} Hz make {:.6g} samples; expected 1 to {:g}", simulation.duration,
                                 simulation.sampling_rate, samples, most_samples));
  constexpr double sample = 170;  // [bytes], of one sensor: its responses and what is reported, measured
  at_place(table.place(), [&] { require_memory(samples, "samples of a simulated record", sample); });
  const auto methods = fem::response_methods();
  const auto method = std::find_if(methods.begin(), methods.end(),
                                   [&](const auto& m) { return m.name == simulation.method.name; });
  std::vector<std::string> options;
  for (const auto& option : method->options) options.push_back(option.name);
  for (const std::string& key : table.keys()) {
    if (simulation_keys().find(key) != nullptr) continue;
    if (std::find(options.begin(), options.end(), key) == options.end())
      throw InputError(table.key_place(key),
                       fmt::format("unknown option '{}' of response method '{}'; known: {}", key,
                                   method->name, options.empty() ? "none" : joined(options)));
    simulation.method.options[key] = table.number(key);
  }
  return simulation;
}

SectionPlace section_at(const fem::Beam& beam, double position) {
  double start = 0.0;
  for (const fem::Segment& segment : beam.segments) {
    const double s = (position - start) / segment.length;
    start += segment.length;
    if (s <= 1.0 || &segment == &beam.segments.back()) return {&segment.section, std::clamp(s, 0.0, 1.0)};
  }
  return {};
}

void check_gauge_position(const TomlTable& table, const fem::Structure& structure, Quantity quantity) {
  if (quantity != Quantity::strain) return;
  if (!structure.is_beam() || structure.is_chain())
    throw InputError(table.value_place("quantity"),
                     fmt::format("a {} has no sections whose strain could be read; expected displacement, "
                                 "velocity or acceleration",
                                 structure.kind()));
  if (!table.contains("position_m"))
    table.miss("position_m", Key{.name = "position_m", .range = on_beam}.expected(structure.extent()));
}

double gauge_distance(const TomlTable& table, const fem::Structure& structure, Quantity quantity,
                      const std::optional<double>& position, const std::optional<double>& given) {
  if (quantity != Quantity::strain) {
    refuse_useless(table, {"distance_m"}, std::string("for the quantity ") + to_string(quantity),
                   "quantity = \"strain\", or no distance_m");
    return 0.0;
  }
  if (given && *given != 0.0) return *given;
  const std::string expected = "a number of metres that is not zero: how far the gauge is from the axis";
  if (given) table.refuse("distance_m", expected);
  const SectionPlace there = section_at(structure.beam(), position.value_or(0.0));
  if (there.section && there.section->outline.shape != fem::Outline::Shape::none)
    return 0.5 * there.section->outline.height(there.along);
  table.miss("distance_m", expected + "; the section there has no height that determines it");
}

namespace {

using Process = UnknownForce::Process;

const Schema<UnknownForce>& unknown_force_keys() {
  using F = UnknownForce;
  static const Schema<F> keys =
      Schema<F>("unknown_forces")
          .key("name", &F::name, "printed with its estimate", "\"wind\"")
          .values("text, at most 100 letters")
          .fallback("`force` and its place")
          .choice("quantity", &F::quantity,
                  {std::pair{"force", Quantity::force}, {"base_acceleration", Quantity::base_acceleration}},
                  "a force at a place, or the acceleration of the base", "\"force\"")
          .key("position_m", &F::position, on_beam, "where a force acts", "1.1")
          .fallback("the tip, or midspan where the tip is held")
          .key("at", &F::at, "in place of `position_m`, of a frame or a system: a joint and a direction",
               "\"ridge.x\"")
          .choice("process", &F::process,
                  {std::pair{"matern", Process::matern},
                   {"ornstein_uhlenbeck", Process::ornstein_uhlenbeck},
                   {"random_walk", Process::random_walk}},
                  "what it is taken for: a random process with a derivative, one without, or one of no bound",
                  "\"matern\"")
          .key("deviation", &F::deviation, positive, "its standard deviation [N, m/s2]", "2.5")
          .fallback("from the record")
          .key("correlation_time_s", &F::correlation_time, positive,
               "over which it forgets itself; of a random walk, over which it moves by `deviation`", "0.02")
          .fallback("from the record; 1 of a random walk");
  return keys;
}

struct DescribedVirtual : VirtualSensor {
  std::string quantity_name = "displacement";
  std::optional<double> given_distance;
};

const Schema<DescribedVirtual>& virtual_sensor_keys() {
  using V = DescribedVirtual;
  static const Schema<V> keys =
      Schema<V>("virtual_sensors")
          .key("name", &V::name, "begins the column's name in `histories.csv`", "\"root_strain\"")
          .values("text, at most 100 letters")
          .fallback("its quantity and place")
          .key("quantity", &V::quantity_name, "what a sensor there would measure", "\"strain\"")
          .one_of({"displacement", "velocity", "acceleration", "strain", "bending_moment"})
          .key("position_m", &V::position, on_beam, "where it would sit", "0")
          .fallback("the tip, or midspan where the tip is held")
          .key("distance_m", &V::given_distance, "of a strain from the axis, c of the strain -c w''", "0.003")
          .values("number, not 0")
          .fallback("half the section's height")
          .key("at", &V::at, "in place of `position_m`, of a frame or a system: a joint and a direction",
               "\"ridge.x\"");
  return keys;
}

const Schema<FatigueLaw>& fatigue_keys() {
  using L = FatigueLaw;
  static const Schema<L> keys =
      Schema<L>("fatigue")
          .key("exponent", &L::exponent, {.least = 1.0}, "m of N = N_0 (r_0 / r)^m", "5")
          .key("strain_range", &L::strain_range, positive, "r_0, which fails after `cycles`", "4e-4")
          .required()
          .key("cycles", &L::cycles, positive, "N_0", "2e6");
  return keys;
}

const bool unknown_force_keys_registered =
    register_keys([]() -> const KeyTable& { return unknown_force_keys(); });
const bool virtual_sensor_keys_registered =
    register_keys([]() -> const KeyTable& { return virtual_sensor_keys(); });
const bool fatigue_keys_registered = register_keys([]() -> const KeyTable& { return fatigue_keys(); });

template <class Named>
void check_sensing_name(const TomlTable& table, const Named& one, const std::vector<Named>& others) {
  if (one.name.size() > 100) table.refuse("name", "at most 100 letters, as columns are named after it");
  for (const Named& other : others)
    if (other.name == one.name)
      throw InputError(table.contains("name") ? table.value_place("name") : table.place(),
                       fmt::format("two of them are called '{}'; expected a name each", one.name));
}

std::string name_of_virtual_place(const std::optional<double>& position, const std::string& at,
                                  const fem::Structure& structure) {
  if (!at.empty()) return at;
  return name_of_place(position.value_or(fem::natural_point(structure).position), structure.extent());
}

double bending_stiffness_at(const fem::Beam& beam, double position) {
  const SectionPlace there = section_at(beam, position);
  if (!there.section) throw std::invalid_argument("a beam without segments has no bending moment");
  return there.section->bending_stiffness(there.along);
}

}  // namespace

VirtualSensor bending_moment_at(const fem::Beam& beam, double position) {
  VirtualSensor sensor{"", Quantity::strain, true, position, -bending_stiffness_at(beam, position), ""};
  sensor.name = "bending_moment_" + name_of_place(position, fem::Structure(beam).extent());
  return sensor;
}

std::vector<UnknownForce> read_unknown_forces(const TomlTable& root, const fem::Structure& structure) {
  std::vector<UnknownForce> forces;
  for (const TomlTable& table : root.find_tables("unknown_forces")) {
    UnknownForce force = unknown_force_keys().read(table, structure.extent());
    const bool base = force.quantity == Quantity::base_acceleration;
    if (base)
      refuse_useless(table, {"position_m", "at"}, "for base_acceleration", "quantity = \"force\"");
    else
      force.at = read_place(table, structure, true);
    force.place = table.place();
    if (force.name.empty())
      force.name = base ? "base" : "force_" + name_of_virtual_place(force.position, force.at, structure);
    check_sensing_name(table, force, forces);
    forces.push_back(std::move(force));
  }
  return forces;
}

std::vector<VirtualSensor> read_virtual_sensors(const TomlTable& root, const fem::Structure& structure) {
  std::vector<VirtualSensor> sensors;
  for (const TomlTable& table : root.find_tables("virtual_sensors")) {
    DescribedVirtual sensor = virtual_sensor_keys().read(table, structure.extent());
    sensor.at = read_place(table, structure, true);
    sensor.bending_moment = sensor.quantity_name == "bending_moment";
    sensor.quantity = sensor.bending_moment ? Quantity::strain : *find_quantity(sensor.quantity_name);
    check_gauge_position(table, structure, sensor.quantity);
    if (sensor.bending_moment) {
      refuse_useless(table, {"distance_m"}, "for the quantity bending_moment", "quantity = \"strain\"");
      sensor.distance = -bending_stiffness_at(structure.beam(), sensor.position.value_or(0.0));
    } else {
      sensor.distance =
          gauge_distance(table, structure, sensor.quantity, sensor.position, sensor.given_distance);
    }
    if (sensor.name.empty())
      sensor.name = sensor.quantity_name + "_" + name_of_virtual_place(sensor.position, sensor.at, structure);
    check_sensing_name<VirtualSensor>(table, sensor, sensors);
    sensors.push_back(sensor);
  }
  return sensors;
}

std::optional<FatigueLaw> read_fatigue(const TomlTable& root) {
  if (const auto table = root.find_table("fatigue")) return fatigue_keys().read(*table);
  return {};
}

}  // namespace beamid::experiments
