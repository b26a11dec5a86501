#include "tests/experiments/identify/posterior/posterior_cases.hpp"

#include <cmath>
#include <numbers>

namespace beamid::experiments {

ModalCase modal_case(const Experiment& experiment, const ModalData& data, ModelTrust trust) {
  ModalCase result;
  std::vector<fem::Point> points;
  for (const Sensor& sensor : experiment.sensors)
    points.push_back({"s" + std::to_string(points.size()), sensor.position.value()});
  if (points.empty()) points.push_back(fem::natural_point(experiment.structure));
  const auto modes = static_cast<Eigen::Index>(data.modes.size());
  result.model = std::make_unique<const ModalModel>(experiment.structure, experiment.elements, points,
                                                    asked_parameters(experiment), modes);
  result.space = std::make_unique<const SearchSpace>(result.model->asked());
  result.residual = std::make_unique<const ModalResidual>(*result.model, *result.space, data, trust);
  result.likelihood = std::make_unique<const ModalLikelihood>(*result.residual);
  return result;
}

Experiment two_storeys(const std::string& prior) {
  std::string text = "[chain]\nmasses_kg = [0.52, 0.26]\nstiffnesses_n_per_m = [958.61, 958.61]\n";
  for (int storey = 0; storey < 2; ++storey)
    text += "[[parameters]]\nquantity = \"storey_stiffness\"\nfrom_m = " + std::to_string(storey) +
            ".0\nto_m = " + std::to_string(storey + 1) + ".0\n" + prior;
  return experiment_of(text);
}

// lambda^2 m1 m2 - lambda (k1 m2 + k2 (m1 + m2)) + k1 k2 = 0
std::vector<double> two_storey_frequencies(double lower, double upper) {
  constexpr double m1 = 0.52, m2 = 0.26;
  const double half = 0.5 * (lower * m2 + upper * (m1 + m2)),
               root = std::sqrt(half * half - m1 * m2 * lower * upper);
  const auto hz = [](double lambda) { return std::sqrt(lambda) / (2.0 * std::numbers::pi); };
  return {hz(lower * upper / (half + root)), hz((half + root) / (m1 * m2))};
}

ModalData measured_frequencies(const std::vector<double>& frequencies_hz, double relative) {
  ModalData data = frequencies(frequencies_hz);
  for (MeasuredMode& mode : data.modes) mode.deviation_hz = relative * mode.frequency_hz;
  return data;
}

}  // namespace beamid::experiments
