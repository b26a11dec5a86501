#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/results/figure.hpp"
#include "experiments/results/vtk/mode_shapes.hpp"
#include "experiments/studies/paper/report.hpp"
#include "fem/assembly.hpp"

namespace beamid::experiments::paper {
namespace {

using Eigen::Index, Eigen::VectorXd;

struct DrawnGuess {
  double stiffness, damping;
};
constexpr DrawnGuess first_guesses[] = {{300, 2}, {300, 20}, {700, 2}, {700, 20}};

// How one parameter (state `index`) converges from four first guesses, seen by one scheme.
Panel convergence(const Outcome& outcome, const char* scheme, const char* title, Index index) {
  constexpr double shown = 0.5;  // [s]
  const bool stiffness = index == 2;
  Panel panel{title, {"time [s]"}, {stiffness ? "stiffness K [N/m]" : "damping C [N s/m]"}};
  panel.x_axis.range = {0.0, shown};
  panel.y_axis.range = stiffness ? std::pair{250.0, 750.0} : std::pair{2.0, 14.0};
  for (const auto& [first_stiffness, first_damping] : first_guesses) {
    ValidationSettings settings;
    settings.release = 0.012;  // as the beams: the weaker signal lets the convergence be seen
    settings.duration = shown;
    settings.first_stiffness = first_stiffness;
    settings.first_damping = first_damping;
    const Identification result = validate("ekf", scheme, settings, filters::Keep::all_estimates);
    const auto count = static_cast<Index>(result.run.filtered.size());
    VectorXd time(count + 1), value(count + 1);
    time[0] = 0.0;
    value[0] = stiffness ? first_stiffness : first_damping;
    for (Index k = 0; k < count; ++k) {
      time[k + 1] = static_cast<double>(k + 1) * validation_interval;
      value[k + 1] = result.run.filtered[k].mean[index];
    }
    panel.curves.push_back({fmt::format("from {:g} N/m and {:g} N s/m", first_stiffness, first_damping), time,
                            value, first_damping > 10.0 ? CurveStyle::dashed : CurveStyle::line});
  }
  const double truth = stiffness ? outcome.truth.stiffness : outcome.truth.damping;
  return panel.level("true value", truth);
}

// The whole at the left, its beginning at the right.
Figure convergence_figure(const Outcome& outcome, const char* name, Index index) {
  constexpr double beginning = 0.05;  // [s]
  Figure figure{name, {}, 2, 2, 1100};
  for (const auto& [scheme, title] :
       {std::pair{"forward_euler", "Forward Euler"}, {"exponential", "Exact discretisation"}}) {
    Panel panel = convergence(outcome, scheme, title, index);
    figure.panels.push_back(panel);
    panel.title += ", its beginning";
    figure.panels.push_back(panel.across(0.0, beginning));
  }
  figure.caption = fmt::format("{} from four initial estimates, with both discretisations.",
                               index == 2 ? "Stiffness" : "Damping");
  return figure;
}

// Displacement that an identified oscillator makes from the record's first displacement and velocity [mm].
VectorXd reproduce_paper(const Oscillator& found, const filters::Measurements& motion) {
  const std::complex<double> lambda = found.eigenvalue();
  const double x = motion.outputs(0, 0), v = motion.outputs(1, 0);
  const std::complex<double> amplitude(x, (x * lambda.real() - v) / lambda.imag());
  VectorXd displacement(motion.time.size());
  for (Index k = 0; k < displacement.size(); ++k)
    displacement[k] = 1e3 * (amplitude * std::exp(lambda * (motion.time[k] - motion.time[0]))).real();
  return displacement;
}

Figure reproduction_figure(const BeamOutcome& o, const char* name) {
  const VectorXd& time = o.motion.time;
  const VectorXd measured = 1e3 * o.motion.outputs.row(0).transpose();
  const double begin = time[0], four_cycles = begin + 4.0 / o.beam.exact_frequency_hz;
  Figure figure{name, {}, 2, 1};
  for (const bool whole : {false, true}) {
    figure.panels.push_back(
        reproduction_panel(
            std::string(o.beam.test.name) + (whole ? ", the whole record" : ", first four cycles"), time,
            measured,
            {{"reproduced, EKF with forward Euler", reproduce_paper(o.identified[0].found, o.motion),
              Colour::vermillion},
             {"reproduced, EKF with exact discretisation", reproduce_paper(o.identified[1].found, o.motion),
              Colour::sky}},
            "tip displacement [mm]")
            .across(begin, whole ? time[time.size() - 1] : four_cycles));
  }
  figure.caption =
      fmt::format("{}: measured displacement and what both identifications reproduce.", o.beam.test.name);
  return figure;
}

Figure damping_law_figure(const Outcome& outcome) {
  const auto beams = static_cast<Index>(outcome.beams.size());
  VectorXd product(beams);
  std::array<VectorXd, 4> errors;
  errors.fill(VectorXd(beams));
  for (Index b = 0; b < beams; ++b) {
    const BeamOutcome& o = outcome.beams[b];
    product[b] = o.beam.reference.damping_ratio() * std::sqrt(o.beam.reference.mass);
    for (std::size_t i = 0; i < variants.size(); ++i)
      errors[i][b] = std::abs(damping_error(o.identified[i].found, o.beam.reference));
  }
  // The law to first order, 100 sqrt(K) dt / (2 xi sqrt(Meq)), for the beams' common static stiffness.
  const double stiffness = steel_beam(test_beams[0]).tip_stiffness(),
               dt = 1.0 / release_of(test_beams[0]).sampling_rate;
  const VectorXd x = VectorXd::LinSpaced(100, std::log(1e-3), std::log(1e-2)).array().exp();
  const VectorXd law = 50.0 * std::sqrt(stiffness) * dt * x.cwiseInverse();
  Panel panel{"", {"ξ √M_{eq} [kg^{1/2}]", true}, {"|error of C| [%]", true}};
  panel.across(1e-3, 1e-2)
      .line("law: √K Δt / (2 ξ √M_{eq})", x, law, Colour::black)
      .points("EKF, forward Euler", product, errors[0], Colour::vermillion)
      .open_points("UKF, forward Euler", product, errors[2], Colour::orange)
      .points("EKF, exact", product, errors[1], Colour::blue)
      .open_points("UKF, exact", product, errors[3], Colour::sky);
  Figure figure{"damping_law", {panel}};
  figure.caption = "Error of C against ξ √Meq: the law as a line, filters as points.";
  return figure;
}

}  // namespace

std::vector<Figure> figures(const Outcome& outcome) {
  return {convergence_figure(outcome, "figure_2", 2),
          convergence_figure(outcome, "figure_3", 3),
          reproduction_figure(outcome.beams[1], "figure_5"),
          reproduction_figure(outcome.beams[4], "figure_6"),
          damping_law_figure(outcome),
          step_figure(outcome.step),
          digit_figure(outcome.digits),
          prediction_figure(outcome.predictions),
          covariance_figure(outcome.covariances),
          start_figure(outcome.start)};
}

Attachment mode_shapes(const Outcome& outcome) {
  const BeamCase& beam = outcome.beams[1].beam;
  const auto system = fem::assemble(steel_beam(beam.test), release_of(beam.test).elements);
  const fem::Modes& modes = beam.released.modes;
  return {mode_shape_files(modes.size()), [=](const std::filesystem::path& folder) {
            write_mode_shapes(folder, system, modes.shape, modes.frequency_hz());
          }};
}

}  // namespace beamid::experiments::paper
