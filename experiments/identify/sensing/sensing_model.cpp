#include "experiments/identify/sensing/sensing_model.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/rig/logged_test.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

bool is_at(const UnknownForce& force, const Channel& channel, const fem::Structure& structure) {
  if (channel.quantity != force.quantity) return false;
  if (force.quantity == Quantity::base_acceleration) return true;
  if (!structure.has_positions()) return channel.place == force.at;
  const double natural = fem::natural_point(structure).position;
  return std::abs(channel.position.value_or(natural) - force.position.value_or(natural)) <
         1e-9 * structure.extent();
}

Channel channel_of(const VirtualSensor& sensor) {
  return {sensor.quantity, sensor.name, sensor.position, sensor.distance, sensor.at};
}

Channel channel_of(const UnknownForce& force) {
  return {force.quantity, force.name, force.position, 0.0, force.at};
}

}  // namespace

SensingRecord sensing_record(const Experiment& experiment, const Record& record, const Place& place) {
  SensingRecord result;
  result.sensors.resize(experiment.virtual_sensors.size());
  result.forces.resize(experiment.unknown_forces.size());
  std::vector<Index> outputs = output_channels(record), inputs;
  if (outputs.empty()) throw InputError(place, "the record has no motion; expected a sensor's channel");
  for (const Index i : input_channels(record)) {
    bool known = true;
    for (std::size_t j = 0; j < experiment.unknown_forces.size(); ++j)
      if (is_at(experiment.unknown_forces[j], record.channels[static_cast<std::size_t>(i)],
                experiment.structure)) {
        result.forces[j] = record.samples.row(i);
        known = false;
      }
    if (known) inputs.push_back(i);
  }
  result.measured = static_cast<Index>(outputs.size());
  const auto virtuals = static_cast<Index>(experiment.virtual_sensors.size()),
             unknown = static_cast<Index>(experiment.unknown_forces.size()),
             known = static_cast<Index>(inputs.size());
  Record& all = result.record;
  all = record;
  all.channels.clear();
  all.samples.setConstant(result.measured + virtuals + known + unknown, record.size(), std::nan(""));
  const auto take = [&](const std::vector<Index>& rows) {
    for (const Index i : rows) {
      all.samples.row(static_cast<Index>(all.channels.size())) = record.samples.row(i);
      all.channels.push_back(record.channels[static_cast<std::size_t>(i)]);
    }
  };
  take(outputs);
  for (const VirtualSensor& sensor : experiment.virtual_sensors) all.channels.push_back(channel_of(sensor));
  take(inputs);
  for (const UnknownForce& force : experiment.unknown_forces) all.channels.push_back(channel_of(force));
  all.samples.bottomRows(unknown).setZero();
  return result;
}

SensingRecord simulated_sensing(const Experiment& experiment, const std::filesystem::path& folder,
                                const Place& place, const Progress& progress) {
  Experiment test = experiment;
  if (test.sensors.empty()) {
    test.sensors.resize(2);
    test.sensors[0].quantity = Quantity::displacement;
  }
  const std::size_t own = test.sensors.size();
  for (const VirtualSensor& sensor : experiment.virtual_sensors)
    test.sensors.push_back({sensor.name, sensor.position, sensor.quantity, 0.0, sensor.distance, sensor.at});
  const Record whole = logged_test(test, folder, "simulated", progress).record;
  Record seen = whole;
  seen.channels.clear();
  std::vector<Index> rows;
  for (std::size_t i = 0; i < whole.channels.size(); ++i) {
    if (i >= own && i < test.sensors.size()) continue;
    rows.push_back(static_cast<Index>(i));
    seen.channels.push_back(whole.channels[i]);
    if (i < own) seen.channels.back().noise = test.sensors[i].noise;
  }
  seen.samples = whole.samples(rows, Eigen::all);
  SensingRecord result = sensing_record(experiment, seen, place);
  for (std::size_t i = own; i < test.sensors.size(); ++i)
    result.sensors[i - own] = whole.samples.row(static_cast<Index>(i));
  return result;
}

namespace {

using Kind = SensingConstant::Kind;

}  // namespace

MatrixXd SensingForm::force_rows() const {
  const auto forces = static_cast<Index>(latent->latent().size());
  MatrixXd rows = MatrixXd::Zero(forces, static_cast<Index>(moving.size()));
  for (Index i = 0; i < forces; ++i) {
    const Index place = latent->place(static_cast<std::size_t>(i));
    rows(i, std::lower_bound(moving.begin(), moving.end(), place) - moving.begin()) = 1.0;
  }
  return rows;
}

MatrixXd SensingForm::row_without_offset(Index i) const {
  MatrixXd row = matrices.h.row(i);
  for (const auto& [output, place] : offsets)
    if (output == i) row(0, place) = 0.0;
  return row;
}

void SensingModel::take_prior(const SensingModel& other) {
  for (std::size_t j = 0; j < constants_.size(); ++j) {
    if (constants_[j].kind != Kind::parameter) continue;
    const auto place = static_cast<Index>(j);
    prior_.mean[place] = other.prior_.mean[place];
    prior_.covariance(place, place) = other.prior_.covariance(place, place);
  }
}

VectorXd SensingModel::parameters_at(const VectorXd& theta) const {
  VectorXd eta(static_cast<Index>(model_.unknowns.size()));
  for (Index j = 0; j < eta.size(); ++j) {
    const Unknown& unknown = model_.unknowns[static_cast<std::size_t>(j)];
    eta[j] = unknown.to_state(unknown.guess);
  }
  for (std::size_t j = 0; j < constants_.size(); ++j)
    if (constants_[j].kind == Kind::parameter)
      eta[static_cast<Index>(constants_[j].index)] = theta[static_cast<Index>(j)];
  return eta;
}

std::vector<filters::LatentInput> SensingModel::forces_at(const VectorXd& theta) const {
  std::vector<filters::LatentInput> forces = forces_;
  for (std::size_t j = 0; j < constants_.size(); ++j) {
    const double factor = std::exp(theta[static_cast<Index>(j)]);
    if (constants_[j].kind == Kind::force_deviation) forces[constants_[j].index].deviation *= factor;
    if (constants_[j].kind == Kind::correlation_time) forces[constants_[j].index].correlation_time *= factor;
  }
  return forces;
}

VectorXd SensingModel::noise_at(const VectorXd& theta) const {
  VectorXd noise = noise_;
  for (std::size_t j = 0; j < constants_.size(); ++j)
    if (constants_[j].kind == Kind::sensor_noise)
      for (const Index i : constants_[j].channels) noise[i] *= std::exp(theta[static_cast<Index>(j)]);
  return noise;
}

SensingForm SensingModel::form(const VectorXd& theta, const std::vector<filters::LatentInput>& forces) const {
  const auto latent = std::make_shared<filters::LatentInputs>(motion_, forces);
  SensingForm result{latent, {}, latent->with_latent(start_), {}, {}};
  std::vector<Index> known;
  for (const Index place : model_.unknown_places) known.push_back(latent->moved(place));
  for (Index i = 0; i < result.start.mean.size(); ++i)
    if (std::find(known.begin(), known.end(), i) == known.end()) result.moving.push_back(i);
  const VectorXd eta = parameters_at(theta);
  result.start.mean(known) = eta;
  result.start.covariance(known, Eigen::all).setZero();
  result.start.covariance(Eigen::all, known).setZero();

  const MatrixXd q = latent->process_noise(result.start.mean, interval());
  const MatrixXd r = noise_at(theta).cwiseAbs2().asDiagonal();
  result.model = filters::discretise(latent, interval(), "exponential", {q, r});
  result.matrices = filters::linear_gaussian(*result.model, known, eta, result.start, record_->inputs.rows());
  for (const JointModel::Offset& offset : model_.offsets) {
    const auto found =
        std::lower_bound(result.moving.begin(), result.moving.end(), latent->moved(offset.place));
    result.offsets.emplace_back(offset.channel, found - result.moving.begin());
  }
  for (Index i = measured_; i < outputs(); ++i) result.matrices.h.row(i) = result.row_without_offset(i);
  return result;
}

// sigma and tau of a walk that changes as much from sample to sample: 2 sigma^2 (1 - rho(dt)).
SensingForm SensingModel::form_of_walks(const VectorXd& theta) const {
  std::vector<filters::LatentInput> forces = forces_at(theta);
  for (filters::LatentInput& one : forces) {
    const double times = interval() / one.correlation_time, l = std::sqrt(3.0) * times;
    using Process = filters::LatentInput::Process;
    const double kept = one.process == Process::matern ? (1.0 + l) * std::exp(-l) : std::exp(-times);
    if (one.process != Process::random_walk)
      one = {one.input, Process::random_walk, one.deviation * std::sqrt(2.0 * (1.0 - kept)), interval()};
  }
  return form(theta, forces);
}

bool SensingModel::has_offset(Index i) const {
  return std::any_of(model_.offsets.begin(), model_.offsets.end(),
                     [&](const auto& one) { return one.channel == i; });
}

filters::InnovationProblem SensingModel::problem(const filters::Measurements& record) const {
  return {[this](const VectorXd& theta) { return at(theta); }, record, interval(), prior_};
}

filters::InnovationProblem SensingModel::wider_problem(const filters::Measurements& record,
                                                       double factor) const {
  filters::InnovationProblem wider = problem(record);
  wider.model = [this, factor](const VectorXd& theta) {
    filters::LinearGaussian form = at(theta);
    for (const Index i : stated_) form.r(i, i) *= factor * factor;
    return form;
  };
  return wider;
}

double SensingModel::value(std::size_t constant, double theta) const {
  const SensingConstant& one = constants_[constant];
  switch (one.kind) {
    case Kind::parameter:
      return model_.unknowns[one.index].to_physical(theta);
    case Kind::force_deviation:
      return forces_[one.index].deviation * std::exp(theta);
    case Kind::correlation_time:
      return forces_[one.index].correlation_time * std::exp(theta);
    case Kind::sensor_noise:
      break;
  }
  return noise_[one.channels.front()] * std::exp(theta);
}

double SensingModel::place(std::size_t constant, double value) const {
  const SensingConstant& one = constants_[constant];
  if (one.kind == Kind::parameter) return model_.unknowns[one.index].to_state(value);
  return std::log(value / this->value(constant, 0.0));
}

double SensingModel::slope(std::size_t constant, double theta) const {
  const SensingConstant& one = constants_[constant];
  return one.kind == Kind::parameter ? model_.unknowns[one.index].slope(theta) : value(constant, theta);
}

}  // namespace beamid::experiments
