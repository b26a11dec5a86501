#include "experiments/studies/paper/step_size.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/models/discretisation_bias.hpp"

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

}  // namespace beamid::experiments::paper
