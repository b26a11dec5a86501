// Exact modal superposition: each mode is an oscillator that is carried over every interval by its own
// solution, exact for inputs linear in between and for any damping ratio [craig2006]. No time stepping error
// at any interval. Dashpots of the model couple the modes: these then move together, by the exponential of
// their common matrix [vanloan1978].
#include <Eigen/Core>
#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "fem/response/blocked_motion.hpp"
#include "fem/response/method.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Inputs that are not zero throughout: the others cost nothing.
std::vector<Index> active_inputs(const ResponseProblem& problem) {
  std::vector<Index> active;
  for (Index i = 0; i < problem.inputs.rows(); ++i)
    if (problem.inputs.row(i).any()) active.push_back(i);
  return active;
}

// "40 of 200 modes, up to 1.2e+04 Hz; left out: 3e-09 of the initial displacement of tip_deflection, ..."
std::string remark(const ResponseProblem& problem, const ModalBasis& basis, const VectorXd& z,
                   const std::vector<Index>& active) {
  const StructuralSystem& system = problem.system;
  std::ostringstream text;
  text.precision(2);
  text << "modal: " << basis.square.size() << " of " << system.size() << " modes, up to "
       << basis.modes.frequency_hz().maxCoeff() << " Hz";
  const MatrixXd deflection =
      active.empty() ? MatrixXd() : MatrixXd(system.outputs * residual_deflection(system, basis));
  const VectorXd seen = system.outputs * problem.displacement;
  for (Index output = 0; output < system.outputs.rows(); ++output) {
    if (seen[output] != 0.0)
      text << "; modal truncation error of the initial " << system.output_names[output] << ": "
           << seen[output] - basis.observed.row(output).dot(z) << " m";
    for (const Index input : active)
      text << "; modal truncation error of the static " << system.output_names[output] << " per unit of "
           << system.input_names[input] << ": " << deflection(output, input);
  }
  return text.str();
}

// Displacement, velocity and, from z'' = Gamma f - d z' - omega^2 z, acceleration of every output.
ModalObservation observation(const ModalBasis& basis, const MatrixXd& loads) {
  const Index p = basis.observed.rows(), k = basis.square.size();
  ModalObservation seen{MatrixXd::Zero(3 * p, 2 * k), MatrixXd::Zero(3 * p, loads.cols())};
  seen.state.block(0, 0, p, k) = seen.state.block(p, k, p, k) = basis.observed;
  seen.state.block(2 * p, 0, p, k) = -basis.observed * basis.square.asDiagonal();
  seen.state.block(2 * p, k, p, k) = -basis.observed * basis.rate.asDiagonal();
  if (basis.coupling.size() > 0) seen.state.block(2 * p, k, p, k) -= basis.observed * basis.coupling;
  seen.input.bottomRows(p) = basis.observed * loads;
  return seen;
}

// Observations (3 p per sample, one sample after the other) from sample `first` on.
void store(const MatrixXd& observations, Index first, Response& response) {
  const Index p = response.displacement.rows();
  if (p == 0) return;
  const Eigen::Map<const MatrixXd> samples(observations.data(), 3 * p, observations.size() / (3 * p));
  const Index count = std::min(samples.cols(), response.time.size() - first);
  response.displacement.middleCols(first, count) = samples.block(0, 0, p, count);
  response.velocity.middleCols(first, count) = samples.block(p, 0, p, count);
  response.acceleration.middleCols(first, count) = samples.block(2 * p, 0, p, count);
}

// The whole field at those of the asked samples that lie in the blocks just advanced.
void keep_frames(const BlockedMotion& motion, const ModalBasis& basis, const MatrixXd& loads,
                 const MatrixXd& inputs, Index first, Index blocks, ResponseRecorder& recorder) {
  const Index k = basis.square.size();
  for (Index sample = 0; sample < blocks * BlockedMotion::length; ++sample) {
    if (!recorder.wants_frame(first + sample)) continue;
    const Index block = sample / BlockedMotion::length;
    MatrixXd state = motion.starts().col(block);
    for (Index i = block * BlockedMotion::length; i < sample; ++i)
      state = motion.transition().apply(state) + motion.transition().from * inputs.col(i) +
              motion.transition().to * inputs.col(i + 1);
    const VectorXd z = state.topRows(k), rate = state.bottomRows(k);
    VectorXd second =
        loads * inputs.col(sample) - basis.rate.cwiseProduct(rate) - basis.square.cwiseProduct(z);
    if (basis.coupling.size() > 0) second -= basis.coupling * rate;
    recorder.keep_frame(basis.modes.shape * z, basis.modes.shape * rate, basis.modes.shape * second);
  }
}

Response modal_superposition(const ResponseProblem& problem, const ResponseOptions& options) {
  const StructuralSystem& system = problem.system;
  if (!system.nonlinear_forces.empty())
    throw std::invalid_argument(
        "modal: with cubic springs or quadratic dashpots no motion is a sum of modes; expected newmark, "
        "hht_alpha, generalised_alpha, arkode or cvode");
  require_option("modal", options, "modes", 0.0, static_cast<double>(system.size()),
                 "0 (all, 100 where there are more than 200) to " + std::to_string(system.size()));
  const ModalBasis basis = modal_basis(system, problem.damping, static_cast<Index>(options.at("modes")));
  const std::vector<Index> active = active_inputs(problem);
  const Index samples = problem.grid.samples, k = basis.square.size(), m = static_cast<Index>(active.size());
  const MatrixXd loads = basis.loads(Eigen::all, active),
                 inputs = m > 0 ? problem.inputs(active, Eigen::all) : MatrixXd(0, samples);

  VectorXd state(2 * k);
  state << basis.modes.shape.transpose() * (system.mass * problem.displacement),
      basis.modes.shape.transpose() * (system.mass * problem.velocity);
  ResponseRecorder recorder(problem);
  if (k < system.size()) recorder.response().remarks.push_back(remark(problem, basis, state.head(k), active));

  BlockedMotion motion(basis, loads, problem.grid.interval, observation(basis, loads));
  constexpr Index length = BlockedMotion::length, blocks_at_once = 64;
  for (Index first = 0; first < samples; first += length * blocks_at_once) {
    const Index blocks = std::min(blocks_at_once, (samples - first + length - 1) / length);
    MatrixXd block_inputs = MatrixXd::Zero(m, length * blocks + 1);  // zero beyond the last sample
    const Index present = std::min(block_inputs.cols(), samples - first);
    block_inputs.leftCols(present) = inputs.middleCols(first, present);
    const Eigen::Map<const MatrixXd> stacked(block_inputs.data(), length * m, blocks);
    const MatrixXd observations = motion.advance(state, stacked, block_inputs.rightCols<1>());
    store(observations, first, recorder.response());
    keep_frames(motion, basis, loads, block_inputs, first, blocks, recorder);
  }
  return std::move(recorder.response());
}

const bool modal_registered = register_response_method(
    {"modal",
     "exact sum of modes, for linear structures; no error from the interval",
     "[craig2006], [vanloan1978]",
     {{"modes", 0.0, "", "how many of the lowest modes; 0: all, 100 where there are more than 200"}}},
    modal_superposition);

}  // namespace
}  // namespace beamid::fem
