#include "experiments/studies/reduce/model_behaviour.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "fem/response/frequency_response.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;
constexpr Index most_compared_modes = 200;

double stiffness_at_the_point(const fem::StructuralSystem& system, Index rigid) {
  return rigid > 0 ? std::numeric_limits<double>::quiet_NaN() : fem::static_stiffness(system);
}

// M of M x'' + K x = f for the mode alone, x being the deflection of the point: 1 / (H phi)^2.
double mass_at_the_point(const fem::StructuralSystem& system, const fem::Modes& modes) {
  const Index first = modes.rigid;
  if (first >= modes.size()) return std::numeric_limits<double>::quiet_NaN();
  const VectorXd seen = system.outputs * modes.shape.col(first);
  const double there = seen[0];
  if (std::abs(there) <= 1e-9 * seen.cwiseAbs().maxCoeff()) return std::numeric_limits<double>::quiet_NaN();
  return 1.0 / (there * there);
}

}  // namespace

fem::Modes lowest_modes(const fem::StructuralSystem& system, Index at_least, double below_hz) {
  const Eigen::ArrayXd diagonal = VectorXd(system.mass.diagonal()).array();
  const Index all = (diagonal > 0.0).count();  // a lumped mesh has rotations without inertia
  const Index most = std::min(all, std::max(most_compared_modes, at_least));
  for (Index count = std::min(most, std::max<Index>(at_least, 25));; count = std::min(2 * count, most)) {
    fem::Modes found = fem::modes(system, count);
    if (count == most || found.frequency_hz()[count - 1] >= below_hz) return found;
  }
}

ModelModes lowest_modes(const reduction::ReducedModel& model, Index at_least, double below_hz) {
  ModelModes found{lowest_modes(model.system, at_least, below_hz), {}};
  found.shapes = model.lift(found.modes.shape);
  return found;
}

ModelBehaviour behaviour_of(const fem::StructuralSystem& system, const ModelModes& modes,
                            const fem::SparseMatrix& mass, const fem::DampingLaw& damping,
                            const VectorXd& frequency_hz, const ReleaseTest& test) {
  ModelBehaviour found;
  found.static_stiffness = stiffness_at_the_point(system, modes.modes.rigid);
  found.modal_mass = mass_at_the_point(system, modes.modes);
  const fem::FrequencyResponseMethod method{"modal", modes.modes.size(), true};
  found.receptance = fem::receptance(system, damping, frequency_hz, 0, 0, method).cwiseAbs();
  const auto begin = std::chrono::steady_clock::now();
  found.decay = decay(test, system, modes.modes, modes.shapes, mass);
  found.decay_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return found;
}

}  // namespace beamid::experiments
