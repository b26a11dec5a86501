// What a SensingModel begins with: its constants, their prior, and a guess of the forces.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "experiments/identify/engine/compared_run.hpp"
#include "experiments/identify/engine/model_setting.hpp"
#include "experiments/identify/sensing/sensing_model.hpp"
#include "experiments/models/banded/continuum_motion.hpp"
#include "experiments/models/motion/beam_equations.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/signal/toolbox.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Kind = SensingConstant::Kind;

// White noise shows in second differences, of variance 6 r^2; slow motion does not.
double noise_of_bends(const VectorXd& samples) {
  const Index n = samples.size() - 2;
  const VectorXd bent = samples.head(n) - 2.0 * samples.segment(1, n) + samples.tail(n);
  double sum = 0.0, all = 0.0;
  Index count = 0;
  for (Index k = 0; k < n; ++k)
    if (std::isfinite(bent[k])) sum += bent[k] * bent[k], ++count;
  for (const double one : samples)
    if (std::isfinite(one)) all = std::max(all, std::abs(one));
  const double found = count > 0 ? std::sqrt(sum / (6.0 * static_cast<double>(count))) : 0.0;
  return std::clamp(found, 1e-5 * all, 0.1 * all);
}

filters::LatentInput::Process process_of(UnknownForce::Process process) {
  using To = filters::LatentInput::Process;
  switch (process) {
    case UnknownForce::Process::matern:
      return To::matern;
    case UnknownForce::Process::random_walk:
      return To::random_walk;
    case UnknownForce::Process::ornstein_uhlenbeck:
      break;
  }
  return To::ornstein_uhlenbeck;
}

// Whether the shapes of the modes depend on what [[parameters]] asks of the structure.
bool asks_about_shapes(const ModelSetting& setting) {
  if (setting.parameters.empty() || !setting.storey_springs.empty()) return false;
  const std::vector<ParameterDefault> defaults =
      beam_defaults(setting.continuum->structure, setting.parameters);
  return !keeps_mode_shapes(beam_equations(setting, properties_of(setting.parameters, defaults)));
}

}  // namespace

// P = A P A^T + Q, by doubling: P_2j = P_j + A^j P_j A^jT. A random walk's grows by as much as it is.
VectorXd unread_deviations(const filters::LinearGaussian& model, const MatrixXd& rows, Index samples) {
  MatrixXd a = model.a, p = model.q;
  Index after = 1;
  for (int i = 0; i < 40; ++i, after *= 2) {
    const MatrixXd more = a * p * a.transpose();
    const bool walks = after >= samples && more.trace() > 0.9 * p.trace();
    if (walks) break;
    p += more;
    if (!(more.cwiseAbs().maxCoeff() > 1e-9 * p.cwiseAbs().maxCoeff())) break;
    a = (a * a).eval();
  }
  return (rows * p * rows.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
}

SensingModel::SensingModel(const Experiment& experiment, const SensingRecord& record, const Choice& reduction,
                           const std::filesystem::path& folder)
    : setting_(model_setting(experiment, record.record, reduction, folder)),
      record_(std::make_shared<const filters::Measurements>(measurements(record.record))),
      measured_(record.measured) {
  const bool own = experiment.model.name == "beam";
  options_ = own ? experiment.model.options : filters::Options{{"sensor_bias", filters::OptionValue(true)}};
  make_structure();
  const auto inputs = static_cast<Index>(setting_.forces.size()),
             unknown = static_cast<Index>(experiment.unknown_forces.size());
  for (Index i = 0; i < unknown; ++i) {
    const UnknownForce& force = experiment.unknown_forces[static_cast<std::size_t>(i)];
    filters::LatentInput one;
    one.input = inputs - unknown + i;
    one.process = process_of(force.process);
    one.deviation = force.deviation.value_or(1.0);
    one.correlation_time = force.correlation_time.value_or(1.0);
    forces_.push_back(one);
  }
  noise_.setOnes(outputs());
  for (Index i = 0; i < measured_; ++i) {
    const Channel& channel = record.record.channels[static_cast<std::size_t>(i)];
    const double stated = stated_noise(experiment, channel);
    noise_[i] = stated > 0.0 ? stated : noise_of_bends(record.record.samples.row(i).transpose());
    if (stated > 0.0) {
      stated_.push_back(i);
      continue;
    }
    const auto same = std::find_if(constants_.begin(), constants_.end(), [&](const SensingConstant& one) {
      return one.index == static_cast<std::size_t>(channel.quantity);
    });
    if (same != constants_.end())
      same->channels.push_back(i);
    else
      constants_.push_back({Kind::sensor_noise,
                            std::string("noise_") + to_string(channel.quantity),
                            si_unit(channel.quantity),
                            static_cast<std::size_t>(channel.quantity),
                            {i}});
  }
  // One number for all sensors of a quantity: what motion adds to a floor differs from sensor to sensor, and
  // as a ratio between them nothing would correct it.
  for (const SensingConstant& one : constants_) {
    std::vector<double> floors;
    for (const Index i : one.channels) floors.push_back(noise_[i]);
    noise_(one.channels).setConstant(median(floors));
  }
  add_constants(experiment);
  turns_shapes_ = asks_about_shapes(setting_);
  const std::vector<Observation> observed(setting_.observations.begin(),
                                          setting_.observations.begin() + measured_);
  const double duration = record_->time[record_->size() - 1] - record_->time[0];
  scale_ = start_scale(model_, observed, record_->outputs.topRows(measured_), duration);
  make_start();
  make_prior();
  guess_forces();
}

void SensingModel::make_structure() {
  model_ = std::move(*model_registry().make("beam", options_, setting_));
  motion_ = std::dynamic_pointer_cast<const filters::LinearMotion>(model_.motion);
  if (!motion_)
    throw std::invalid_argument(
        "the whole mesh is too large to be followed under unknown forces; expected a [reduction]");
}

SensingModel SensingModel::with_shapes_at(const VectorXd& theta) const {
  SensingModel there = *this;
  for (std::size_t j = 0; j < constants_.size(); ++j)
    if (constants_[j].kind == Kind::parameter)
      there.setting_.parameters.at(constants_[j].index).guess = value(j, theta[static_cast<Index>(j)]);
  there.make_structure();
  there.make_start();
  return there;
}

// Parameters first, then forces; what of the sensors is unknown stands in constants_ already.
void SensingModel::add_constants(const Experiment& experiment) {
  std::vector<SensingConstant> before;
  if (!experiment.parameters.empty())
    for (std::size_t j = 0; j < model_.unknowns.size(); ++j)
      before.push_back({Kind::parameter, model_.unknowns[j].name, model_.unknowns[j].unit, j});
  for (std::size_t i = 0; i < experiment.unknown_forces.size(); ++i) {
    const UnknownForce& force = experiment.unknown_forces[i];
    if (!force.deviation)
      before.push_back({Kind::force_deviation, force.name + "_deviation", si_unit(force.quantity), i});
    if (!force.correlation_time && force.process != UnknownForce::Process::random_walk)
      before.push_back({Kind::correlation_time, force.name + "_correlation_time", "s", i});
  }
  constants_.insert(constants_.begin(), before.begin(), before.end());
}

void SensingModel::make_start() {
  start_ = initial_estimate(model_, start_directions(model_, setting_.observations, scale_));
}

void SensingModel::make_prior() {
  const auto q = static_cast<Index>(constants_.size());
  prior_ = {VectorXd::Zero(q), MatrixXd::Zero(q, q), {}};
  for (Index j = 0; j < q; ++j) {
    const SensingConstant& one = constants_[static_cast<std::size_t>(j)];
    double deviation = known_within;
    if (one.kind == Kind::parameter) {
      const Unknown& unknown = model_.unknowns[one.index];
      prior_.mean[j] = unknown.to_state(unknown.guess);
      deviation = unknown.deviation / std::abs(unknown.slope(prior_.mean[j]));
    }
    prior_.covariance(j, j) = deviation * deviation;
  }
}

// Several correlation times between the first mode's radian and the sampling interval; for each the deviation
// that makes the sensors read as much as they do. The likeliest of them is the guess.
void SensingModel::guess_forces() {
  const double radian = 1.0 / model_.mode_frequencies[0];
  const std::vector<filters::LatentInput> stated = forces_;
  const auto unstated = [&](Kind kind, std::size_t force) {
    return std::any_of(constants_.begin(), constants_.end(),
                       [&](const auto& one) { return one.kind == kind && one.index == force; });
  };
  if (stated.empty()) return;
  double best = std::numeric_limits<double>::infinity();
  std::vector<filters::LatentInput> likeliest = stated;
  for (const double share : {0.03, 0.1, 0.3, 1.0, 3.0}) {
    forces_ = stated;
    for (std::size_t i = 0; i < forces_.size(); ++i)
      if (unstated(Kind::correlation_time, i))
        forces_[i].correlation_time = std::max(share * radian, 0.5 * interval());
    VectorXd theta = prior_.mean;
    const filters::LinearGaussian unit = at(theta);
    const VectorXd moved = unread_deviations(unit, unit.h.topRows(measured_), record_->size());
    std::vector<double> ratios;
    for (Index i = 0; i < measured_; ++i) {
      const VectorXd row = record_->outputs.row(i);
      if (moved[i] > 0.0) ratios.push_back(root_mean_squares(row.transpose())[0] / moved[i]);
    }
    if (ratios.empty()) throw std::invalid_argument("no sensor is moved by the unknown forces");
    for (std::size_t i = 0; i < forces_.size(); ++i)
      if (unstated(Kind::force_deviation, i)) forces_[i].deviation = median(ratios);
    try {
      const double cost = filters::kalman_pass(at(theta), *record_, interval()).cost;
      if (cost < best) best = cost, likeliest = forces_;
    } catch (const std::runtime_error&) {  // another guess may do
    }
  }
  forces_ = likeliest;
}

// What sensors read of forces that do not change.

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Rank of what sensors read of constant forces (p x f), in parts of what it is made up of.
Index seen_combinations(const MatrixXd& read) {
  constexpr double rounding = 1e-8;
  if (read.size() == 0) return read.cols();
  return (Eigen::JacobiSVD<MatrixXd>(read).singularValues().array() > rounding).count();
}

}  // namespace

// Of a constant force the motion at rest, x = -A^-1 B; what the sensors read of it, beside what its parts
// are; nothing where there is no rest.
MatrixXd SensingModel::constant_forces_read(const VectorXd& theta) const {
  VectorXd state = VectorXd::Zero(start_.mean.size());
  state(model_.unknown_places) = parameters_at(theta);
  const Index all = motion_->motion_size(), r = 2 * model_.motion_size();
  MatrixXd a, b, h;
  motion_->motion_matrix(state, a);
  motion_->input_matrix(state, b);
  const VectorXd none = VectorXd::Zero(motion_->input_size());
  motion_->output_jacobian(state, none, h);
  const Eigen::FullPivLU<MatrixXd> solver(a.topLeftCorner(r, r));
  if (!solver.isInvertible() || all < r) return {};
  VectorXd rest, shown;
  motion_->output(state, none, rest);
  MatrixXd read(measured_, static_cast<Index>(forces_.size()));
  for (Index i = 0; i < read.cols(); ++i) {
    const Index input = forces_[static_cast<std::size_t>(i)].input;
    const VectorXd x = -solver.solve(b.col(input).head(r));
    VectorXd unit = none;
    unit[input] = 1.0;
    motion_->output(state, unit, shown);
    const VectorXd direct = (shown - rest).head(measured_);
    const VectorXd sum = direct + h.topLeftCorner(measured_, r) * x;
    const VectorXd size = direct.cwiseAbs() + h.topLeftCorner(measured_, r).cwiseAbs() * x.cwiseAbs();
    read.col(i) = (sum.array() / size.array().max(1e-300)).matrix();
  }
  return read;
}

int SensingModel::unseen_constant_forces(const VectorXd& theta) const {
  const MatrixXd read = constant_forces_read(theta);
  return static_cast<int>(read.cols() - seen_combinations(read));
}

std::vector<Index> SensingModel::sole_zeros(const VectorXd& theta) const {
  MatrixXd read = constant_forces_read(theta);
  const Index all = seen_combinations(read);
  std::vector<Index> sole;
  for (Index i = 0; i < read.rows(); ++i) {
    MatrixXd others = read;
    others.row(i).setZero();
    if (seen_combinations(others) < all) sole.push_back(i);
  }
  return sole;
}

}  // namespace beamid::experiments
