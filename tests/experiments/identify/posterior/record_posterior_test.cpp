// The posterior of two storeys from the record of an earthquake at the ground and on the roof.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/posterior/posterior_study.hpp"

namespace beamid::experiments::record_posterior_test {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

const std::filesystem::path folder = BEAMID_SOURCE_DIR "/docs/tutorials/15_shear_building";

// Of equal masses m the roof's answer to the ground is k1 k2 / (m^2 s^4 + m (k1 + 2 k2) s^2 + k1 k2): (k1,
// k2) and (2 k2, k1 / 2) cannot be told apart, nor where all modes have one damping ratio: their shares of
// the answer are the same.
std::string building(const std::string& more = "") {
  return R"(
title = "two floors"
[chain]
masses_kg = [100, 100]
stiffnesses_n_per_m = [1.0e5, 8.0e4]
heights_m = [3, 3]
[damping]
law = "modal"
ratio = 0.02
[excitation]
kind = "base"
file = "ground.csv"
[simulation]
duration_s = 4
sampling_rate_hz = 100
seed = 3
[reduction]
method = "none"
[[sensors]]
quantity = "acceleration"
position_m = 6
noise_m_per_s2 = 1
)" + more;
}

const std::string asked = R"(
[[parameters]]
quantity = "storey_stiffness"
from_m = 0
to_m = 3
form = "logarithmic"
relative_deviation = 0.5
[[parameters]]
quantity = "storey_stiffness"
from_m = 3
to_m = 6
form = "logarithmic"
relative_deviation = 0.5
)";

Experiment experiment_of(const std::string& text) {
  return read_experiment(TomlTable::parse(text, "building.toml"));
}

PosteriorSettings few_draws() {
  PosteriorSettings settings;
  settings.particles = 100;
  settings.prior_climbs = 10;
  settings.chains.draws = 50;
  settings.chains.warm_up = 50;
  settings.importance_draws = 600;
  return settings;
}

PosteriorStudy study_of(const Experiment& experiment) {
  const PosteriorSettings settings = few_draws();
  return study_posterior(experiment, simulated_sensing(experiment, folder, {}, unwatched), settings, folder,
                         {});
}

// ln L + ln prior of u on a grid of so many points to either side.
struct Grid {
  VectorXd u;
  MatrixXd log_density;
};
Grid grid_of(const Likelihood& likelihood, double reach, Index points) {
  Grid grid{VectorXd::LinSpaced(points, -reach, reach), MatrixXd(points, points)};
  for (Index i = 0; i < points; ++i)
    for (Index j = 0; j < points; ++j) {
      const VectorXd u{{grid.u[i], grid.u[j]}};
      grid.log_density(i, j) = likelihood.at(u, false).log - 0.5 * u.squaredNorm() - std::log(2.0 * M_PI);
    }
  return grid;
}

TEST(RecordPosterior, HasTwoHumpsOfTheMassesThatQuadratureSays) {
  // Oracle: the same density summed on a grid of 61 by 61 points, in which the humps are u_1 above and
  // below the line between them.
  const Experiment experiment = experiment_of(building(asked));
  const PosteriorStudy study = study_of(experiment);
  ASSERT_TRUE(study.explains());
  ASSERT_EQ(study.posterior.notable_humps(), 2U);
  const Grid grid = grid_of(*study.likelihood, 1.5, 61);
  const double top = grid.log_density.maxCoeff(), cell = std::pow(grid.u[1] - grid.u[0], 2);
  const VectorXd first = study.posterior.humps[0].top, second = study.posterior.humps[1].top;
  double all = 0.0, of_first = 0.0;
  for (Index i = 0; i < grid.u.size(); ++i)
    for (Index j = 0; j < grid.u.size(); ++j) {
      const VectorXd u{{grid.u[i], grid.u[j]}};
      const double mass = std::exp(grid.log_density(i, j) - top);
      all += mass;
      if ((u - first).norm() < (u - second).norm()) of_first += mass;
    }
  EXPECT_NEAR(study.posterior.log_evidence(), top + std::log(all * cell), 0.05);
  EXPECT_NEAR(study.posterior.share[0], of_first / all, 0.02);
  // Both sets, each within four of its deviations.
  for (const auto& [k1, k2] : {std::pair{1.0e5, 8.0e4}, {1.6e5, 5.0e4}}) {
    double nearest = 1e9;
    for (std::size_t h = 0; h < 2; ++h)
      nearest = std::min(
          nearest,
          std::max(std::abs(study.parameters[0].humps[h].mean - k1) / study.parameters[0].laplace[h],
                   std::abs(study.parameters[1].humps[h].mean - k2) / study.parameters[1].laplace[h]));
    EXPECT_LT(nearest, 4.0) << k1;
  }
}

TEST(RecordPosterior, HasTheSlopesOfItsLikelihood) {
  // Oracle: central differences of ln L itself.
  const Experiment experiment = experiment_of(building(asked));
  const SensingRecord record = simulated_sensing(experiment, folder, {}, unwatched);
  const SensingModel model(experiment, record, sensing_reduction(experiment, record.record.interval()),
                           folder);
  const RecordLikelihood likelihood(model, experiment);
  const VectorXd u{{0.03, -0.02}};
  const LikelihoodValue value = likelihood.at(u, true);
  for (Index j = 0; j < 2; ++j) {
    const VectorXd step = 1e-5 * VectorXd::Unit(2, j);
    const double slope = (likelihood.at(u + step, false).log - likelihood.at(u - step, false).log) / 2e-5;
    EXPECT_NEAR(value.gradient[j], slope, 1e-3 * std::abs(slope));
  }
}

// A likelihood of a record that was simulated with other stiffnesses than those guessed.
struct GuessedCase {
  Experiment experiment;
  SensingRecord record;
  SensingModel model;
  RecordLikelihood likelihood;
  GuessedCase(const Experiment& truth, const std::vector<double>& guesses)
      : experiment(with_guesses(truth, guesses)),
        record(simulated_sensing(truth, folder, {}, unwatched)),
        model(experiment, record, sensing_reduction(experiment, record.record.interval()), folder),
        likelihood(model, experiment) {}
  static Experiment with_guesses(Experiment experiment, const std::vector<double>& guesses) {
    for (std::size_t j = 0; j < guesses.size(); ++j) experiment.parameters.at(j).guess = guesses[j];
    return experiment;
  }
};

std::string quiet_building() {
  std::string text = building(asked);
  text.replace(text.find("noise_m_per_s2 = 1"), 18, "noise_m_per_s2 = 0.02");
  return text;
}

TEST(RecordPosterior, GivesASetAndItsTwinTheSameLikelihoodWhateverTheGuess) {
  // Oracle: the twin's answer of the roof is the same (above), so that its likelihood is, but for the prior
  // of the start. With the modes of the guess for both, the guess has all of the probability.
  for (const std::vector<double>& guess : {std::vector<double>{1.0e5, 8.0e4}, {1.6e5, 5.0e4}}) {
    const GuessedCase found(experiment_of(quiet_building()), guess);
    const double truth = found.likelihood.at(*found.likelihood.place(VectorXd{{1.0e5, 8.0e4}}), false).log,
                 twin = found.likelihood.at(*found.likelihood.place(VectorXd{{1.6e5, 5.0e4}}), false).log;
    EXPECT_NEAR(truth, twin, 1.0) << guess[0];
  }
}

TEST(RecordPosterior, HasItsTopAtTheTruthWhereTheGuessIsAFifthOff) {
  // Oracle: the slope of the likelihood of a right model has the information as covariance, so that
  // g^T I^-1 g is chi^2 of two degrees of freedom: above 18 once in 8,000 times.
  const GuessedCase found(experiment_of(quiet_building()), {1.2e5, 6.4e4});
  const LikelihoodValue value = found.likelihood.at(*found.likelihood.place(VectorXd{{1.0e5, 8.0e4}}), true);
  EXPECT_LT(value.gradient.dot(value.information.ldlt().solve(value.gradient)), 18.0);
}

TEST(RecordPosterior, TakesThePriorOfEveryParameterByItself) {
  // Oracle: the file states a deviation of the first storey and none of the second.
  std::string text = building(asked);
  text.erase(text.rfind("relative_deviation = 0.5"), 24);
  const GuessedCase found(experiment_of(text), {});
  EXPECT_FALSE(found.likelihood.priors()[0].assumed());
  EXPECT_TRUE(found.likelihood.priors()[1].assumed());
}

TEST(RecordPosterior, DoesNotStandWhereTheRecordContradictsTheStructure) {
  // The sensor of the roof is said to be on the first floor, whose answer has a zero between both modes; its
  // noise is small enough to see that.
  std::string text = building(asked);
  text.replace(text.find("noise_m_per_s2 = 1"), 18, "noise_m_per_s2 = 0.1");
  text.replace(text.find("duration_s = 4"), 14, "duration_s = 2");
  const Experiment experiment = experiment_of(text);
  SensingRecord record = simulated_sensing(experiment, folder, {}, unwatched);
  record.record.channels[0].position = 3.0;
  const PosteriorStudy study = study_posterior(experiment, record, few_draws(), folder, {});
  EXPECT_FALSE(study.explains());
  EXPECT_TRUE(study.contradicted());
}

TEST(RecordPosterior, AsksForParameters) {
  const Experiment experiment = experiment_of(building());
  EXPECT_THROW(study_of(experiment), InputError);
}

}  // namespace
}  // namespace beamid::experiments::record_posterior_test
