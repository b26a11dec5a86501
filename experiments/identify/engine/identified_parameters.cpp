#include "experiments/identify/engine/identified_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace beamid::experiments {

using Eigen::Index;

std::optional<filters::Diagnostics> diagnostics_of(const filters::FilterRun& run,
                                                   const filters::Gaussian& initial,
                                                   const std::vector<Index>& unknowns) {
  constexpr Index fewest = 100;
  const Index reached = run.failure ? run.failure->step : run.normalised_squares.size();
  if (reached < fewest) return std::nullopt;
  return filters::diagnose(run, initial, unknowns);
}

std::string failure_sentences(const std::vector<filters::Failure>& events) {
  constexpr std::size_t listed = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(listed, events.size()); ++i)
    text += fmt::format("{}Sample {}, {:.4f} s: {}{}.", i ? " " : "", events[i].step, events[i].time,
                        events[i].reason,
                        std::isnan(events[i].smallest_eigenvalue)
                            ? ""
                            : fmt::format(" (smallest eigenvalue {:.3g})", events[i].smallest_eigenvalue));
  if (events.size() > listed) text += fmt::format(" And {} more events.", events.size() - listed);
  return text;
}

std::vector<Parameter> parameters(const RecordIdentification& found) {
  return parameters(found, found.identification);
}

Eigen::Matrix4d covariance_of_parameters(const RecordIdentification& found) {
  const Identification& i = found.identification;
  const double stiffness = i.found.stiffness, mass = i.found.mass;
  Eigen::Matrix<double, 4, 2> slopes;  // of f = sqrt(K/M) / 2 pi, C / (2 sqrt(K M)), K and C
  slopes << 0.5 * i.found.frequency_hz() / stiffness, 0.0,  //
      -0.5 * i.found.damping_ratio() / stiffness, 0.5 / std::sqrt(stiffness * mass), 1, 0, 0, 1;
  const double of_frequency = found.frequency_factor(), of_damping = found.damping_factor();
  slopes = Eigen::Vector4d(of_frequency, of_damping, of_frequency, of_damping).asDiagonal() * slopes;
  return slopes * i.run.last.marginal(2, 2) * slopes.transpose();
}

std::vector<Parameter> parameters(const RecordIdentification& found, const Identification& i) {
  const Oscillator modal = Oscillator::from_frequency(
      i.found.mass, 2.0 * std::numbers::pi * found.modal.frequency_hz, found.modal.damping_ratio);
  const double absent = found.modal_failure.empty() ? 0.0 : std::nan("");
  const double of_frequency = found.frequency_factor(), of_damping = found.damping_factor();
  return {{"frequency [Hz]", "frequency_hz", 1.0, i.found.frequency_hz(),
           of_frequency * i.frequency_deviation_hz, absent + found.modal.frequency_hz},
          {"damping ratio [%]", "damping_ratio", 100.0, i.found.damping_ratio(),
           of_damping * i.damping_ratio_deviation, absent + found.modal.damping_ratio},
          {"stiffness K [N/m]", "stiffness_n_per_m", 1.0, i.found.stiffness,
           of_frequency * i.stiffness_deviation, absent + modal.stiffness},
          {"damping C [N s/m]", "damping_n_s_per_m", 1.0, i.found.damping, of_damping * i.damping_deviation,
           absent + modal.damping}};
}

}  // namespace beamid::experiments
