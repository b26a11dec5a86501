#include "experiments/studies/paper/start_sample.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <functional>
#include <limits>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/studies/paper/errors.hpp"
#include "fem/free_decay.hpp"

namespace beamid::experiments::paper {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

// Displacement and velocity of the tip in the first modes alone.
filters::Measurements motion_of(const BeamCase& beam, Eigen::Index modes) {
  const Release rig = release_of(beam.test);
  Eigen::VectorXd ratios = Eigen::VectorXd::Constant(modes, rig.higher_damping_ratio);
  ratios[0] = rig.first_damping_ratio;
  const fem::Motion tip =
      fem::free_decay(beam.released.modal_amplitudes.head(modes),
                      beam.released.modes.angular_frequency.head(modes), ratios, beam.released.time);
  filters::Measurements motion{beam.released.time, Eigen::MatrixXd(2, beam.released.time.size()), {}};
  motion.outputs << tip.displacement.transpose(), tip.velocity.transpose();
  return motion;
}

void examine_starts(const BeamCase& beam, std::vector<StartCase>& cases) {
  tbb::parallel_for(std::size_t{0}, cases.size(), [&](std::size_t i) {
    StartCase& one = cases[i];
    const filters::Measurements whole = one.modes > 0 ? motion_of(beam, one.modes) : true_motion(beam);
    const Eigen::Index count = whole.time.size() - one.sample;
    const filters::Measurements motion{whole.time.tail(count), whole.outputs.rightCols(count), {}};
    BeamSettings settings = wide_settings(beam);
    settings.first_stiffness = one.guess_over_truth * beam.reference.stiffness;
    const auto examine = [&](const char* scheme, double& error, bool& is_lost) {
      const Identification found = identify(beam, motion, settings, "ekf", scheme);
      is_lost = lost(found, beam.reference.frequency_hz());
      error = damping_error(found.found, beam.reference);
    };
    examine("exponential", one.exact_error_percent, one.exact_lost);
    examine("forward_euler", one.euler_error_percent, one.euler_lost);
  });
}

// What was varied, and the four columns of every table.
Table& errors_of(Table& table, const std::vector<StartCase>& cases,
                 const std::function<double(const StartCase&)>& varied) {
  table.column({"exact", "exponential_status"})
      .column({"exact, C [%]", "exponential_damping_error_percent", "{:+.2f}"})
      .column({"forward Euler", "forward_euler_status"})
      .column({"forward Euler, C [%]", "forward_euler_damping_error_percent", "{:+.2f}"});
  for (const StartCase& one : cases)
    table.row({varied(one), one.exact_lost ? "lost" : "keeps it",
               one.exact_lost ? no_value : one.exact_error_percent, one.euler_lost ? "lost" : "keeps it",
               one.euler_lost ? no_value : one.euler_error_percent});
  return table;
}

// Error of C against the start; runs that lost the motion stand by themselves at the bottom.
void draw_errors(Panel& panel, const char* label, const std::vector<StartCase>& cases, bool exact,
                 Colour colour) {
  constexpr double bottom = -150.0;
  Eigen::VectorXd x(static_cast<Eigen::Index>(cases.size())), y(x.size()), gone(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const StartCase& one = cases[static_cast<std::size_t>(i)];
    const bool is_lost = exact ? one.exact_lost : one.euler_lost;
    x[i] = static_cast<double>(one.sample);
    y[i] = is_lost ? no_value : exact ? one.exact_error_percent : one.euler_error_percent;
    gone[i] = is_lost ? bottom - (exact ? 0.0 : 25.0) : no_value;
  }
  panel.points(label, x, y, colour).open_points(std::string(label) + ", lost the motion", x, gone, colour);
}

}  // namespace

StartOutcome vary_start(const BeamCase& beam) {
  constexpr Eigen::Index last = 500, between = 10;
  StartOutcome outcome;
  outcome.beam = beam.test.name;
  const double dt = beam.released.time[1] - beam.released.time[0];
  outcome.euler_prediction_percent =
      damping_error(seen_through("forward_euler", beam.reference, dt), beam.reference);
  for (const Eigen::Index sample : {0, 7, 15, 30, 60, 120, 200, 500}) outcome.starts.push_back({sample});
  for (const double guess : {0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2}) outcome.guesses.push_back({0, guess});
  for (Eigen::Index modes = 1; modes <= 8; ++modes) outcome.counts.push_back({0, 0.8, modes});
  for (Eigen::Index sample = 0; sample <= last; sample += between) outcome.curve.push_back({sample});
  examine_starts(beam, outcome.starts);
  examine_starts(beam, outcome.guesses);
  examine_starts(beam, outcome.counts);
  examine_starts(beam, outcome.curve);
  return outcome;
}

Table start_table(const StartOutcome& outcome) {
  Table table{"start_sample", fmt::format("The 2009 settings on {}: where the record starts", outcome.beam)};
  table.column({"first sample", "first_sample", "{:.0f}"});
  errors_of(table, outcome.starts, [](const StartCase& one) { return static_cast<double>(one.sample); })
      .note =
      "R = 1e-5 I, P0 of K and C 1e5, K0 = 0.8 K; true displacement and velocity of the tip, eight modes, no "
      "noise, no processing. Lost: no damping left, or K more than 5 % from the first mode's.";
  return table;
}

Table guess_table(const StartOutcome& outcome) {
  Table table{"initial_estimate",
              fmt::format("The same from the release on: where the estimate of K starts ({})", outcome.beam)};
  table.column({"K0 / K", "initial_stiffness_ratio", "{:.1f}"});
  errors_of(table, outcome.guesses, [](const StartCase& one) { return one.guess_over_truth; }).note =
      fmt::format("The closed form of forward Euler is {:+.1f} % of C.", outcome.euler_prediction_percent);
  return table;
}

Table mode_count_table(const StartOutcome& outcome) {
  Table table{"number_of_modes",
              fmt::format("The same: how many modes the simulated motion has ({})", outcome.beam)};
  table.column({"modes", "modes", "{:.0f}"});
  errors_of(table, outcome.counts, [](const StartCase& one) { return static_cast<double>(one.modes); }).note =
      "One mode: nothing is left unmodelled. Every further one draws another lot.";
  return table;
}

Figure start_figure(const StartOutcome& outcome) {
  Panel panel{"", {"first sample of the record, 1 ms each, after the release"}, {"error of C [%]"}};
  draw_errors(panel, "EKF, exact", outcome.curve, true, Colour::blue);
  draw_errors(panel, "EKF, forward Euler", outcome.curve, false, Colour::vermillion);
  panel.across(0.0, 500.0)
      .up(-200.0, 800.0)
      .level("closed form, forward Euler", outcome.euler_prediction_percent, Colour::vermillion)
      .level("no error", 0.0);
  Figure figure{"error_by_start", {panel}};
  figure.caption = fmt::format(
      "{} with the settings of 2009: error of C against the sample at which the record starts. Runs that "
      "lost the motion stand at the bottom; what lies above the frame is not drawn.",
      outcome.beam);
  return figure;
}

}  // namespace beamid::experiments::paper
