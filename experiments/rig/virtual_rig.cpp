#include "experiments/rig/virtual_rig.hpp"

#include <cmath>

#include "experiments/signal/random.hpp"
#include "fem/assembly.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::experiments {

ReleasedBeam release(const Release& settings) {
  const fem::StructuralSystem system = fem::assemble(settings.beam, settings.elements);
  ReleasedBeam result;
  result.modes = fem::modes(system, settings.modes);
  result.modal_amplitudes =
      fem::modal_amplitudes(system, result.modes, settings.tip_deflection * fem::static_shape(system));
  Eigen::VectorXd damping = Eigen::VectorXd::Constant(settings.modes, settings.higher_damping_ratio);
  damping[0] = settings.first_damping_ratio;
  const auto samples = static_cast<Eigen::Index>(std::lround(settings.duration * settings.sampling_rate)) + 1;
  result.time =
      Eigen::VectorXd::LinSpaced(samples, 0, static_cast<double>(samples - 1)) / settings.sampling_rate;
  result.tip = fem::free_decay(result.modal_amplitudes, result.modes.angular_frequency, damping, result.time);
  return result;
}

Record measure_acceleration(const ReleasedBeam& beam, double noise, std::uint64_t seed,
                            std::uint64_t stream) {
  Record record;
  record.time = beam.time;
  record.samples =
      (beam.tip.acceleration + noise * standard_normal(beam.time.size(), seed, stream)).transpose();
  record.channels = {{Quantity::acceleration, "tip"}};
  return record;
}

}  // namespace beamid::experiments
