#include "experiments/models/motion/reduced_motion.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Below this share of the diagonal a coupling is what rounding left of none.
constexpr double negligible = 1e-9;

bool is_diagonal(const MatrixXd& matrix, const VectorXd& size) {
  for (Index i = 0; i < matrix.rows(); ++i)
    for (Index j = 0; j < matrix.cols(); ++j)
      if (i != j && std::abs(matrix(i, j)) > negligible * std::sqrt(size[i] * size[j])) return false;
  return true;
}

void keep_diagonal(MatrixXd& matrix) {
  matrix = MatrixXd(matrix.diagonal());
}

// Square matrices (r x r) or, where they have nothing else, their diagonals (r x 1).
struct Products {
  bool of_diagonals;

  MatrixXd diagonal(const VectorXd& entries) const {
    return of_diagonals ? MatrixXd(entries) : MatrixXd(entries.asDiagonal());
  }
  void subtract(const MatrixXd& a, const MatrixXd& b, MatrixXd& from) const {  // from -= a b
    if (of_diagonals)
      from.noalias() -= a.col(0).asDiagonal() * b;
    else
      from.noalias() -= a * b;
  }
  void add_outer(const VectorXd& a, const VectorXd& b, MatrixXd& to) const {  // to += a b^T
    if (of_diagonals)
      to += a.cwiseProduct(b);
    else
      to.noalias() += a * b.transpose();
  }
};

// M, K, C and E at some values of the unknowns, square ones as Products keeps them.
class Evaluation {
 public:
  Evaluation(const ReducedEquations& equations, bool decoupled, const MotionDescription& given,
             PhysicalValues at)
      : equations_(equations),
        given_(given),
        at_(std::move(at)),
        products_{decoupled},
        mass_(products_.diagonal(equations.mass)),
        stiffness_(products_.diagonal(equations.stiffness)),
        damping_(equations.damping),
        inputs_(equations.inputs) {
    for (Index j = 0; j < given.properties(); ++j) {
      const double change = at_.change[j];
      if (change == 0.0) continue;
      const ReducedEquations::Derivative& slope = derivative(j);
      mass_ += change * slope.mass;
      stiffness_ += change * slope.stiffness;
      inputs_ += change * slope.inputs;
      if (slope.damping.size() > 0) damping_ += change * slope.damping;
    }
    if (decoupled && !(mass_.minCoeff() > 0.0))
      throw std::runtime_error("the parameters leave a mode without mass");
    damping_ += at_.mass_damping * mass_ + at_.stiffness_damping * stiffness_;
    for (std::size_t i = 0; i < given.damped_modes.size(); ++i) {
      const ModeDamping& mode = modes_.emplace_back(
          damping_at(given.damped_modes[i], at_.change, at_.ratios[static_cast<Index>(i)]));
      products_.add_outer(mode.factor * mode.momentum, mode.momentum, damping_);
    }
    if (decoupled) return;
    factor_.compute(mass_);
    if (factor_.info() != Eigen::Success)
      throw std::runtime_error("the parameters make the mass matrix indefinite");
  }

  SecondOrderForm form() const { return by_mass({stiffness_, damping_, inputs_, {}}); }

  /// By eta_j: M^-1 (K_j - M_j W), and so on.
  SecondOrderForm slope(const SecondOrderForm& form, Index j) const {
    const Drive& drive = given_.drives[static_cast<std::size_t>(j)];
    SecondOrderForm slope =
        drive.kind == Drive::Kind::property ? by_property(form, drive.index) : by_damping(drive.kind, j);
    for (MatrixXd* matrix : {&slope.stiffness, &slope.damping, &slope.inputs}) *matrix *= at_.slopes[j];
    return by_mass(std::move(slope));
  }

 private:
  const ReducedEquations& equations_;
  const MotionDescription& given_;
  PhysicalValues at_;
  Products products_;
  MatrixXd mass_, stiffness_, damping_, inputs_;
  std::vector<ModeDamping> modes_;
  Eigen::LLT<MatrixXd> factor_;  // of M, where it has more than a diagonal

  const ReducedEquations::Derivative& derivative(Index property) const {
    return equations_.derivatives[static_cast<std::size_t>(property)];
  }

  SecondOrderForm by_property(const SecondOrderForm& form, Index property) const {
    const ReducedEquations::Derivative& by = derivative(property);
    SecondOrderForm slope{
        by.stiffness, at_.mass_damping * by.mass + at_.stiffness_damping * by.stiffness, by.inputs, {}};
    if (by.damping.size() > 0) slope.damping += by.damping;
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      const VectorXd& g = modes_[i].momentum;
      const VectorXd turn = modes_[i].factor * given_.damped_modes[i].momentum_slopes.col(property);
      products_.add_outer(modes_[i].by_property[property] * g, g, slope.damping);
      products_.add_outer(turn, g, slope.damping);
      products_.add_outer(g, turn, slope.damping);
    }
    products_.subtract(by.mass, form.stiffness, slope.stiffness);
    products_.subtract(by.mass, form.damping, slope.damping);
    products_.subtract(by.mass, form.inputs, slope.inputs);
    return slope;
  }

  SecondOrderForm by_damping(Drive::Kind kind, Index j) const {
    const MatrixXd none = MatrixXd::Zero(mass_.rows(), mass_.cols());
    SecondOrderForm slope{none, none, MatrixXd::Zero(inputs_.rows(), inputs_.cols()), {}};
    if (kind == Drive::Kind::mass_damping) slope.damping = mass_;
    if (kind == Drive::Kind::stiffness_damping) slope.damping = stiffness_;
    for (std::size_t i = 0; i < modes_.size() && kind == Drive::Kind::damping_ratio; ++i)
      if (given_.damped_modes[i].unknown == j)
        products_.add_outer(modes_[i].by_ratio * modes_[i].momentum, modes_[i].momentum, slope.damping);
    return slope;
  }

  SecondOrderForm by_mass(SecondOrderForm form) const {
    for (MatrixXd* matrix : {&form.stiffness, &form.damping, &form.inputs})
      if (products_.of_diagonals)
        *matrix = mass_.col(0).cwiseInverse().asDiagonal() * *matrix;
      else if (matrix->cols() > 0)
        factor_.solveInPlace(*matrix);
    return form;
  }
};

void make_square(SecondOrderForm& form) {
  for (MatrixXd* matrix : {&form.stiffness, &form.damping}) *matrix = MatrixXd(matrix->col(0).asDiagonal());
}

}  // namespace

std::vector<DampedMode> damped_modes(const ReducedEquations& equations) {
  const Index r = equations.mass.size();
  const auto a = static_cast<Index>(equations.derivatives.size());
  std::vector<DampedMode> modes;
  for (Index i = 0; i < r; ++i) {
    if (equations.stiffness[i] <= 0.0) continue;
    const double scale = 1.0 / std::sqrt(equations.mass[i]);  // phi = scale e_i
    DampedMode mode;
    mode.momentum = VectorXd::Unit(r, i) * (equations.mass[i] * scale);
    mode.momentum_slopes.resize(r, a);
    mode.mass_slopes.resize(a);
    mode.stiffness_slopes.resize(a);
    mode.stiffness = equations.stiffness[i] / equations.mass[i];
    for (Index j = 0; j < a; ++j) {
      const ReducedEquations::Derivative& slope = equations.derivatives[static_cast<std::size_t>(j)];
      mode.momentum_slopes.col(j) = scale * slope.mass.col(i);
      mode.mass_slopes[j] = slope.mass(i, i) / equations.mass[i];
      mode.stiffness_slopes[j] = slope.stiffness(i, i) / equations.mass[i];
    }
    modes.push_back(mode);
  }
  return modes;
}

ReducedMotion::ReducedMotion(ReducedEquations equations, MotionDescription description, MatrixXd rows,
                             std::string name)
    : SecondOrderMotion(std::move(description), std::move(rows), std::move(name)),
      equations_(std::move(equations)) {
  const VectorXd omega = frequencies();
  const VectorXd rate = equations_.mass.cwiseProduct(omega);
  decoupled_ = is_diagonal(equations_.damping, rate);
  for (const ReducedEquations::Derivative& slope : equations_.derivatives)
    decoupled_ = decoupled_ && is_diagonal(slope.mass, slope.mass.diagonal().cwiseAbs()) &&
                 is_diagonal(slope.stiffness, slope.stiffness.diagonal().cwiseAbs()) &&
                 (slope.damping.size() == 0 || is_diagonal(slope.damping, slope.damping.diagonal()));
  if (!decoupled_) return;
  keep_diagonal(equations_.damping);
  for (ReducedEquations::Derivative& slope : equations_.derivatives) {
    keep_diagonal(slope.mass);
    keep_diagonal(slope.stiffness);
    if (slope.damping.size() > 0) keep_diagonal(slope.damping);
  }
}

VectorXd ReducedMotion::frequencies() const {
  VectorXd omega = (equations_.stiffness.array() / equations_.mass.array()).cwiseMax(0.0).sqrt();
  const double largest = omega.maxCoeff();
  return omega.cwiseMax(largest > 0.0 ? 1e-3 * largest : 1.0);
}

void ReducedMotion::evaluate(const VectorXd& state, SecondOrderForm& form,
                             std::vector<SecondOrderForm>* slopes) const {
  const Evaluation here(equations_, decoupled_, description(),
                        physical_values(description(), layout(), state));
  form = here.form();
  if (slopes) {
    slopes->resize(description().unknowns.size());
    for (std::size_t j = 0; j < slopes->size(); ++j) (*slopes)[j] = here.slope(form, static_cast<Index>(j));
  }
  if (!decoupled_) return;
  make_square(form);
  if (slopes)
    for (SecondOrderForm& slope : *slopes) make_square(slope);
}

}  // namespace beamid::experiments
