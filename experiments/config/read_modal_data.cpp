#include "experiments/config/read_modal_data.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/config/read_modal_json.hpp"
#include "experiments/config/schema.hpp"

namespace beamid::experiments {
namespace {

/// A mode as a file describes it.
struct DescribedMode {
  double frequency = 0.0;
  std::optional<double> deviation, relative_deviation;
  std::optional<std::vector<double>> shape;
  std::optional<double> shape_deviation;
  std::optional<int> number;
};

constexpr int most_measured_modes = 1000;

const Schema<DescribedMode>& measured_mode_keys() {
  using M = DescribedMode;
  static const Schema<M> keys =
      Schema<M>("modes")
          .key("frequency_hz", &M::frequency, positive, "natural frequency", "2.7477")
          .required("a positive number of Hz")
          .key("frequency_standard_deviation_hz", &M::deviation, positive, "its standard deviation", "0.005")
          .excludes({"frequency_relative_deviation"}, "one of them")
          .key("frequency_relative_deviation", &M::relative_deviation, positive,
               "the same as a part of the frequency", "0.002")
          .key("shape", &M::shape, "displacements at the sensors, in their order, of any scale",
               "[0.35, 0.65, 0.87, 1.0]")
          .key("shape_standard_deviation", &M::shape_deviation, positive, "of each component, in that scale",
               "0.03")
          .key("mode", &M::number, {1, most_measured_modes}, "its number, where it is known", "3");
  return keys;
}

MeasuredMode measured_mode(const TomlTable& table, std::size_t sensors) {
  for (const std::string& key : table.keys())
    if (!measured_mode_keys().find(key))
      throw InputError(table.key_place(key), fmt::format("unknown key modes.{}; expected one of: {}", key,
                                                         fmt::join(measured_mode_keys().names(), ", ")));
  const DescribedMode described = measured_mode_keys().read(table);
  MeasuredMode mode{
      described.frequency,
      described.deviation.value_or(described.relative_deviation.value_or(0.0) * described.frequency)};
  mode.number = described.number;
  if (!described.shape) {
    if (described.shape_deviation)
      throw InputError(table.key_place("shape_standard_deviation"),
                       "modes.shape_standard_deviation without a shape; expected shape beside it");
    return mode;
  }
  if (described.shape->size() != sensors)
    throw InputError(
        table.value_place("shape"),
        fmt::format("modes.shape has {} numbers; expected {}, one for each of the [[sensors]] of "
                    "the experiment file, in their order",
                    described.shape->size(), sensors));
  mode.shape = Eigen::Map<const Eigen::VectorXd>(described.shape->data(),
                                                 static_cast<Eigen::Index>(described.shape->size()));
  if (mode.shape.isZero(0.0)) table.refuse("shape", "a number other than zero among them");
  mode.shape_deviation = described.shape_deviation.value_or(0.0);
  return mode;
}

ModalData read_modes_toml(const std::filesystem::path& file, const Experiment& experiment) {
  const TomlTable root = TomlTable::read(file);
  for (const std::string& key : root.keys())
    if (key != "modes")
      throw InputError(root.key_place(key),
                       fmt::format("unknown key {}; expected [[modes]] and nothing else", key));
  ModalData data;
  data.source = file.string();
  for (const TomlTable& table : root.find_tables("modes"))
    data.modes.push_back(measured_mode(table, experiment.sensors.size()));
  if (data.modes.empty()) throw InputError({file.string()}, "no modes; expected tables [[modes]]");
  return data;
}

/// By frequency; numbers of modes must rise with it.
void sort_modes(ModalData& data) {
  const auto below = [](const MeasuredMode& a, const MeasuredMode& b) {
    return a.frequency_hz < b.frequency_hz;
  };
  if (!std::is_sorted(data.modes.begin(), data.modes.end(), below)) {
    std::stable_sort(data.modes.begin(), data.modes.end(), below);
    data.remarks.emplace_back("The file does not list its modes by frequency; they are sorted here.");
  }
  int last = 0;
  for (const MeasuredMode& mode : data.modes) {
    if (!mode.number) continue;
    if (*mode.number <= last)
      throw InputError({data.source},
                       fmt::format("mode {} at {:g} Hz stands above mode {}; expected numbers that rise with "
                                   "the frequency",
                                   *mode.number, mode.frequency_hz, last));
    last = *mode.number;
  }
}

}  // namespace

ModalData read_modal_data(const std::filesystem::path& file, const Experiment& experiment) {
  const bool json = file.extension() == ".json";
  ModalData data = json ? read_modal_json(file, experiment) : read_modes_toml(file, experiment);
  sort_modes(data);
  return data;
}

}  // namespace beamid::experiments
