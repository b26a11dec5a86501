#include "experiments/identify/backbone/window_filter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/identify/model_setting.hpp"
#include "experiments/models/identification.hpp"
#include "experiments/models/one_coordinate.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::VectorXd;

}  // namespace

Complex displacement_per(Quantity quantity, Complex rate) {
  return quantity == Quantity::acceleration ? 1.0 / (rate * rate)
         : quantity == Quantity::velocity   ? 1.0 / rate
                                            : Complex(1.0);
}

bool filter_window(const SineWindow& sines, const DecimatedSignal& coarse, Quantity quantity, double mass,
                   double noise, AmplitudeWindow& to) {
  const Complex s = sines.mode.rate, x = sines.mode.amplitude * displacement_per(quantity, s), v = s * x;
  const Oscillator oscillator = Oscillator::from_eigenvalue(mass, s);
  const auto model = model_registry().make("sdof", {}, at_one_point(one_coordinate(oscillator), {quantity}));
  const double w = std::abs(s), size = std::abs(x), usual = 0.02 * std::sqrt(oscillator.stiffness * mass);
  constexpr double open = 0.2;
  const auto states = static_cast<Index>(model->motion->state_labels().size());
  VectorXd mean = VectorXd::Zero(states),
           deviation = VectorXd::Constant(states, open * std::abs(sines.mode.amplitude));
  mean.head<4>() << x.real(), v.real(), oscillator.stiffness, oscillator.damping;
  deviation.head<4>() << open * size, open * size * w, open * oscillator.stiffness,
      std::max(std::abs(oscillator.damping), usual);
  IdentificationSettings settings;
  settings.initial.mean = mean;
  settings.initial.covariance = deviation.cwiseAbs2().asDiagonal();
  settings.output_noise = Eigen::MatrixXd::Constant(1, 1, noise * noise);
  settings.passes = 3;
  filters::Measurements measured;
  measured.time = coarse.interval * VectorXd::LinSpaced(sines.count, 0, static_cast<double>(sines.count - 1));
  measured.outputs = coarse.samples.segment(sines.begin, sines.count).transpose().array() - sines.offset;
  const Identification found = identify(*model, measured, settings);
  if (found.run.failure || lost(found, w / (2 * std::numbers::pi))) return false;
  to.stiffness = found.found.stiffness;
  to.stiffness_deviation = found.stiffness_deviation;
  to.damping = found.found.damping;
  to.damping_deviation = found.damping_deviation;
  to.frequency_hz = found.found.frequency_hz();
  to.damping_ratio = found.found.damping_ratio();
  return std::isfinite(to.stiffness_deviation) && to.stiffness > 0;
}

}  // namespace beamid::experiments
