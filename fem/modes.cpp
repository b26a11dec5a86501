#include "fem/modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "fem/solvers/dense_modes.hpp"
#include "fem/solvers/lanczos.hpp"
#include "fem/solvers/repeated_rows.hpp"

namespace beamid::fem {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Below this residual the complementary quotient, which errs by its square, is the better one.
constexpr double converged = 1e-6;
constexpr double largest_residual = 1e-4;  // of what Lanczos may return

// Normalises the shape of mode i and fills in what is told of it.
class Appraisal {
 public:
  Appraisal(const StructuralSystem& system, const StiffnessSolver& solver, const RigidComplement& complement)
      : system_(system),
        solver_(solver),
        complement_(complement),
        mass_(system.mass),
        flexibility_(system.stiffness.flexibility) {}

  void operator()(Modes& modes, Index i, bool always_from_forces) {
    VectorXd shape = modes.shape.col(i), load = mass_ * shape;
    const double size = std::sqrt(shape.dot(load));
    shape /= size;
    load /= size;
    complement_.project_load(load);
    StiffnessSolver::Solution next = solver_.solve_with_forces(load);
    complement_.project_motion(next.coordinates);
    load = mass_ * next.coordinates;
    const double square =
        next.natural_forces.dot(flexibility_ * next.natural_forces) / next.coordinates.dot(load);
    const VectorXd difference = shape - square * next.coordinates;
    modes.residual[i] = std::sqrt(difference.dot(mass_ * difference));
    if (modes.residual[i] < converged) shape.swap(next.coordinates);
    orthonormalise(shape, modes.shape.leftCols(i));
    const double rayleigh = system_.stiffness.energy(shape);
    if (square < 0.0 || rayleigh < 0.0) throw_unstable(std::min(square, rayleigh));
    const bool from_forces = always_from_forces || modes.residual[i] < converged;
    modes.angular_frequency[i] = std::sqrt(from_forces ? square : rayleigh);
    modes.rayleigh_angular_frequency[i] = std::sqrt(rayleigh);
    modes.shape.col(i) = shape;
  }

 private:
  const StructuralSystem& system_;
  const StiffnessSolver& solver_;
  const RigidComplement& complement_;
  RepeatedRows mass_, flexibility_;

  // Against the modes below, which an inverse iteration brings out.
  void orthonormalise(VectorXd& shape, const Eigen::Ref<const MatrixXd>& below) const {
    const VectorXd load = mass_ * shape;
    if (below.cols() > 0) shape -= below * (below.transpose() * load).eval();
    shape /= std::sqrt(shape.dot(mass_ * shape));
  }
};

// Neighbours closer than the first estimates could tell may come in the wrong order.
void sort(Modes& modes) {
  std::vector<Index> order(static_cast<std::size_t>(modes.size()));
  std::iota(order.begin(), order.end(), Index{0});
  const auto ascending = [&](Index a, Index b) {
    return modes.angular_frequency[a] < modes.angular_frequency[b];
  };
  if (std::is_sorted(order.begin(), order.end(), ascending)) return;
  std::stable_sort(order.begin(), order.end(), ascending);
  modes.angular_frequency = modes.angular_frequency(order).eval();
  modes.rayleigh_angular_frequency = modes.rayleigh_angular_frequency(order).eval();
  modes.residual = modes.residual(order).eval();
  modes.shape = modes.shape(Eigen::all, order).eval();
}

}  // namespace

VectorXd Modes::frequency_hz() const {
  return angular_frequency / (2.0 * std::numbers::pi);
}

double Modes::digits(Index i) const {
  constexpr double most = 15.0;
  if (rayleigh_angular_frequency[i] == angular_frequency[i]) return most;
  return std::clamp(-std::log10(std::abs(rayleigh_angular_frequency[i] / angular_frequency[i] - 1.0)), 0.0,
                    most);
}

Modes modes(const StructuralSystem& system, Index count) {
  const Index n = system.size();
  if (count < 1 || count > n)
    throw std::invalid_argument("modes: count is " + std::to_string(count) + "; expected 1 to " +
                                std::to_string(n));
  const StiffnessSolver solver(system.stiffness);
  const RigidComplement complement(system.mass, solver.rigid_motions());
  const Index rigid = std::min(count, complement.count()), flexible = count - rigid;
  const bool few = 3 * count < n && n > 60;

  Modes result;
  result.rigid = rigid;
  result.angular_frequency = result.rayleigh_angular_frequency = result.residual = VectorXd::Zero(count);
  if (flexible > 0) {
    result.shape =
        few ? lowest_shapes(system, solver, complement, flexible) : all_shapes(system, solver, complement);
    if (result.shape.cols() < flexible)
      throw std::runtime_error("modes: only " + std::to_string(rigid + result.shape.cols()) + " of the " +
                               std::to_string(count) + " modes asked for have mass");
  }
  if (rigid > 0 || result.shape.cols() > flexible) {
    MatrixXd shapes(n, count);
    shapes.leftCols(rigid) = complement.modes().leftCols(rigid);
    if (flexible > 0) shapes.rightCols(flexible) = result.shape.leftCols(flexible);
    result.shape.swap(shapes);
  }

  Appraisal appraise(system, solver, complement);
  for (Index i = rigid; i < count; ++i) {
    appraise(result, i, few);
    if (few && !(result.residual[i] < largest_residual)) {  // what Lanczos calls converged need not be a mode
      std::ostringstream message;
      const bool compressed = system.stiffness.rigidity.diagonal().minCoeff() < 0.0;
      message << "modes: mode " << i + 1 << " has a relative residual of " << result.residual[i] << "; "
              << (compressed ? "the axial load is too close to a buckling load"
                             : "masses or stiffnesses are too far apart")
              << " for double precision";
      throw std::runtime_error(message.str());
    }
  }
  sort(result);
  return result;
}

}  // namespace beamid::fem
