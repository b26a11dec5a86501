#include "experiments/models/motion/supported_motion.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

namespace beamid::experiments {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

SupportedMotion::SupportedMotion(SupportedEquations equations, MotionDescription description, MatrixXd rows,
                                 VectorXd frequencies)
    : SecondOrderMotion(std::move(description), std::move(rows), "place"),
      equations_(std::move(equations)),
      frequencies_(std::move(frequencies)) {}

// W = M^-1 K and the like; a derivative by p_j is M^-1 (K_j - M_j W).
void SupportedMotion::evaluate(const VectorXd& state, SecondOrderForm& form,
                               std::vector<SecondOrderForm>* slopes) const {
  const MotionDescription& given = description();
  const PhysicalValues at = physical_values(given, layout(), state);
  const Index inside = equations_.inside();
  MatrixXd mass = equations_.mass, stiffness = equations_.stiffness, damping = equations_.damping,
           inputs = equations_.inputs;
  for (Index j = 0; j < given.properties(); ++j) {
    const auto& slope = equations_.derivatives[static_cast<std::size_t>(j)];
    mass += at.change[j] * slope.mass;
    stiffness += at.change[j] * slope.stiffness;
    damping += at.change[j] * slope.damping;
    inputs += at.change[j] * slope.inputs;
  }
  damping.topRows(inside) +=
      at.mass_damping * mass.topRows(inside) + at.stiffness_damping * stiffness.topRows(inside);
  std::vector<ModeDamping> modes;
  for (std::size_t i = 0; i < given.damped_modes.size(); ++i) {
    modes.push_back(damping_at(given.damped_modes[i], at.change, at.ratios[static_cast<Index>(i)]));
    const VectorXd& g = modes.back().momentum;
    damping.topLeftCorner(inside, inside).noalias() += (modes.back().factor * g) * g.transpose();
  }
  const Eigen::PartialPivLU<MatrixXd> factor(mass);
  if (!(factor.rcond() > 1e-14)) throw std::runtime_error("the parameters make a place without mass");
  form.stiffness = factor.solve(stiffness);
  form.damping = factor.solve(damping);
  form.inputs = factor.solve(inputs);
  if (!slopes) return;

  slopes->resize(given.unknowns.size());
  for (std::size_t j = 0; j < given.unknowns.size(); ++j) {
    const Drive& drive = given.drives[j];
    SecondOrderForm& slope = (*slopes)[j];
    slope.stiffness.setZero(mass.rows(), mass.cols());
    slope.damping.setZero(mass.rows(), mass.cols());
    slope.inputs.setZero(inputs.rows(), inputs.cols());
    auto damping_inside = slope.damping.topLeftCorner(inside, inside);
    if (drive.kind == Drive::Kind::property) {
      const auto& by = equations_.derivatives[static_cast<std::size_t>(drive.index)];
      slope.stiffness = by.stiffness - by.mass * form.stiffness;
      slope.damping = by.damping + at.mass_damping * by.mass + at.stiffness_damping * by.stiffness -
                      by.mass * form.damping;
      slope.inputs = by.inputs - by.mass * form.inputs;
      for (std::size_t i = 0; i < modes.size(); ++i) {
        const VectorXd& g = modes[i].momentum;
        const VectorXd turn = given.damped_modes[i].momentum_slopes.col(drive.index);
        damping_inside.noalias() += (modes[i].by_property[drive.index] * g) * g.transpose();
        damping_inside.noalias() += (modes[i].factor * turn) * g.transpose();
        damping_inside.noalias() += (modes[i].factor * g) * turn.transpose();
      }
    }
    if (drive.kind == Drive::Kind::mass_damping) slope.damping.topRows(inside) = mass.topRows(inside);
    if (drive.kind == Drive::Kind::stiffness_damping)
      slope.damping.topRows(inside) = stiffness.topRows(inside);
    for (std::size_t i = 0; i < modes.size() && drive.kind == Drive::Kind::damping_ratio; ++i)
      if (given.damped_modes[i].unknown == static_cast<Index>(j))
        damping_inside.noalias() += (modes[i].by_ratio * modes[i].momentum) * modes[i].momentum.transpose();
    for (MatrixXd* const matrix : {&slope.stiffness, &slope.damping, &slope.inputs})
      *matrix = at.slopes[static_cast<Index>(j)] * factor.solve(*matrix);
  }
}

}  // namespace beamid::experiments
