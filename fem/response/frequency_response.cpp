#include "fem/response/frequency_response.hpp"

#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>

#include <Eigen/LU>

#include "fem/response/dynamic_stiffness.hpp"
#include "fem/stiffness_solver.hpp"

namespace beamid::fem {

using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

ModalBasis modal_basis(const StructuralSystem& system, const DampingLaw& damping, Index count) {
  const Index n = system.size();
  if (count < 0 || count > n)
    throw std::invalid_argument("modal method: " + std::to_string(count) + " modes; expected 1 to " +
                                std::to_string(n) + ", or 0 for an automatic choice");
  ModalBasis basis;
  basis.modes = modes(system, count > 0 ? count : (n <= 200 ? n : Index{100}));
  const MatrixXd& shape = basis.modes.shape;
  basis.square = basis.modes.angular_frequency.cwiseAbs2();
  if (std::holds_alternative<StructuralDamping>(damping))
    basis.rate.setZero(basis.square.size());
  else
    basis.rate = damping_rates(damping, basis.modes.angular_frequency);
  if (system.damping.nonZeros() > 0) basis.coupling = shape.transpose() * (system.damping * shape);
  basis.loads = shape.transpose() * system.inputs;
  basis.observed = system.outputs * shape;
  return basis;
}

MatrixXd residual_deflection(const StructuralSystem& system, const ModalBasis& basis) {
  const MatrixXd& shape = basis.modes.shape;
  MatrixXd unseen = system.inputs;
  for (int pass = 0; pass < 2; ++pass) unseen -= system.mass * (shape * (shape.transpose() * unseen));
  // What the modes take up whole, as rigid-body motions do an acceleration of the base, leaves rounding only.
  for (Index j = 0; j < unseen.cols(); ++j)
    if (unseen.col(j).norm() <= 1e-12 * system.inputs.col(j).norm()) unseen.col(j).setZero();
  const MatrixXd deflection = StiffnessSolver(system.stiffness).solve(unseen);
  return deflection - shape * (shape.transpose() * (system.mass * deflection));
}

namespace {

using Complex = std::complex<double>;
constexpr Complex i{0.0, 1.0};

double loss_factor(const DampingLaw& law) {
  const auto* structural = std::get_if<StructuralDamping>(&law);
  if (!structural) return 0.0;
  damping_ratios(law, VectorXd::Ones(1));  // checks it
  return structural->loss_factor;
}

[[noreturn]] void report_resonance(double frequency_hz) {
  std::ostringstream message;
  message
      << "frequency response: infinite at " << frequency_hz
      << " Hz, a resonance without damping or a rigid-body motion; expected another frequency, or damping";
  throw std::runtime_error(message.str());
}

MatrixXcd direct(const StructuralSystem& system, const DampingLaw& law, const VectorXd& frequency_hz,
                 const std::vector<InputOutput>& pairs) {
  const double eta = loss_factor(law);
  ProportionalDamping viscous;
  if (!std::holds_alternative<StructuralDamping>(law)) try {
      viscous = proportional_coefficients(law);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(std::string("frequency response, direct: ") + error.what());
    }
  std::map<Index, Index> column;  // of each input that is used
  for (const InputOutput& pair : pairs) column.try_emplace(pair.input, static_cast<Index>(column.size()));
  MatrixXcd loads(system.size(), static_cast<Index>(column.size()));
  for (const auto& [input, place] : column)
    loads.col(place) = VectorXd(system.inputs.col(input)).cast<Complex>();
  const SparseMatrix& outputs = system.outputs;

  DynamicStiffness dynamic(system);
  MatrixXcd result(frequency_hz.size(), static_cast<Index>(pairs.size()));
  for (Index k = 0; k < frequency_hz.size(); ++k) {
    const double omega = 2.0 * std::numbers::pi * frequency_hz[k];
    if (!dynamic.factor(1.0 + i * (eta + omega * viscous.stiffness),
                        -omega * omega + i * omega * viscous.mass, i * omega))
      report_resonance(frequency_hz[k]);
    const MatrixXcd seen = outputs.cast<Complex>() * dynamic.solve(loads).coordinates;
    for (std::size_t p = 0; p < pairs.size(); ++p)
      result(k, static_cast<Index>(p)) = seen(pairs[p].output, column[pairs[p].input]);
  }
  return result;
}

MatrixXcd modal(const StructuralSystem& system, const DampingLaw& law, const VectorXd& frequency_hz,
                const std::vector<InputOutput>& pairs, const FrequencyResponseMethod& method) {
  const double eta = loss_factor(law);
  const ModalBasis basis = modal_basis(system, law, method.modes);
  MatrixXd residual;
  if (method.residual_modes && basis.square.size() < system.size())
    residual = system.outputs * residual_deflection(system, basis);
  MatrixXcd result(frequency_hz.size(), static_cast<Index>(pairs.size()));
  for (Index k = 0; k < frequency_hz.size(); ++k) {
    const double omega = 2.0 * std::numbers::pi * frequency_hz[k];
    const VectorXcd diagonal = (1.0 + i * eta) * basis.square.cast<Complex>() + i * omega * basis.rate -
                               VectorXcd::Constant(basis.rate.size(), omega * omega);
    if (basis.coupling.size() == 0 && diagonal.cwiseAbs().minCoeff() == 0.0)
      report_resonance(frequency_hz[k]);
    MatrixXcd motion = diagonal.cwiseInverse().asDiagonal() * basis.loads;
    if (basis.coupling.size() > 0) {
      MatrixXcd coupled = i * omega * basis.coupling;
      coupled.diagonal() += diagonal;
      motion = coupled.partialPivLu().solve(basis.loads.cast<Complex>());
      if (!motion.allFinite()) report_resonance(frequency_hz[k]);
    }
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      Complex& value = result(k, static_cast<Index>(p));
      value = (basis.observed.row(pairs[p].output) * motion.col(pairs[p].input)).value();
      if (residual.size() > 0) value += residual(pairs[p].output, pairs[p].input) / (1.0 + i * eta);
    }
  }
  return result;
}

void check(const StructuralSystem& system, const VectorXd& frequency_hz,
           const std::vector<InputOutput>& pairs) {
  std::ostringstream message;
  for (const auto& [input, output] : pairs)
    if (input < 0 || input >= system.inputs.cols())
      message << "input " << input << "; expected 0 to " << system.inputs.cols() - 1;
    else if (output < 0 || output >= system.outputs.rows())
      message << "output " << output << "; expected 0 to " << system.outputs.rows() - 1;
  for (Index k = 0; k < frequency_hz.size() && message.str().empty(); ++k)
    if (!(frequency_hz[k] >= 0.0 && std::isfinite(frequency_hz[k])))
      message << frequency_hz[k] << " Hz; expected a finite frequency of at least 0";
  if (!message.str().empty()) throw std::invalid_argument("frequency response: " + message.str());
}

}  // namespace

MatrixXcd receptances(const StructuralSystem& system, const DampingLaw& damping, const VectorXd& frequency_hz,
                      const std::vector<InputOutput>& pairs, const FrequencyResponseMethod& method) {
  check(system, frequency_hz, pairs);
  if (method.name == "direct") return direct(system, damping, frequency_hz, pairs);
  if (method.name == "modal") return modal(system, damping, frequency_hz, pairs, method);
  throw std::invalid_argument("unknown frequency response method '" + method.name +
                              "'; known: direct, modal");
}

VectorXcd receptance(const StructuralSystem& system, const DampingLaw& damping, const VectorXd& frequency_hz,
                     Index input, Index output, const FrequencyResponseMethod& method) {
  return receptances(system, damping, frequency_hz, {{input, output}}, method);
}

VectorXcd mobility(const VectorXd& frequency_hz, const VectorXcd& receptance) {
  return (2.0 * std::numbers::pi * i) * frequency_hz.cwiseProduct(receptance);
}

VectorXcd accelerance(const VectorXd& frequency_hz, const VectorXcd& receptance) {
  return -(4.0 * std::numbers::pi * std::numbers::pi) * frequency_hz.cwiseAbs2().cwiseProduct(receptance);
}

}  // namespace beamid::fem
