#include "experiments/studies/paper/covariances.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/one_coordinate.hpp"
#include "experiments/studies/paper/errors.hpp"
#include "experiments/studies/paper/numerical_validation.hpp"
#include "experiments/studies/paper/test_beams.hpp"
#include "filters/scheme.hpp"

namespace beamid::experiments::paper {
namespace {

constexpr const char* displacement_noise = "R of x [m2]";
constexpr const char* velocity_noise = "R of v [m2/s2]";
constexpr const char* process_noise = "Q of x and v, per step";
constexpr const char* parameter_variance = "P0 of K and C";

const std::vector<CovarianceCase>& varied_covariances() {
  static const std::vector<CovarianceCase> cases{
      {displacement_noise, 1e-7}, {displacement_noise, 1e-5}, {displacement_noise, 1e-3},
      {velocity_noise, 1e-7},     {velocity_noise, 1e-3},     {process_noise, 1e-12},
      {process_noise, 1e-10},     {process_noise, 1e-8},      {process_noise, 1e-6},
      {parameter_variance, 1e3},  {parameter_variance, 1e4},  {parameter_variance, 1e5},
      {parameter_variance, 1e8}};
  return cases;
}

std::vector<CovarianceCase> process_noise_curve() {
  std::vector<CovarianceCase> cases;
  for (int half_decade = -26; half_decade <= -12; ++half_decade)
    cases.push_back({process_noise, std::pow(10.0, 0.5 * half_decade)});
  return cases;
}

ValidationSettings settings_of(const CovarianceCase& one) {
  ValidationSettings settings;
  settings.release = release_of(test_beams[0]).tip_deflection;
  if (one.varied == displacement_noise) {
    settings.velocity_variance = settings.noise_variance;
    settings.noise_variance = one.value;
  }
  if (one.varied == velocity_noise) settings.velocity_variance = one.value;
  if (one.varied == process_noise) settings.process_variance = one.value;
  if (one.varied == parameter_variance) settings.initial_variance.tail<2>().setConstant(one.value);
  return settings;
}

void examine_covariances(std::vector<CovarianceCase>& cases) {
  tbb::parallel_for(std::size_t{0}, cases.size(), [&](std::size_t i) {
    const ValidationSettings settings = settings_of(cases[i]);
    const Identification found = validate("ekf", "forward_euler", settings);
    cases[i].stiffness_error_percent = stiffness_error(found.found, settings.truth);
    cases[i].damping_error_percent = damping_error(found.found, settings.truth);
  });
}

}  // namespace

Oscillator seen_step_by_step(const Oscillator& truth, double interval) {
  const auto model =
      model_registry().make("sdof", {}, at_one_point(one_coordinate(truth), {Quantity::displacement}));
  Eigen::VectorXd next;
  Eigen::MatrixXd tangent;  // Phi in its upper left corner
  filters::scheme_registry()
      .make("exponential", {})
      ->step(*model->motion, Eigen::Vector4d(0.0, 0.0, truth.stiffness, truth.damping), {}, interval, next,
             &tangent);
  return {truth.mass, -tangent(1, 0) * truth.mass / interval, (1.0 - tangent(1, 1)) * truth.mass / interval};
}

CovarianceOutcome vary_covariances() {
  CovarianceOutcome outcome;
  outcome.truth = validation_truth();
  outcome.whole = seen_through("forward_euler", outcome.truth, validation_interval);
  outcome.step_by_step = seen_step_by_step(outcome.truth, validation_interval);
  outcome.cases = varied_covariances();
  examine_covariances(outcome.cases);
  outcome.curve = process_noise_curve();
  examine_covariances(outcome.curve);
  return outcome;
}

Table covariance_table(const CovarianceOutcome& outcome) {
  Table table{"covariances", "Forward Euler's bias against the filter's covariances"};
  table.column({"varied", "varied"})
      .column({"value", "value", "{:.0e}"})
      .column({"error K [%]", "stiffness_error_percent", "{:+.4f}"})
      .column({"error C [%]", "damping_error_percent", "{:+.3f}"});
  for (const CovarianceCase& one : outcome.cases)
    table.row({one.varied, one.value, one.stiffness_error_percent, one.damping_error_percent});
  table.note = fmt::format(
      "The filter of table 2 after a release of 12 mm (R = 1e-5, Q = 0, P0 of K and C 1e5 but for what is "
      "varied). Closed forms: fitted to the whole history {:+.3f} %, to single steps {:+.3f} % of C.",
      damping_error(outcome.whole, outcome.truth), damping_error(outcome.step_by_step, outcome.truth));
  return table;
}

Figure covariance_figure(const CovarianceOutcome& outcome) {
  Eigen::VectorXd q(static_cast<Eigen::Index>(outcome.curve.size())), error(q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = outcome.curve[static_cast<std::size_t>(i)].value;
    error[i] = outcome.curve[static_cast<std::size_t>(i)].damping_error_percent;
  }
  Panel panel{"", {"process noise Q of x and v, per step", true}, {"error of C [%]"}};
  panel.across(q[0], q[q.size() - 1])
      .up(0.0, 8.0)
      .line("EKF, forward Euler, R = 10^{-5}", q, error, Colour::blue)
      .points("", q, error, Colour::blue)
      .level("closed form, whole history: K Δt", damping_error(outcome.whole, outcome.truth),
             Colour::vermillion)
      .level("closed form, step by step: K Δt / 2", damping_error(outcome.step_by_step, outcome.truth),
             Colour::green);
  Figure figure{"bias_by_process_noise", {panel}};
  figure.caption = "Forward Euler's error of C on the paper's oscillator against the process noise.";
  return figure;
}

}  // namespace beamid::experiments::paper
