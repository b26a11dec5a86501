#include "experiments/identify/sensing/sensing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/compared_run.hpp"
#include "experiments/identify/sensing/sensing_constants.hpp"
#include "experiments/identify/sensing/sensing_model.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/signal/missing_samples.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/memory_need.hpp"
#include "experiments/text/progress.hpp"
#include "fem/modes.hpp"
#include "filters/latent_inputs.hpp"
#include "filters/random.hpp"
#include "filters/running_filter.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// The smoother is linear in the readings, and its gains do not depend on them: what it makes of a constant
// beside nothing is what a zero that is off adds.
std::vector<SoleZero> sole_zeros(const SensingModel& model, const VectorXd& theta,
                                 const filters::LinearGaussian& form, const filters::KalmanPass& pass,
                                 const std::vector<Channel>& channels, const MatrixXd& rows,
                                 const MatrixXd& feed) {
  std::vector<SoleZero> found;
  filters::LinearGaussian still = form;
  still.start.mean.setZero();
  for (const Index i : model.sole_zeros(theta)) {
    const Channel& channel = channels[static_cast<std::size_t>(i)];
    const double read = root_mean_squares(model.record().outputs.row(i))[0];
    if (!(read > 0.0)) continue;
    SoleZero zero{channel.name, si_unit(channel.quantity), std::pow(10.0, std::floor(std::log10(read))), {}};
    filters::Measurements shifted = model.record();
    shifted.inputs.setZero();
    for (auto& reading : shifted.outputs.reshaped())
      if (std::isfinite(reading)) reading = 0.0;
    shifted.outputs.row(i).array() += zero.off;
    const filters::KalmanPass of_shifted = filters::kalman_pass(still, shifted, pass);
    const VectorXd means = filters::smoothed_means(still, shifted, of_shifted, rows, feed).rowwise().mean();
    zero.shifts.assign(means.begin(), means.end());
    found.push_back(std::move(zero));
  }
  return found;
}

namespace {

// Histories as they may have been, and the damage that they do.

/// One history of the rows C x_k + D u_k given the record (c x N): a record drawn from the model, what the
/// smoother makes of the difference from it, and its own motion [durbin2002].
/// @param pass of the record through the filter
Eigen::MatrixXd drawn_rows(const SensingModel& model, const filters::LinearGaussian& form,
                           const filters::KalmanPass& pass, const Eigen::MatrixXd& rows,
                           const Eigen::MatrixXd& feed, filters::RandomStream& random);

/// Of every virtual strain: damage of the drawn histories, their mean and where 95 % of them lie. The
/// smoothed history itself varies less than the motion did, and damages less.
void add_damages(const Experiment& experiment, const SensingModel& model, const filters::LinearGaussian& form,
                 const filters::KalmanPass& pass, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& feed,
                 SensingStudy& study);

// B with B B^T = P, which may be singular.
MatrixXd symmetric_root(const MatrixXd& p) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(p);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

MatrixXd drawn_rows(const SensingModel& model, const filters::LinearGaussian& form,
                    const filters::KalmanPass& pass, const MatrixXd& rows, const MatrixXd& feed,
                    filters::RandomStream& random) {
  filters::Measurements record = model.record();
  const Index n = form.a.rows(), samples = record.size();
  const MatrixXd moved = symmetric_root(form.q), noise = symmetric_root(form.r);
  VectorXd x = symmetric_root(form.start.covariance) * random.normal(n, 1);
  MatrixXd own(rows.rows(), samples);
  for (Index k = 0; k < samples; ++k) {
    own.col(k) = rows * x;
    record.outputs.col(k) -= form.h * x + noise * random.normal(form.h.rows(), 1);
    x = (form.a * x + moved * random.normal(n, 1)).eval();
  }
  return filters::smoothed_means(form, record, filters::kalman_pass(form, record, pass), rows, feed) + own;
}

void add_damages(const Experiment& experiment, const SensingModel& model, const filters::LinearGaussian& form,
                 const filters::KalmanPass& pass, const MatrixXd& rows, const MatrixXd& feed,
                 SensingStudy& study) {
  constexpr int draws = 40;
  const std::vector<VirtualSensor>& sensors = experiment.virtual_sensors;
  const auto fails = [](const VirtualSensor& one) {
    return one.quantity == Quantity::strain && !one.bending_moment;
  };
  if (std::none_of(sensors.begin(), sensors.end(), fails)) return;
  std::vector<std::vector<FatigueDamage>> found(sensors.size());
  for (int draw = 0; draw < draws; ++draw) {
    filters::RandomStream random(1, static_cast<std::uint64_t>(draw));
    const MatrixXd histories = drawn_rows(model, form, pass, rows, feed.topRows(rows.rows()), random);
    for (std::size_t i = 0; i < sensors.size(); ++i)
      if (fails(sensors[i]))
        found[i].push_back(
            fatigue_damage(histories.row(static_cast<Index>(i)).transpose(), *experiment.fatigue));
  }
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (found[i].empty()) continue;
    SensingStudy::SensorDamage one{sensors[i].name, {}};
    double logs = 0.0, squares = 0.0;
    for (const FatigueDamage& drawn : found[i]) {
      one.damage.damage += drawn.damage / draws;
      one.damage.cycles += drawn.cycles / draws;
      one.damage.narrow_band += drawn.narrow_band / draws;
      logs += std::log(drawn.damage) / draws;
    }
    for (const FatigueDamage& drawn : found[i])
      squares += std::pow(std::log(drawn.damage) - logs, 2) / (draws - 1);
    const double half = quantile_95 * std::sqrt(squares);
    one.lower_95 = std::exp(logs - half), one.upper_95 = std::exp(logs + half);
    const FatigueLaw& law = *experiment.fatigue;
    one.damage.equivalent_range =
        law.strain_range * std::pow(one.damage.damage * law.cycles / one.damage.cycles, 1.0 / law.exponent);
    study.damages.push_back(std::move(one));
  }
}

// Histories by a registered filter, sample after sample.

struct FilteredRows {
  filters::SmoothedRows rows;        ///< C x_k + D u_k given the readings up to sample k
  std::vector<std::string> remarks;  ///< of the filter
};

/// @param rows C (c x n) of the form's motion; @param feed D (c x m)
/// @throws std::invalid_argument where the filter refuses the model; std::runtime_error where it fails, with
/// the sample's time.
FilteredRows filtered_rows(SensingForm form, const Choice& filter, const filters::Measurements& record,
                           const Eigen::MatrixXd& rows, const Eigen::MatrixXd& feed);

/// Whether a filter takes nothing for known of the forces, and needs SensingModel::form_of_walks.
bool estimates_unknown_inputs(const std::string& filter) {
  return filters::filter_registry().find(filter).contracts.contains(filters::contract::unknown_inputs);
}

FilteredRows filtered_rows(SensingForm form, const Choice& filter, const filters::Measurements& record,
                           const MatrixXd& rows, const MatrixXd& feed) {
  const auto made = filters::filter_registry().make(filter.name, filter.options, std::move(form.model));
  filters::RunningFilter run(*made);
  run.start(form.start);
  const Index n = record.size();
  FilteredRows result{{MatrixXd(rows.rows(), n), MatrixXd(rows.rows(), n)}, {}};
  for (Index k = 0; k < n; ++k) {
    const VectorXd input = record.inputs.size() > 0 ? VectorXd(record.inputs.col(k)) : VectorXd();
    if (!run.take_in({record.time[k], record.outputs.col(k), input}))
      throw std::runtime_error(
          fmt::format("{} failed at {:.6g} s: {}", filter.name, run.failure()->time, run.failure()->reason));
    const filters::Gaussian estimate = made->marginal(form.moving);
    result.rows.means.col(k) = rows * estimate.mean;
    if (input.size() > 0) result.rows.means.col(k) += feed * input;
    result.rows.deviations.col(k) =
        (rows * estimate.covariance * rows.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
  }
  result.remarks = made->remarks();
  return result;
}

double rms(const VectorXd& values) {
  return root_mean_squares(values.transpose())[0];
}

// Without the mean of what was read.
VectorXd centred(VectorXd values) {
  double sum = 0.0, count = 0.0;
  for (const double one : values)
    if (std::isfinite(one)) sum += one, ++count;
  if (count > 0.0) values.array() -= sum / count;
  return values;
}

// Of the smoother's pass: covariance and gain of every sample, where a constant in the state never settles.
void require_memory_of(const SensingModel& model) {
  const auto n = static_cast<double>(model.at(model.prior().mean).a.rows()),
             p = static_cast<double>(model.outputs());
  require_memory(static_cast<double>(model.record().size()), fmt::format("samples of {} states", n),
                 sizeof(double) * (n * n + n * p + p * p + 8.0 * (n + p)));
}

// What is said of colour is that of the sensor with the most, p-values counted as often as there are sensors
// (Bonferroni): noise of one sensor in several may be far from white.
void take_worst_colour(const filters::FilterRun& run, filters::InnovationConsistency& all) {
  constexpr Index fewest = 100;  // innovations, for the test
  const Index sensors = run.whitened_innovations.rows();
  for (Index i = 0; i < sensors; ++i) {
    const VectorXd white = run.whitened_innovations.row(i);
    if (white.array().isFinite().count() < fewest) continue;
    filters::FilterRun one;
    one.innovations = run.innovations.row(i);
    one.whitened_innovations = white.transpose();
    one.normalised_squares = white.array().isFinite().select(white.array().square(), 0.0);
    const filters::InnovationConsistency own = filters::innovation_consistency(one);
    const double p = static_cast<double>(sensors) * own.whiteness_p_value;
    all.whiteness_p_value = i == 0 ? std::min(1.0, p) : std::min(all.whiteness_p_value, p);
    if (std::abs(own.lag_one_correlation) > std::abs(all.lag_one_correlation))
      all.lag_one_correlation = own.lag_one_correlation;
  }
}

filters::InnovationConsistency consistency_of(const filters::KalmanPass& pass, Index measured) {
  filters::FilterRun run;
  run.innovations = pass.innovations.topRows(measured);
  run.whitened_innovations = MatrixXd::Constant(measured, pass.innovations.cols(), std::nan(""));
  run.normalised_squares = VectorXd::Zero(pass.innovations.cols());
  for (Index k = 0; k < pass.innovations.cols(); ++k) {
    const filters::KalmanStep& step = pass.step(k);
    if (step.seen.empty()) continue;
    const Eigen::LLT<MatrixXd> factor(step.innovation_covariance);
    const VectorXd white = factor.matrixL().solve(VectorXd(pass.innovations.col(k)(step.seen)));
    run.whitened_innovations.col(k)(step.seen) = white;
    run.normalised_squares[k] = white.squaredNorm();
  }
  filters::InnovationConsistency found = filters::innovation_consistency(run);
  take_worst_colour(run, found);
  return found;
}

// At the constants that all sensors together say: what is checked is the structure, not their estimate. A
// constant offset of the sensor is its own, and no error of the prediction; nor is what a constant force does
// to it where no other sensor sees that, as none does beside accelerometers.
LeftOutSensor left_out(const SensingModel& model, const SensingForm& at_found, const Channel& channel,
                       double noise, bool sees_constants_alone, Index i) {
  const filters::LinearGaussian& form = at_found.matrices;
  filters::Measurements rest = model.record();
  const VectorXd read = rest.outputs.row(i);
  rest.outputs.row(i).setConstant(std::nan(""));
  const filters::KalmanPass pass = filters::kalman_pass(form, rest, model.interval());
  const filters::SmoothedRows found =
      filters::smoothed_rows(form, rest, pass, at_found.row_without_offset(i), form.d.row(i));
  const VectorXd error = read - found.means.row(0).transpose();
  LeftOutSensor result{channel.name, si_unit(channel.quantity)};
  const bool free_mean = model.has_offset(i) || sees_constants_alone;
  result.root_mean_square = rms(free_mean ? centred(read) : read);
  result.error = rms(free_mean ? centred(error) : error);
  result.expected = std::sqrt(std::pow(rms(found.deviations.row(0)), 2) + noise * noise);
  return result;
}

void add_histories(const Experiment& experiment, const SensingRecord& record,
                   const filters::LinearGaussian& form, const filters::SmoothedRows& found,
                   const MatrixXd& rows, SensingStudy& study) {
  const VectorXd unread = unread_deviations(form, rows, study.time.size());
  const std::size_t sensors = experiment.virtual_sensors.size();
  for (std::size_t j = 0; j < sensors + experiment.unknown_forces.size(); ++j) {
    const auto row = static_cast<Index>(j);
    SensedHistory history;
    const bool is_force = j >= sensors;
    const VectorXd& truth = is_force ? record.forces[j - sensors] : record.sensors[j];
    if (is_force) {
      const UnknownForce& force = experiment.unknown_forces[j - sensors];
      history.name = force.name, history.unit = si_unit(force.quantity);
    } else {
      const VirtualSensor& sensor = experiment.virtual_sensors[j];
      history.name = sensor.name;
      history.unit = sensor.bending_moment ? "N m" : si_unit(sensor.quantity);
    }
    history.mean = found.means.row(row);
    history.deviation = found.deviations.row(row);
    history.unread_deviation = unread[row];
    if (truth.size() > 0) history.truth = truth;
    if (!study.filter.empty()) history.first = study.time.size() / 10;
    study.histories.push_back(std::move(history));
  }
}

// C and D of what was asked: virtual sensors, then forces.
MatrixXd wanted_rows(const SensingForm& form, Index virtuals) {
  const MatrixXd forces = form.force_rows();
  MatrixXd rows(virtuals + forces.rows(), forces.cols());
  rows.topRows(virtuals) = form.matrices.h.bottomRows(virtuals);
  rows.bottomRows(forces.rows()) = forces;
  return rows;
}
MatrixXd wanted_feed(const SensingForm& form, Index virtuals) {
  const auto forces = static_cast<Index>(form.latent->latent().size());
  MatrixXd feed = MatrixXd::Zero(virtuals + forces, form.matrices.d.cols());
  feed.topRows(virtuals) = form.matrices.d.bottomRows(virtuals);
  return feed;
}

FilteredRows histories_by(const Choice& filter, const SensingModel& model, const VectorXd& theta) {
  SensingForm form =
      estimates_unknown_inputs(filter.name) ? model.form_of_walks(theta) : model.form_at(theta);
  const Index virtuals = model.outputs() - model.measured();
  const MatrixXd rows = wanted_rows(form, virtuals), feed = wanted_feed(form, virtuals);
  return filtered_rows(std::move(form), filter, model.record(), rows, feed);
}

SensingStudy sensed(const Experiment& experiment, const SensingRecord& record, const Choice& reduction,
                    const std::filesystem::path& folder, const Progress& progress,
                    const std::optional<Choice>& filter, const std::optional<VectorXd>& constants) {
  for (const VirtualSensor& sensor : experiment.virtual_sensors)
    for (const ParameterChoice& parameter : experiment.parameters)
      if (sensor.bending_moment && parameter.quantity == "bending_stiffness")
        throw std::invalid_argument(
            "the bending moment is E I w'' with E I as described, which [[parameters]] requests; expected "
            "quantity = \"strain\", or no bending_stiffness among the unknowns");
  auto found_in = std::make_unique<SensingModel>(experiment, record, reduction, folder);
  SensingStudy study;
  study.reduction = to_text(reduction);
  study.time = record.record.time;
  require_memory_of(*found_in);
  Countdown countdown(progress, static_cast<std::size_t>(found_in->measured()) + 2, "passes");
  countdown.begin("likelihood");
  const FoundConstants found =
      find_constants({experiment, record, reduction, folder}, found_in, constants, study);
  const SensingModel& model = *found_in;
  study.coordinates = model.coordinates();
  study.forces = model.forces_at(found.theta);
  study.unseen_constants = model.unseen_constant_forces(found.theta);

  countdown.begin(filter ? filter->name : "smoother");
  const SensingForm at_found = model.form_at(found.theta);
  const filters::LinearGaussian& form = at_found.matrices;
  const filters::KalmanPass pass = filters::kalman_pass(form, model.record(), model.interval());
  study.innovations = consistency_of(pass, model.measured());
  const Index virtuals = model.outputs() - model.measured();
  const MatrixXd rows = wanted_rows(at_found, virtuals), feed = wanted_feed(at_found, virtuals);
  const filters::SmoothedRows smoothed = filters::smoothed_rows(form, model.record(), pass, rows, feed);
  if (filter) {
    FilteredRows by_filter = histories_by(*filter, model, found.theta);
    study.filter = filter->name;
    study.filter_remarks = by_filter.remarks;
    add_histories(experiment, record, form, by_filter.rows, rows, study);
    for (std::size_t j = 0; j < study.histories.size(); ++j) {
      SensedHistory& one = study.histories[j];
      const VectorXd apart = one.mean - smoothed.means.row(static_cast<Index>(j)).transpose();
      one.from_smoother = rms(apart.tail(apart.size() - one.first));
    }
  } else {
    add_histories(experiment, record, form, smoothed, rows, study);
  }
  study.sole_zeros = sole_zeros(model, found.theta, form, pass, record.record.channels, rows, feed);
  if (experiment.fatigue) add_damages(experiment, model, form, pass, rows.topRows(virtuals), feed, study);

  const VectorXd noise = model.noise_at(found.theta);
  for (Index i = 0; i < model.measured(); ++i) {
    const Channel& channel = record.record.channels[static_cast<std::size_t>(i)];
    VectorXd read = record.record.samples.row(i);
    if (model.has_offset(i)) read = centred(read);
    study.noise.push_back({channel.name, si_unit(channel.quantity), noise[i], rms(read),
                           stated_noise(experiment, channel) > 0.0});
  }
  const std::vector<Index> alone = model.sole_zeros(found.theta);
  for (Index i = 0; i < model.measured() && model.measured() > 1; ++i) {
    const Channel& channel = record.record.channels[static_cast<std::size_t>(i)];
    countdown.begin(channel.name);
    const bool sees_constants_alone = std::find(alone.begin(), alone.end(), i) != alone.end();
    study.left_out.push_back(left_out(model, at_found, channel, noise[i], sees_constants_alone, i));
  }
  return study;
}

}  // namespace

double SensedHistory::root_mean_square() const {
  return rms(mean.tail(mean.size() - first));
}
double SensedHistory::reported_error() const {
  return rms(deviation.tail(deviation.size() - first));
}
double SensedHistory::error() const {
  return rms((mean - *truth).tail(mean.size() - first));
}

bool SensingStudy::contradicted() const {
  return innovations.mean_normalised_square > largest_square ||
         std::any_of(left_out.begin(), left_out.end(), [](const auto& one) { return one.contradicts(); }) ||
         std::any_of(noise.begin(), noise.end(), [](const auto& one) { return one.explains_too_much(); });
}

Choice sensing_reduction(const Experiment& experiment, double interval) {
  constexpr Index most = 12;
  if (experiment.reduction_is_stated) return experiment.reduction;
  const fem::StructuralSystem system = fem::assemble(experiment.structure, experiment.elements);
  Choice choice{"none", {}};
  if (experiment.structure.is_chain() && system.size() <= most) return choice;
  const fem::Modes modes = fem::modes(system, std::min(most, system.size()));
  const double highest = 0.8 * std::numbers::pi / interval;
  const Index kept = std::max<Index>(1, (modes.angular_frequency.array() < highest).count());
  choice.name = "modal_truncation";
  choice.options = reduction::reduction_registry().completed(
      choice.name, {{"modes", static_cast<double>(kept)}, {"static_correction", true}});
  return choice;
}

SensingStudy study_sensing(const Experiment& experiment, const SensingRecord& record, const Choice& reduction,
                           const std::filesystem::path& folder, const Progress& progress,
                           const std::optional<Choice>& filter) {
  return sensed(experiment, record, reduction, folder, progress, filter, {});
}

SensingStudy study_sensing_at(const Experiment& experiment, const SensingRecord& record,
                              const Choice& reduction, const std::filesystem::path& folder,
                              const VectorXd& constants) {
  return sensed(experiment, record, reduction, folder, unwatched, {}, constants);
}

}  // namespace beamid::experiments
