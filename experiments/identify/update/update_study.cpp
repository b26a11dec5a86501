#include "experiments/identify/update/update_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "experiments/identify/update/update_warnings.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr Index spare_modes = 4;  // beyond those measured, for pairing

// Of the shapes; without any, the natural point.
std::vector<fem::Point> sensor_points(const Experiment& experiment, bool shapes) {
  std::vector<fem::Point> points;
  for (const Sensor& sensor : experiment.sensors) {
    if (!shapes) break;
    if (sensor.quantity == Quantity::strain || is_angular(sensor.quantity))
      throw std::invalid_argument("sensor '" + sensor.name + "' reads " + to_string(sensor.quantity) +
                                  "; expected displacement, velocity or acceleration where "
                                  "shapes are compared");
    points.push_back({fmt::format("sensor{}", points.size() + 1),
                      sensor.position ? *sensor.position : fem::natural_point(experiment.structure).position,
                      sensor.place});
  }
  if (points.empty()) points.push_back(fem::natural_point(experiment.structure));
  return points;
}

Index modes_needed(const ModalData& data) {
  const auto count = static_cast<Index>(data.modes.size());
  Index last = count;
  for (const MeasuredMode& mode : data.modes) last = std::max<Index>(last, mode.number.value_or(0));
  return data.has_shapes() ? std::max(last, count + spare_modes) : last + 1;
}

}  // namespace

UpdateStudy study_update(const Experiment& experiment, const ModalData& data, const UpdateSettings& settings,
                         const Progress& progress) {
  UpdateStudy study;
  study.settings = settings;
  study.model = std::make_unique<const ModalModel>(experiment.structure, experiment.elements,
                                                   sensor_points(experiment, data.has_shapes()),
                                                   asked_parameters(experiment), modes_needed(data));
  study.space = std::make_unique<const SearchSpace>(study.model->asked());
  study.residual = std::make_unique<const ModalResidual>(*study.model, *study.space, data, settings.trust);
  study.described = study.model->at(study.space->physical(VectorXd::Zero(study.space->size())), false);
  study.twins = exact_twins(*study.model, data, progress);
  study.updating = update(*study.residual, settings, study.twins.values, progress);
  std::vector<VectorXd> as_well;
  for (const ParameterSet& set : study.updating.sets)
    if (set.as_well) as_well.push_back(set.values);
  study.deciding = deciding_measurements(*study.model, data, as_well, settings.trust);
  if (study.updating.refuted && study.model->dense())
    study.remedies = remedies({experiment, *study.model, *study.space, data, settings.trust, study.updating});
  study.warnings = update_warnings(study);
  return study;
}

ModalData described_modes(const Experiment& experiment) {
  const AskedParameters asked = asked_parameters(experiment);
  const auto q = static_cast<Index>(asked.unknowns.size());
  const ModalModel model(experiment.structure, experiment.elements,
                         {fem::natural_point(experiment.structure)}, asked, q);
  VectorXd guess(q);
  for (Index j = 0; j < q; ++j) guess[j] = asked.unknowns[static_cast<std::size_t>(j)].guess;
  const PredictedModes modes = model.at(guess, false);
  ModalData data{"the structure as described", {}};
  for (Index i = 0; i < modes.frequency_hz.size(); ++i) data.modes.push_back({modes.frequency_hz[i]});
  return data;
}

}  // namespace beamid::experiments
