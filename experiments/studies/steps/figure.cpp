#include <cmath>
#include <numbers>

#include "experiments/models/discretisation_bias.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/studies/steps/report.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

constexpr Colour scheme_colours[] = {Colour::blue,   Colour::vermillion, Colour::green,
                                     Colour::purple, Colour::orange,     Colour::sky};

/// What is drawn over the step, of a mode.
struct Quantities {
  VectorXd frequency, ratio;  ///< [Hz], [%]
};

Quantities predicted_curve(const std::string& scheme, const FoundMode& exact, const VectorXd& steps) {
  Quantities curve{VectorXd(steps.size()), VectorXd(steps.size())};
  const Oscillator truth =
      Oscillator::from_frequency(1.0, 2.0 * std::numbers::pi * exact.frequency_hz, exact.damping_ratio);
  for (Index i = 0; i < steps.size(); ++i) {
    curve.frequency[i] = curve.ratio[i] = std::nan("");
    try {
      const Oscillator seen = seen_through(scheme, truth, steps[i]);
      curve.frequency[i] = seen.frequency_hz();
      curve.ratio[i] = 100.0 * seen.damping_ratio();
    } catch (const std::runtime_error&) {
      break;  // nor at any longer step
    }
  }
  return curve;
}

// Of the valid estimates.
Quantities found_points(const StepsStudy& study, std::size_t discretisation, VectorXd& steps) {
  std::vector<double> x, f, xi;
  for (const RecordAtStep& step : study.steps) {
    const SchemeAtStep& one = step.found[discretisation];
    if (!one.is_valid()) continue;
    x.push_back(1e3 * step.interval);
    f.push_back(one.found->frequency_hz);
    xi.push_back(100.0 * one.found->damping_ratio);
  }
  const auto vector = [](const std::vector<double>& v) {
    return VectorXd(Eigen::Map<const VectorXd>(v.data(), static_cast<Index>(v.size())));
  };
  steps = vector(x);
  return {vector(f), vector(xi)};
}

}  // namespace

Figure steps_figure(const StepsStudy& study) {
  constexpr Index points = 121;
  const double longest = 1.08 * study.steps.back().interval;
  const VectorXd steps = VectorXd::LinSpaced(points, longest / 1e4, longest), shown = 1e3 * steps;
  Panel damping{"", {"step [ms]", false, std::pair{0.0, 1e3 * longest}}, {"damping ratio [%]"}};
  Panel frequency{"", {"step [ms]", false, std::pair{0.0, 1e3 * longest}}, {"frequency [Hz]"}};
  for (std::size_t d = 0; d < study.discretisations.size(); ++d) {
    const std::string& scheme = study.discretisations[d];
    const Colour colour = scheme_colours[d % std::size(scheme_colours)];
    const Quantities curve = predicted_curve(scheme, study.reference(), steps);
    damping.line(scheme + ", predicted", shown, curve.ratio, colour);
    frequency.line(scheme + ", predicted", shown, curve.frequency, colour);
    VectorXd at;
    const Quantities found = found_points(study, d, at);
    damping.points(scheme + ", found", at, found.ratio, colour);
    frequency.points(scheme + ", found", at, found.frequency, colour);
    if (const auto limit = study.extrapolated(d); limit && d > 0) {
      const VectorXd zero = VectorXd::Zero(1);
      damping.open_points(scheme + ", extrapolated", zero,
                          VectorXd::Constant(1, 100.0 * limit->damping_ratio), colour);
      frequency.open_points(scheme + ", extrapolated", zero, VectorXd::Constant(1, limit->frequency_hz),
                            colour);
    }
  }
  Figure figure{"step_size", {damping, frequency}, 1, 2};
  figure.width = 1000;
  figure.caption =
      "One record, every sample of it and fewer. Shown: what filters of each discretisation find (points), "
      "on the "
      "curves that the closed form predicts from what the exact one finds at the record's own step.";
  return figure;
}

}  // namespace beamid::experiments
