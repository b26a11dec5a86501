#include <iterator>
#include <limits>

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/record/delimited_text.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

constexpr Quantity sensed[] = {Quantity::displacement, Quantity::velocity, Quantity::acceleration,
                               Quantity::strain, Quantity::angular_acceleration};

/// A sensor as a file describes it.
struct DescribedSensor : Sensor, SensorDefects {
  std::string quantity_name = "acceleration";
  double deviation[std::size(sensed)] = {};
  std::optional<double> given_distance;
};

std::string noise_key(Quantity quantity) {
  return "noise_" + units(quantity).front().suffix;
}

Schema<DescribedSensor> make_sensor_keys() {
  using S = DescribedSensor;
  Schema<S> keys("sensors");
  keys.key("name", &S::name, "begins the column's name in the record", "\"tip\"")
      .values("text, at most 100 letters")
      .fallback("`tip`, `root`, or its place")
      .key("position_m", &S::position, on_beam, "where it sits", "1.1")
      .fallback("the tip, or midspan where the tip is held")
      .key("at", &S::place,
           "in place of `position_m`, of a frame or a system: a joint and a direction, or a label",
           "\"ridge.x\"")
      .key("quantity", &S::quantity_name,
           "what it measures; a strain gauge needs its `position_m`, which may be a clamped root",
           "\"acceleration\"")
      .one_of({"displacement", "velocity", "acceleration", "strain", "angular_acceleration"})
      .key("distance_m", &S::given_distance, "of a strain gauge from the axis, c of the strain -c w''",
           "0.003")
      .values("number, not 0")
      .fallback("half the section's height");
  const std::pair<const char*, const char*> noise[] = {
      {"standard deviation of a displacement sensor's white noise", "1e-6"},
      {"of a velocity sensor's", "1e-5"},
      {"of an accelerometer's", "0.05"},
      {"of a strain gauge's", "1e-7"},
      {"of a sensor of angular acceleration's", "0.01"}};
  for (std::size_t i = 0; i < std::size(sensed); ++i)
    keys.key(
        noise_key(sensed[i]).c_str(), [i](S& s) -> double& { return s.deviation[i]; }, not_negative,
        noise[i].first, noise[i].second);
  keys.key("clipping", &S::clipping, positive, "readings end at plus and minus this share", "0.6")
      .fallback("none")
      .key("resolution", &S::resolution, {0.0, 1.0}, "step of the converter, a share", "0.01")
      .key("offset", &S::offset, "constant, a share", "0.1")
      .key("drift", &S::drift, "change of the offset from the first sample to the last, a share; straight",
           "0.2")
      .key("startup", &S::startup, "further offset at the first sample, a share, that fades exponentially",
           "1.5")
      .key("startup_s", &S::startup_time, positive, "time constant of that", "0.1")
      .key("rattle", &S::rattle, not_negative,
           "standard deviation of the white noise of a loose contact, a share", "0.2")
      .key("rattle_above", &S::rattle_above, {0.0, 1.0},
           "it rattles where the true reading is beyond plus or minus this share", "0.6")
      .key("dead", &S::dead, "only the offset, whatever moves", "true");
  return keys;
}

const Schema<DescribedSensor>& sensor_keys() {
  static const Schema<DescribedSensor> keys = make_sensor_keys();
  return keys;
}

const bool sensor_keys_registered = register_keys([]() -> const KeyTable& { return sensor_keys(); });

}  // namespace

std::vector<Sensor> read_sensors(const TomlTable& root, const fem::Structure& structure) {
  std::vector<Sensor> sensors;
  for (const TomlTable& one : root.find_tables("sensors")) {
    DescribedSensor sensor = sensor_keys().read(one, structure.extent());
    sensor.place = read_place(one, structure, true);
    if (sensor.name.size() > 100) one.refuse("name", "at most 100 letters, as files are named after it");
    sensor.quantity = *find_quantity(sensor.quantity_name);
    check_gauge_position(one, structure, sensor.quantity);
    sensor.distance = gauge_distance(one, structure, sensor.quantity, sensor.position, sensor.given_distance);
    for (std::size_t i = 0; i < std::size(sensed); ++i)
      if (sensed[i] == sensor.quantity)
        sensor.noise = sensor.deviation[i];
      else
        refuse_useless(one, {noise_key(sensed[i])}, "for a sensor of " + sensor.quantity_name,
                       noise_key(sensor.quantity));
    sensors.push_back(sensor);
  }
  return sensors;
}

std::vector<SensorDefects> read_defects(const TomlTable& root) {
  std::vector<SensorDefects> defects;
  for (const TomlTable& one : root.find_tables("sensors")) defects.push_back(sensor_keys().read(one));
  return defects;
}

reduction::Training read_shape(const std::filesystem::path& file, double length) {
  constexpr const char* expected = "two columns, position_m and deflection";
  const std::string text = read_text(file, fmt::format("a shape in {}", expected));
  DelimitedText rows(file.string(), text, '\0', 0);
  if (rows.width() != 2)
    throw InputError(rows.row_place(),
                     fmt::format("{}; expected {}", count_of_columns(rows.width()), expected));
  if (const auto& names = rows.names();
      !names.empty() && (names[0] != "position_m" || names[1] != "deflection"))
    throw InputError({file.string(), rows.header_line()},
                     fmt::format("columns '{}' and '{}'; expected {}", names[0], names[1], expected));
  std::vector<double> positions, deflections;
  double largest = 0.0;
  while (rows.next()) {
    const double position = rows.number(0);
    if (!(position >= 0.0 && position <= length))
      throw InputError(rows.place(0),
                       fmt::format("position {} m; expected one on the beam, 0 to {} m", position, length));
    if (!positions.empty() && position <= positions.back())
      throw InputError(rows.place(0), fmt::format("position {} m after {} m; expected increasing positions",
                                                  position, positions.back()));
    positions.push_back(position);
    deflections.push_back(rows.number(1));
    largest = std::max(largest, std::abs(deflections.back()));
  }
  if (!(largest > std::numeric_limits<double>::min()))
    throw InputError({file.string()}, "every deflection is zero; expected a shape");
  const auto count = static_cast<Eigen::Index>(positions.size());
  return {Eigen::Map<const Eigen::VectorXd>(positions.data(), count),
          Eigen::Map<const Eigen::VectorXd>(deflections.data(), count)};
}

}  // namespace beamid::experiments
