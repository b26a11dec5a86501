#include "experiments/config/read_sensing.hpp"

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_gauge.hpp"
#include "experiments/config/read_place.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/models/structure_points.hpp"
#include "experiments/record/units.hpp"

namespace beamid::experiments {
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
