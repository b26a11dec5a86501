#include "experiments/config/read_acquisition.hpp"

#include <fmt/format.h>

namespace beamid::experiments {
namespace {

/// A number from 0 to `most`, or 0 without the key.
double share(const TomlTable& table, const std::string& key, double most) {
  const double value = table.find_number(key, Sign::not_negative).value_or(0.0);
  if (value > most) table.refuse(key, fmt::format("a number from 0 to {:g}", most));
  return value;
}

SensorDefects read_defects(const TomlTable& table) {
  SensorDefects sensor;
  sensor.clipping = table.find_number("clipping", Sign::positive).value_or(0.0);
  sensor.resolution = share(table, "resolution", 1.0);
  sensor.offset = table.find_number("offset").value_or(0.0);
  sensor.drift = table.find_number("drift").value_or(0.0);
  sensor.startup = table.find_number("startup").value_or(0.0);
  sensor.startup_time = table.find_number("startup_s", Sign::positive).value_or(sensor.startup_time);
  sensor.rattle = table.find_number("rattle", Sign::not_negative).value_or(0.0);
  if (table.contains("rattle_above")) sensor.rattle_above = share(table, "rattle_above", 1.0);
  sensor.dead = table.find_truth("dead").value_or(false);
  return sensor;
}

}  // namespace

Acquisition read_acquisition(const TomlTable& root) {
  constexpr double most_jitter = 0.5, most_repeated = 0.9;
  constexpr int most_gaps = 1000;
  Acquisition acquisition;
  for (const TomlTable& sensor : root.find_tables("sensors"))
    acquisition.sensors.push_back(read_defects(sensor));
  const auto table = root.find_table("acquisition");
  if (!table) return acquisition;
  acquisition.pretrigger = table->find_number("pretrigger_s", Sign::not_negative).value_or(0.0);
  acquisition.jitter = share(*table, "jitter", most_jitter);
  acquisition.median_shortfall = share(*table, "median_shortfall", largest_shortfall * acquisition.jitter);
  acquisition.gaps = table->find_whole_number("gaps", 0, most_gaps).value_or(0);
  acquisition.gap = table->find_interval("gap_s").value_or(acquisition.gap);
  if (!(acquisition.gap.first > 0)) table->refuse("gap_s", "a shortest gap above 0");
  acquisition.repeated = share(*table, "repeated", most_repeated);
  acquisition.force = table->find_truth("force").value_or(true);
  return acquisition;
}

}  // namespace beamid::experiments
