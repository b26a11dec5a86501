#include "experiments/identify/compare/nonlinear_guess.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/identify/reproduction.hpp"
#include "filters/batch_estimator.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr Index longest_nonlinear_guess = 4096;  // samples
constexpr double nonlinear_guess_noise = 0.05;   // noise of it, of a channel's root mean square
constexpr double periods = 1.5;                  // that are taken up first
constexpr double far_frequency = 2.0;

// The stiffness of the oscillator at the record's frequency, where it is asked about.
void take_frequency(const JointModel& model, double frequency_hz, VectorXd& state) {
  const double omega = 2.0 * std::numbers::pi * frequency_hz, ratio = omega / model.mode_frequencies[0];
  if (!(ratio < far_frequency && ratio > 1.0 / far_frequency)) return;
  for (std::size_t j = 0; j < model.unknowns.size(); ++j)
    if (model.unknowns[j].quantity == "stiffness" && !model.unknowns[j].nuisance) try {
        state[model.unknown_places[j]] = model.unknowns[j].to_state(model.equivalent_mass * omega * omega);
      } catch (const std::invalid_argument&) {  // outside its bounds: the guess stays
      }
}

}  // namespace

FirstGuess nonlinear_guess(const JointModel& model, const std::vector<Observation>& observations,
                           const filters::Measurements& record, double frequency_hz) {
  const filters::Measurements part = beginning(record, std::min(longest_nonlinear_guess, record.size()));
  const Index samples = part.size();
  const StartDirections directions = start_directions(
      model, observations, start_scale(model, observations, part.outputs, part.time[samples - 1]));
  VectorXd state = initial_estimate(model, directions).mean;
  const MatrixXd unknowns = directions.unknowns(model.unknown_places, Eigen::all);
  FirstGuess known{state, unknowns * unknowns.transpose()};
  take_frequency(model, frequency_hz, state);
  const VectorXd size = part.outputs.rowwise().norm() / std::sqrt(static_cast<double>(samples));
  const MatrixXd noise = (nonlinear_guess_noise * size).cwiseMax(1e-300).cwiseAbs2().asDiagonal();
  const auto discrete = finest(model, part.time[samples - 1] / static_cast<double>(samples - 1), noise);

  filters::BatchSettings settings;
  settings.first_samples = samples_in(model, part, periods);
  settings.tolerance = 1e-3;
  const MatrixXd all = directions.all();
  settings.prior_factor = MatrixXd::Zero(all.cols(), all.cols());
  settings.prior_factor.diagonal().tail(directions.unknowns.cols()).setOnes();
  state = nearest_phase(*discrete, state, directions, part, settings.first_samples);
  const filters::BatchEstimate found = filters::estimate_batch(*discrete, state, all, part, settings);
  if (found.status == filters::BatchStatus::failed || found.covariance.size() == 0) return known;
  const MatrixXd covariance =
      unknowns * found.covariance.bottomRightCorner(unknowns.cols(), unknowns.cols()) * unknowns.transpose();
  return {found.state, guess_covariance(known.unknowns, covariance)};
}

}  // namespace beamid::experiments
