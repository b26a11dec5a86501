#include "experiments/models/motion/second_order_motion.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "experiments/models/motion/second_order_step.hpp"

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

SecondOrderMotion::SecondOrderMotion(MotionDescription description, MatrixXd rows, std::string name)
    : description_(std::move(description)),
      rows_(std::move(rows)),
      name_(std::move(name)),
      layout_(experiments::layout(description_, rows_.cols())) {
  if (rows_.rows() != static_cast<Index>(description_.observations.size()))
    throw std::invalid_argument(fmt::format("{} output rows for {} observations; expected one each",
                                            rows_.rows(), description_.observations.size()));
  for (const Observation& observation : description_.observations) reads(observation.quantity);
}

std::vector<filters::Label> SecondOrderMotion::state_labels() const {
  return experiments::state_labels(description_, layout_, name_);
}

std::vector<filters::Label> SecondOrderMotion::output_labels() const {
  return experiments::output_labels(description_);
}

void SecondOrderMotion::motion_matrix(const VectorXd& state, MatrixXd& matrix) const {
  const Index r = layout_.coordinates;
  SecondOrderForm form;
  evaluate(state, form, nullptr);
  matrix.setZero(layout_.motion, layout_.motion);
  matrix.block(0, r, r, r).setIdentity();
  matrix.block(r, 0, r, r) = -form.stiffness;
  matrix.block(r, r, r, r) = -form.damping;
  for (std::size_t i = 0; i < layout_.drifts.size(); ++i)
    if (layout_.drifts[i] >= 0) matrix(layout_.biases[i], layout_.drifts[i]) = 1.0;
}

void SecondOrderMotion::motion_matrix_derivative(const VectorXd& state, Index j, MatrixXd& matrix) const {
  const Index r = layout_.coordinates;
  matrix.setZero(layout_.motion, layout_.motion);
  if (j >= static_cast<Index>(description_.unknowns.size())) return;  // a constant bias
  SecondOrderForm form;
  std::vector<SecondOrderForm> slopes;
  evaluate(state, form, &slopes);
  matrix.block(r, 0, r, r) = -slopes[static_cast<std::size_t>(j)].stiffness;
  matrix.block(r, r, r, r) = -slopes[static_cast<std::size_t>(j)].damping;
}

void SecondOrderMotion::input_matrix(const VectorXd& state, MatrixXd& matrix) const {
  matrix.setZero(layout_.motion, input_size());
  if (matrix.cols() == 0) return;
  SecondOrderForm form;
  evaluate(state, form, nullptr);
  matrix.middleRows(layout_.coordinates, layout_.coordinates) = form.inputs;
}

void SecondOrderMotion::input_matrix_derivative(const VectorXd& state, Index j, MatrixXd& matrix) const {
  matrix.setZero(layout_.motion, input_size());
  if (matrix.cols() == 0 || j >= static_cast<Index>(description_.unknowns.size())) return;
  SecondOrderForm form;
  std::vector<SecondOrderForm> slopes;
  evaluate(state, form, &slopes);
  matrix.middleRows(layout_.coordinates, layout_.coordinates) = slopes[static_cast<std::size_t>(j)].inputs;
}

void SecondOrderMotion::read(const VectorXd& state, const VectorXd& input, const SecondOrderForm& form,
                             VectorXd& output) const {
  const Index r = layout_.coordinates;
  const auto z = state.head(r), rates = state.segment(r, r);
  const MatrixXd& rows = form.rows.size() > 0 ? form.rows : rows_;
  VectorXd accelerations;
  output.resize(rows.rows());
  for (Index i = 0; i < rows.rows(); ++i) {
    switch (reads(description_.observations[static_cast<std::size_t>(i)].quantity)) {
      case Reads::coordinates:
        output[i] = rows.row(i).dot(z);
        break;
      case Reads::rates:
        output[i] = rows.row(i).dot(rates);
        break;
      case Reads::accelerations:
        if (accelerations.size() == 0) {
          accelerations = -(form.stiffness * z + form.damping * rates);
          if (input.size() > 0) accelerations += form.inputs * input.head(form.inputs.cols());
        }
        output[i] = rows.row(i).dot(accelerations);
        if (description_.carried.size() > 0 && input.size() > 0)
          output[i] += description_.carried.row(i).dot(input.head(input_size()));
        if (const Index bias = layout_.biases[static_cast<std::size_t>(i)]; bias >= 0)
          output[i] += state[bias];
        break;
    }
  }
}

void SecondOrderMotion::read_jacobian(const VectorXd& state, const VectorXd& input,
                                      const SecondOrderForm& form, const std::vector<SecondOrderForm>& slopes,
                                      MatrixXd& jacobian) const {
  const Index r = layout_.coordinates;
  const auto z = state.head(r), rates = state.segment(r, r);
  const MatrixXd& rows = form.rows.size() > 0 ? form.rows : rows_;
  MatrixXd by_unknowns;
  jacobian.setZero(rows.rows(), layout_.size);
  for (Index i = 0; i < rows.rows(); ++i) {
    switch (reads(description_.observations[static_cast<std::size_t>(i)].quantity)) {
      case Reads::coordinates:
        jacobian.row(i).head(r) = rows.row(i);
        break;
      case Reads::rates:
        jacobian.row(i).segment(r, r) = rows.row(i);
        break;
      case Reads::accelerations:
        if (by_unknowns.size() == 0 && !slopes.empty()) {
          by_unknowns.resize(r, static_cast<Index>(slopes.size()));
          for (std::size_t j = 0; j < slopes.size(); ++j) {
            auto column = by_unknowns.col(static_cast<Index>(j));
            column.noalias() = -(slopes[j].stiffness * z);
            column.noalias() -= slopes[j].damping * rates;
            if (input.size() > 0) column.noalias() += slopes[j].inputs * input.head(input_size());
          }
        }
        jacobian.row(i).head(r).noalias() = -(rows.row(i) * form.stiffness);
        jacobian.row(i).segment(r, r).noalias() = -(rows.row(i) * form.damping);
        if (!slopes.empty())
          jacobian.row(i).segment(layout_.unknowns, by_unknowns.cols()).noalias() = rows.row(i) * by_unknowns;
        if (const Index bias = layout_.biases[static_cast<std::size_t>(i)]; bias >= 0)
          jacobian(i, bias) = 1.0;
        break;
    }
  }
  if (form.rows.size() == 0 || slopes.empty()) return;
  VectorXd accelerations = -(form.stiffness * z + form.damping * rates);
  if (input.size() > 0) accelerations += form.inputs * input.head(form.inputs.cols());
  for (Index i = 0; i < rows.rows(); ++i)
    for (std::size_t j = 0; j < slopes.size(); ++j) {
      const auto turned = slopes[j].rows.row(i);
      double& entry = jacobian(i, layout_.unknowns + static_cast<Index>(j));
      switch (reads(description_.observations[static_cast<std::size_t>(i)].quantity)) {
        case Reads::coordinates:
          entry += turned.dot(z);
          break;
        case Reads::rates:
          entry += turned.dot(rates);
          break;
        case Reads::accelerations:
          entry += turned.dot(accelerations);
          break;
      }
    }
}

void SecondOrderMotion::output(const VectorXd& state, const VectorXd& input, VectorXd& output) const {
  SecondOrderForm form;
  evaluate(state, form, nullptr);
  read(state, input, form, output);
}

void SecondOrderMotion::output_jacobian(const VectorXd& state, const VectorXd& input,
                                        MatrixXd& jacobian) const {
  SecondOrderForm form;
  std::vector<SecondOrderForm> slopes;
  evaluate(state, form, &slopes);
  read_jacobian(state, input, form, slopes, jacobian);
}

std::unique_ptr<filters::DiscreteModel> SecondOrderMotion::structured(double dt, const std::string& scheme,
                                                                      const filters::Noise& noise) const {
  return second_order_step(copy(), dt, scheme, noise);
}

namespace {

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
      throw std::runtime_error("the parameters make a mode without mass");
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
