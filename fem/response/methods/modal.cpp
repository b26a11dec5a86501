// Exact modal superposition: each mode is an oscillator that is carried over every interval by its own
// solution, exact for inputs linear in between and for any damping ratio [craig2006]. No time stepping error
// at any interval. Dashpots of the model couple the modes: these then move together, by the exponential of
// their common matrix [vanloan1978].
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <Eigen/Core>
#include <unsupported/Eigen/MatrixFunctions>

#include "fem/response/frequency_response.hpp"
#include "fem/response/method.hpp"

namespace beamid::fem {
namespace {

// One step of one oscillator, exact.

/// z'' + d z' + omega^2 z = f over a time t, f linear in between. With the impulse response h, its integral P
/// (the step response) and the integral of that R (the ramp response), all at t,
///
///     z(t)  = z + (-omega^2 P z + h z') + P f + R f'
///     z'(t) = z' + (-omega^2 h z - (omega^2 P + d h) z') + h f + P f',     f' = (f(t) - f) / t.
///
/// Written as increments, so that a slow motion in short steps is not rounded to the size of z itself at
/// each.
struct OscillatorStep {
  double impulse = 0.0;  ///< h [s]
  double step = 0.0;     ///< P [s2]
  double ramp = 0.0;     ///< R [s3]

  /// For any damping, critical and above included, and for omega = 0: power series over t / 2^k, doubled k
  /// times.
  /// @param square omega^2 [1/s2], @param rate d [1/s], @param time t [s]
  static OscillatorStep over(double square, double rate, double time);
};

OscillatorStep OscillatorStep::over(double square, double rate, double time) {
  int doublings = 0;
  double t = time;
  while (std::sqrt(square) * t > 0.5 || rate * t > 0.5) {
    t *= 0.5;
    ++doublings;
  }
  // h = sum of terms c_k t^k with k (k + 1) c_{k+1} = -d k c_k - omega^2 c_{k-1}, c_0 = 0, c_1 = 1
  OscillatorStep result;
  double previous = 0.0, term = t;
  for (int k = 1; k < 24; ++k) {
    result.impulse += term;
    result.step += term * t / (k + 1);
    result.ramp += term * t * t / ((k + 1) * (k + 2));
    const double next = -(rate * t * term * k + square * t * t * previous) / (k * (k + 1));
    previous = term;
    term = next;
  }
  for (; doublings > 0; --doublings) {
    const auto [h, p, r] = result;
    result.ramp = r + (r + t * p + (h * p - square * p * r));
    result.step = p + (p + (h * h - square * p * p));
    result.impulse = h + (h - (2.0 * square * p * h + rate * h * h));
    t *= 2.0;
  }
  return result;
}

// Modal coordinates carried over an interval, exactly.

/// x(t + h) = A x(t) + V f(t) + U f(t + h) for the state x = (z, z') (2k) and inputs f linear in between:
/// mode by mode (modal.cpp) or, where dashpots couple the modes, by the exponential of the matrix
/// of all of them, inputs included [vanloan1978]. A - I is what is kept: a slow motion is not rounded to its
/// own size at every step.
class ModalTransition {
 public:
  /// @param loads Gamma (k x m) of the inputs, @param interval h [s]
  ModalTransition(const ModalBasis& basis, const Eigen::MatrixXd& loads, double interval);

  /// A x, column by column (2k x any).
  Eigen::MatrixXd apply(const Eigen::MatrixXd& states) const;

  /// Rows times A (any x 2k).
  Eigen::MatrixXd apply_to_rows(const Eigen::MatrixXd& rows) const;

  Eigen::MatrixXd from, to;  ///< V, U (2k x m)

 private:
  bool coupled_;
  Eigen::MatrixXd increment_;         ///< A - I (2k x 2k), when coupled
  Eigen::ArrayXd zz_, zv_, vz_, vv_;  ///< else its four diagonals (k)
};

using Eigen::ArrayXd, Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// The exponential for states (s z, z'), s making its norm even, and inputs (f, h f').
MatrixXd scaled_exponential(const ModalBasis& basis, const MatrixXd& loads, double h, double s) {
  const Index k = basis.square.size(), m = loads.cols();
  MatrixXd rate = MatrixXd::Zero(2 * (k + m), 2 * (k + m));
  rate.block(0, k, k, k).diagonal().setConstant(s * h);
  rate.block(k, 0, k, k).diagonal() = -basis.square * (h / s);
  rate.block(k, k, k, k) = -h * basis.coupling;
  rate.block(k, k, k, k).diagonal() -= h * basis.rate;
  rate.block(k, 2 * k, k, m) = h * loads;
  rate.bottomRightCorner(m, m).setZero();
  rate.block(2 * k, 2 * k + m, m, m).setIdentity();
  return rate.exp();
}

ModalTransition::ModalTransition(const ModalBasis& basis, const MatrixXd& loads, double interval)
    : from(2 * loads.rows(), loads.cols()),
      to(2 * loads.rows(), loads.cols()),
      coupled_(basis.coupling.size() > 0) {
  const Index k = basis.square.size(), m = loads.cols();
  if (coupled_) {
    const double s = std::max(std::sqrt(basis.square.maxCoeff()), 1e-3 / interval);
    const MatrixXd transition = scaled_exponential(basis, loads, interval, s);
    increment_ = transition.topLeftCorner(2 * k, 2 * k);
    increment_.diagonal().array() -= 1.0;
    to = transition.block(0, 2 * k + m, 2 * k, m);
    from = transition.block(0, 2 * k, 2 * k, m) - to;
    increment_.topRightCorner(k, k) /= s;
    increment_.bottomLeftCorner(k, k) *= s;
    to.topRows(k) /= s;
    from.topRows(k) /= s;
    return;
  }
  for (ArrayXd* diagonal : {&zz_, &zv_, &vz_, &vv_}) diagonal->resize(k);
  for (Index i = 0; i < k; ++i) {
    const auto [h, p, r] = OscillatorStep::over(basis.square[i], basis.rate[i], interval);
    zz_[i] = -basis.square[i] * p;
    zv_[i] = h;
    vz_[i] = -basis.square[i] * h;
    vv_[i] = -basis.square[i] * p - basis.rate[i] * h;
    from.row(i) = (p - r / interval) * loads.row(i);
    to.row(i) = (r / interval) * loads.row(i);
    from.row(k + i) = (h - p / interval) * loads.row(i);
    to.row(k + i) = (p / interval) * loads.row(i);
  }
}

MatrixXd ModalTransition::apply(const MatrixXd& states) const {
  if (coupled_) return states + increment_ * states;
  const Index k = zz_.size();
  MatrixXd next(states.rows(), states.cols());
  for (Index column = 0; column < states.cols(); ++column) {
    const auto z = states.col(column).head(k).array(), v = states.col(column).tail(k).array();
    next.col(column).head(k) = z + (zz_ * z + zv_ * v);
    next.col(column).tail(k) = v + (vz_ * z + vv_ * v);
  }
  return next;
}

MatrixXd ModalTransition::apply_to_rows(const MatrixXd& rows) const {
  if (coupled_) return rows + rows * increment_;
  const Index k = zz_.size();
  MatrixXd next(rows.rows(), rows.cols());
  for (Index row = 0; row < rows.rows(); ++row) {
    const auto z = rows.row(row).head(k).transpose().array(), v = rows.row(row).tail(k).transpose().array();
    next.row(row).head(k) = (z + (z * zz_ + v * vz_)).matrix().transpose();
    next.row(row).tail(k) = (v + (z * zv_ + v * vv_)).matrix().transpose();
  }
  return next;
}

// The sampled motion of modal coordinates, many samples at a time.

/// What is observed of the state x = (z, z') and the inputs f: y = O x + F f.
struct ModalObservation {
  Eigen::MatrixXd state;  ///< O (r x 2k)
  Eigen::MatrixXd input;  ///< F (r x m)
};

/// The states at every L-th sample only, and the L observations that follow each of them as one product
///
///     (y_0 ... y_{L-1}) = (O; O A; ... O A^{L-1}) x + T (f_0 ... f_{L-1}),
///
/// T holding the answers to unit inputs within the block. That is the exact motion with fewer operations, and
/// fewer roundings, than one sample after the other.
class BlockedMotion {
 public:
  BlockedMotion(const ModalBasis& basis, const Eigen::MatrixXd& loads, double interval,
                const ModalObservation& observation);

  static constexpr Eigen::Index length = 32;  ///< L

  /// @param state x at the first sample; becomes that of the sample after the last of these blocks
  /// @param inputs (L m x blocks) f_0 ... f_{L-1} of each block, @param after (m) the input that follows them
  /// @returns (L r x blocks) the observations
  Eigen::MatrixXd advance(Eigen::VectorXd& state, const Eigen::MatrixXd& inputs,
                          const Eigen::VectorXd& after);

  /// States at the beginning of the blocks that were advanced last (2k x blocks).
  const Eigen::MatrixXd& starts() const { return starts_; }

  /// One sample.
  const ModalTransition& transition() const { return step_; }

 private:
  ModalTransition step_, leap_;  // over 1 and over L intervals
  Eigen::MatrixXd observed_;     // O A^j (L r x 2k)
  Eigen::MatrixXd answers_;      // T (L r x L m)
  Eigen::MatrixXd pushed_;       // state after L intervals by f_0 ... f_{L-1} (2k x L m)
  Eigen::MatrixXd starts_;
};

BlockedMotion::BlockedMotion(const ModalBasis& basis, const MatrixXd& loads, double interval,
                             const ModalObservation& observation)
    : step_(basis, loads, interval), leap_(basis, loads, static_cast<double>(length) * interval) {
  const Index r = observation.state.rows(), m = loads.cols(), states = observation.state.cols();
  observed_.resize(length * r, states);
  MatrixXd rows = observation.state;
  for (Index j = 0; j < length; ++j) {
    observed_.middleRows(j * r, r) = rows;
    if (j + 1 < length) rows = step_.apply_to_rows(rows);
  }
  // y_j = F f_j + sum of O A^{j-i} U f_i (0 < i <= j) + O A^{j-i-1} V f_i (i < j)
  const MatrixXd by_from = observed_ * step_.from, by_to = observed_ * step_.to;
  answers_.setZero(length * r, length * m);
  for (Index j = 0; j < length; ++j)
    for (Index i = 0; i <= j; ++i) {
      auto answer = answers_.block(j * r, i * m, r, m);
      if (i == j) answer += observation.input;
      if (i > 0) answer += by_to.middleRows((j - i) * r, r);
      if (i < j) answer += by_from.middleRows((j - i - 1) * r, r);
    }
  // x_L = A^L x + sum of A^{L-i} U f_i (0 < i <= L) + A^{L-i-1} V f_i (i < L)
  pushed_.setZero(states, length * m);
  MatrixXd from = step_.from, to = step_.to;
  for (Index i = length; i-- > 0;) {
    pushed_.middleCols(i * m, m) += from;
    if (i == 0) break;
    to = step_.apply(to);
    pushed_.middleCols(i * m, m) += to;
    from = step_.apply(from);
  }
}

MatrixXd BlockedMotion::advance(VectorXd& state, const MatrixXd& inputs, const VectorXd& after) {
  const Index blocks = inputs.cols(), m = after.size();
  starts_.resize(state.size(), blocks);
  MatrixXd pushes;
  if (m > 0) pushes.noalias() = pushed_ * inputs;
  for (Index block = 0; block < blocks; ++block) {
    starts_.col(block) = state;
    state = leap_.apply(state);
    if (m > 0)
      state += pushes.col(block) + step_.to * (block + 1 < blocks ? inputs.col(block + 1).head(m) : after);
  }
  MatrixXd observations = observed_ * starts_;
  if (m > 0) observations.noalias() += answers_ * inputs;
  return observations;
}

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
