#include "experiments/studies/paper/numerical_validation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/signal/toolbox.hpp"
#include "experiments/studies/paper/monte_carlo.hpp"
#include "experiments/studies/paper/report.hpp"
#include "fem/free_decay.hpp"
#include "fem/response/response.hpp"
#include "filters/scheme.hpp"

namespace beamid::experiments::paper {
namespace {

constexpr int most_left_out = 16;  // the longest step keeps every 16th sample

filters::Measurements every_nth(const filters::Measurements& motion, Eigen::Index n) {
  const Eigen::Index count = (motion.time.size() - 1) / n + 1;
  const auto kept = Eigen::seqN(0, count, n);
  return {motion.time(kept), motion.outputs(Eigen::all, kept), {}};
}

// Value at 0 of the polynomial through the points, by Neville's scheme.
double extrapolated_to_zero(const std::vector<StepCase>& steps) {
  std::vector<double> value;
  for (const StepCase& step : steps) value.push_back(step.euler_ratio);
  for (std::size_t order = 1; order < steps.size(); ++order)
    for (std::size_t i = 0; i + order < steps.size(); ++i) {
      const double near = steps[i].interval, far = steps[i + order].interval;
      value[i] = (far * value[i] - near * value[i + 1]) / (far - near);
    }
  return value[0];
}

// Over the outputs.
double mean_square(const Identification& found) {
  return found.run.normalised_squares.mean() / static_cast<double>(found.run.innovations.rows());
}

}  // namespace

StepOutcome vary_step(const BeamCase& beam, const filters::Measurements& motion,
                      const BeamSettings& settings) {
  StepOutcome outcome;
  outcome.beam = beam.test.name;
  for (int n = 1; n <= most_left_out; n *= 2) {
    const filters::Measurements record = every_nth(motion, n);
    const Identification exact = identify(beam, record, settings, "ekf", "exponential"),
                         euler = identify(beam, record, settings, "ekf", "forward_euler");
    const double dt = record.interval();
    outcome.steps.push_back({dt, exact.found.damping_ratio(), euler.found.damping_ratio(),
                             seen_through("forward_euler", exact.found, dt).damping_ratio(),
                             mean_square(exact), mean_square(euler)});
  }
  outcome.extrapolated_ratio = extrapolated_to_zero(outcome.steps);
  Oscillator reference = beam.reference;
  reference.damping *= outcome.steps[0].exact_ratio / reference.damping_ratio();
  constexpr int points = 50;
  for (int i = 0; i <= points; ++i) {
    const double dt = std::max(1e-6, 1.05 * outcome.steps.back().interval * i / points);
    outcome.curve.push_back({dt, 0.0, 0.0, seen_through("forward_euler", reference, dt).damping_ratio()});
  }
  return outcome;
}

Table step_table(const StepOutcome& outcome) {
  Table table{"step_size", fmt::format("One record at longer and longer steps ({})", outcome.beam)};
  table.column({"dt [ms]", "interval_ms", "{:g}"})
      .column({"xi, exact [%]", "exponential_damping_ratio_percent", "{:.4f}"})
      .column({"xi, forward Euler [%]", "forward_euler_damping_ratio_percent", "{:.4f}"})
      .column({"predicted [%]", "predicted_damping_ratio_percent", "{:.4f}"})
      .column({"NIS, exact", "exponential_mean_nis", "{:.4f}"})
      .column({"NIS, forward Euler", "forward_euler_mean_nis", "{:.4f}"});
  for (const StepCase& one : outcome.steps)
    table.row({1e3 * one.interval, 100.0 * one.exact_ratio, 100.0 * one.euler_ratio,
               100.0 * one.predicted_ratio, one.exact_square, one.euler_square});
  table.note = fmt::format(
      "Every sample, every second, fourth, ... of the processed record of table 3, with its settings. "
      "Predicted: the closed form from what the exact scheme found at the same step. Forward Euler "
      "extrapolated to dt = 0: {:.4f} %.",
      100.0 * outcome.extrapolated_ratio);
  return table;
}

Figure step_figure(const StepOutcome& outcome) {
  const auto column = [](const std::vector<StepCase>& steps, auto value) {
    Eigen::VectorXd numbers(static_cast<Eigen::Index>(steps.size()));
    for (Eigen::Index i = 0; i < numbers.size(); ++i) numbers[i] = value(steps[static_cast<std::size_t>(i)]);
    return numbers;
  };
  const auto dt = [](const StepCase& one) { return 1e3 * one.interval; };
  const Eigen::VectorXd x = column(outcome.steps, dt);
  Panel panel{"", {"time step [ms]"}, {"damping ratio found [%]"}};
  panel.across(0.0, 1.05 * x[x.size() - 1])
      .up(0.0, 20.0)
      .line("closed form, forward Euler", column(outcome.curve, dt),
            column(outcome.curve, [](const StepCase& one) { return 100.0 * one.predicted_ratio; }),
            Colour::black)
      .points("EKF, forward Euler", x,
              column(outcome.steps, [](const StepCase& one) { return 100.0 * one.euler_ratio; }),
              Colour::vermillion)
      .points("EKF, exact", x,
              column(outcome.steps, [](const StepCase& one) { return 100.0 * one.exact_ratio; }),
              Colour::blue);
  Figure figure{"step_experiment", {panel}};
  figure.caption = fmt::format(
      "One record of {} at longer and longer steps: the damping ratio that each scheme finds.", outcome.beam);
  return figure;
}

namespace {

struct ObservedChoice {
  const char* name;
  std::vector<Quantity> quantities;
};

const std::vector<ObservedChoice>& observed_choices() {
  static const std::vector<ObservedChoice> choices{{"x and v", {Quantity::displacement, Quantity::velocity}},
                                                   {"x", {Quantity::displacement}},
                                                   {"v", {Quantity::velocity}}};
  return choices;
}

double hundredths(double percent_value) {
  return std::round(100.0 * std::abs(percent_value));
}

}  // namespace

bool DigitCase::prints_the_published_digits() const {
  return hundredths(stiffness_error_percent) == hundredths(published_stiffness_error_percent) &&
         hundredths(damping_error_percent) == hundredths(published_damping_error_percent);
}

std::vector<DigitCase> examine_digits() {
  std::vector<DigitCase> cases;
  for (const ObservedChoice& observed : observed_choices())
    for (const std::string& data : data_generators())
      for (const std::string& scheme : compared_schemes()) cases.push_back({data, scheme, observed.name});
  const std::size_t per_choice = cases.size() / observed_choices().size();
  tbb::parallel_for(std::size_t{0}, cases.size(), [&](std::size_t i) {
    ValidationSettings settings;
    settings.release = release_of(test_beams[0]).tip_deflection;
    settings.data = cases[i].data;
    settings.observed = observed_choices()[i / per_choice].quantities;
    const Identification found = validate("ekf", cases[i].scheme, settings);
    cases[i].stiffness_error_percent = stiffness_error(found.found, settings.truth);
    cases[i].damping_error_percent = damping_error(found.found, settings.truth);
  });
  return cases;
}

Table digit_matrix(const std::vector<DigitCase>& cases) {
  Table table{"generator_and_filter",
              "Error of C by what made the data, what the filter is and what it reads [%]"};
  table.column({"observed", "observed"}).column({"data", "data"});
  for (const std::string& scheme : compared_schemes())
    table.column({scheme + " [%]", scheme + "_damping_error_percent", "{:+.4f}"});
  std::vector<Cell> row;
  for (const DigitCase& one : cases) {
    if (row.empty()) row = {one.observed, one.data};
    row.emplace_back(one.damping_error_percent);
    if (row.size() < table.columns.size()) continue;
    table.row(row);
    row.clear();
  }
  table.note =
      "The oscillator of table 2, released from 12 mm; rows: what made the data, columns: the filter's own "
      "discretisation. Average acceleration moves a linear system as the implicit midpoint rule does.";
  return table;
}

Table digit_matches(const std::vector<DigitCase>& cases) {
  Table table{"published_digits", "The combinations that print the published 0.13 and 6.41 %"};
  table.column({"data", "data"})
      .column({"filter", "filter"})
      .column({"observed", "observed"})
      .column({"error K [%]", "stiffness_error_percent", "{:+.4f}"})
      .column({"error C [%]", "damping_error_percent", "{:+.4f}"});
  for (const DigitCase& one : cases)
    if (one.prints_the_published_digits())
      table.row({one.data, one.scheme, one.observed, one.stiffness_error_percent, one.damping_error_percent});
  table.note = fmt::format("{} of {} combinations. The article prints magnitudes, so signs do not decide.",
                           table.rows(), cases.size());
  return table;
}

Figure digit_figure(const std::vector<DigitCase>& cases) {
  const auto& generators = data_generators();
  Panel panel{"", {"error of C [%]"}, {""}};
  panel.y_axis.names = generators;
  for (const std::string& scheme : compared_schemes()) {
    Eigen::VectorXd error(static_cast<Eigen::Index>(generators.size())), place(error.size());
    Eigen::Index i = 0;
    for (const DigitCase& one : cases)
      if (one.scheme == scheme && one.observed == observed_choices()[0].name) {
        error[i] = one.damping_error_percent;
        place[i] = static_cast<double>(i + 1);
        ++i;
      }
    panel.points(scheme, error, place);
  }
  panel.across(-15.0, 15.0)
      .up(0.5, static_cast<double>(generators.size()) + 0.5)
      .upright("published, with its sign as forward Euler has it", published_damping_error_percent);
  Figure figure{"generator_matrix", {panel}, 1, 1, 900};
  figure.caption =
      "Error of C on the paper's oscillator, displacement and velocity observed: rows, what made the data; "
      "colours, the filter.";
  return figure;
}

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd exact_decay(const Oscillator& truth, double release, const VectorXd& time) {
  const auto one = [](double value) { return VectorXd::Constant(1, value); };
  const fem::Motion motion =
      fem::free_decay(one(release), one(truth.angular_frequency()), one(truth.damping_ratio()), time);
  MatrixXd history(2, time.size());
  history << motion.displacement.transpose(), motion.velocity.transpose();
  return history;
}

MatrixXd newmark_decay(double beta, const Oscillator& truth, double release, double interval, Index samples) {
  const fem::Response response =
      fem::respond(one_coordinate(truth), fem::Undamped{}, {VectorXd::Constant(1, release), {}, {}},
                   {interval, samples + 1}, {"newmark", {{"beta", beta}}});
  MatrixXd history(2, samples);
  history << response.displacement.rightCols(samples), response.velocity.rightCols(samples);
  return history;
}

MatrixXd stepped_decay(const std::string& scheme, const Oscillator& truth, double release, double interval,
                       Index samples) {
  const auto model =
      model_registry().make("sdof", {}, at_one_point(one_coordinate(truth), {Quantity::displacement}));
  const auto method = filters::scheme_registry().make(scheme, {});
  MatrixXd history(2, samples);
  VectorXd state = Eigen::Vector4d(release, 0.0, truth.stiffness, truth.damping), next;
  for (Index k = 0; k < samples; ++k) {
    method->step(*model->motion, state, {}, interval, next, nullptr);
    history.col(k) = next.head<2>();
    state.swap(next);
  }
  return history;
}

}  // namespace

const std::vector<std::string>& data_generators() {
  static const std::vector<std::string> generators{
      "exact",         "average_acceleration", "linear_acceleration", "central_difference",
      "forward_euler", "backward_euler",       "runge_kutta_2",       "runge_kutta_4"};
  return generators;
}

MatrixXd generate_decay(const std::string& generator, const Oscillator& truth, double release,
                        double interval, Index samples) {
  static const std::map<std::string, double> beta{
      {"average_acceleration", 0.25}, {"linear_acceleration", 1.0 / 6.0}, {"central_difference", 0.0}};
  if (generator == "exact")
    return exact_decay(truth, release,
                       VectorXd::LinSpaced(samples, 1.0, static_cast<double>(samples)) * interval);
  const auto newmark = beta.find(generator);
  return newmark != beta.end() ? newmark_decay(newmark->second, truth, release, interval, samples)
                               : stepped_decay(generator, truth, release, interval, samples);
}

namespace {

// The first sample is one interval after the release.
filters::Measurements simulate_oscillator(const ValidationSettings& settings) {
  const auto samples = static_cast<Eigen::Index>(std::lround(settings.duration / settings.interval));
  filters::Measurements record;
  record.time = Eigen::VectorXd::LinSpaced(samples, 1.0, static_cast<double>(samples)) * settings.interval;
  const Eigen::MatrixXd motion =
      generate_decay(settings.data, settings.truth, settings.release, settings.interval, samples);
  record.outputs.resize(static_cast<Eigen::Index>(settings.observed.size()), samples);
  for (Eigen::Index i = 0; i < record.outputs.rows(); ++i) {
    const Eigen::Index row = settings.observed[i] == Quantity::displacement ? 0 : 1;
    record.outputs.row(i) = motion.row(row);
    if (settings.sensor_noise[row] > 0.0)
      record.outputs.row(i) +=
          settings.sensor_noise[row] *
          standard_normal(samples, settings.seed, static_cast<std::uint64_t>(row)).transpose();
  }
  return record;
}

// R, by what is observed
Eigen::MatrixXd output_noise_of(const ValidationSettings& settings) {
  Eigen::VectorXd variance(static_cast<Eigen::Index>(settings.observed.size()));
  for (Eigen::Index i = 0; i < variance.size(); ++i)
    variance[i] = settings.observed[i] == Quantity::velocity && settings.velocity_variance > 0.0
                      ? settings.velocity_variance
                      : settings.noise_variance;
  return variance.asDiagonal();
}

}  // namespace

Oscillator validation_truth() {
  return Oscillator::from_frequency(3.0, std::sqrt(515.8 / 3.0), 0.10);
}

const std::vector<std::string>& compared_schemes() {
  static const std::vector<std::string> schemes{"forward_euler", "backward_euler", "implicit_midpoint",
                                                "runge_kutta_2", "runge_kutta_4",  "exponential"};
  return schemes;
}

ValidationSettings bias_settings() {
  ValidationSettings settings;
  settings.observed = {Quantity::displacement};
  settings.noise_variance = 1e-12;
  settings.passes = 2;
  return settings;
}

Identification validate(const std::string& filter, const std::string& scheme,
                        const ValidationSettings& settings, filters::Keep keep) {
  const auto model =
      model_registry().make("sdof", {}, at_one_point(one_coordinate(settings.truth), settings.observed));
  IdentificationSettings identification;
  identification.filter = filter;
  identification.discretisation = scheme;
  identification.initial.mean =
      Eigen::Vector4d(settings.release, 0.0, settings.first_stiffness, settings.first_damping);
  identification.initial.covariance = settings.initial_variance.asDiagonal();
  identification.output_noise = output_noise_of(settings);
  if (settings.process_variance > 0.0)
    identification.process_noise =
        Eigen::Vector4d(settings.process_variance, settings.process_variance, 0.0, 0.0).asDiagonal();
  identification.start = filters::Start::one_interval_before;
  identification.passes = settings.passes;
  return identify(*model, simulate_oscillator(settings), identification, keep);
}

}  // namespace beamid::experiments::paper
