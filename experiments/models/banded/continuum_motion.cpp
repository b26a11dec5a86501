#include "experiments/models/banded/continuum_motion.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/SparseCholesky>

#include "experiments/models/banded/banded_step.hpp"
#include "experiments/models/banded/continuum_sensors.hpp"
#include "filters/discrete_model.hpp"
#include "filters/observed_model.hpp"
#include "filters/step_input.hpp"

namespace beamid::experiments {
// The continuum in steps of the scheme `pade`, as filters take it.

struct ContinuumMotion::Parts {
  fem::ParametricSystem system;
  MotionDescription description;
  std::string name;
  StateLayout layout;
  banded::BandedEquations equations;
  banded::ContinuumSensors sensors;

  Parts(fem::ParametricSystem given, MotionDescription meant, std::string called)
      : system(std::move(given)),
        description(std::move(meant)),
        name(std::move(called)),
        layout(experiments::layout(description, system.system.size())),
        equations(system, description),
        sensors(system, description, layout) {}
};

namespace {

using banded::BandedEquations, banded::BandedStep, banded::ContinuumSensors;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

class ContinuumStep final : public filters::TimedModel {
 public:
  ContinuumStep(std::shared_ptr<const ContinuumMotion::Parts> parts, double dt, filters::Noise noise)
      : TimedModel(dt, std::move(noise)),
        parts_(std::move(parts)),
        equations_(parts_->equations),
        sensors_(parts_->sensors),
        step_(equations_, dt),
        forcings_(parts_->description.unknowns.size()) {}

  std::vector<filters::Label> state_labels() const override {
    return experiments::state_labels(parts_->description, parts_->layout, parts_->name);
  }
  std::vector<filters::Label> output_labels() const override {
    return experiments::output_labels(parts_->description);
  }

  void transition(const VectorXd& state, const VectorXd& input, VectorXd& next) override {
    set(state);
    if (!factored_) step_.factor(equations_);
    factored_ = true;
    const Index n = parts_->layout.coordinates;
    next = state;
    take(input);
    step_.advance(equations_, state.data(), state.data() + n,
                  {equations_.force(real_), equations_.force(imaginary_)}, next.data(), next.data() + n);
    const StateLayout& places = parts_->layout;
    for (std::size_t i = 0; i < places.drifts.size(); ++i)
      if (places.drifts[i] >= 0) next[places.biases[i]] += interval() * state[places.drifts[i]];
  }

  void move(const VectorXd& state, const VectorXd& input, VectorXd& next, MatrixXd& directions) override {
    transition(state, input, next);
    const StateLayout& places = parts_->layout;
    parts_of_unknowns_ = directions.middleRows(places.unknowns, values_.slopes.size());
    for (Index u = 0; u < values_.slopes.size(); ++u) {
      parts_of_unknowns_.row(u) *= values_.slopes[u];
      if (!parts_of_unknowns_.row(u).isZero(0.0)) force_by(u, state);
    }
    step_.move(equations_, forcings_, parts_of_unknowns_, directions);
    for (std::size_t i = 0; i < places.drifts.size(); ++i)
      if (places.drifts[i] >= 0)
        directions.row(places.biases[i]) += interval() * directions.row(places.drifts[i]);
  }

  void linearised_transition(const VectorXd& state, const VectorXd& input, VectorXd& next,
                             MatrixXd& jacobian) override {
    jacobian.setIdentity(state.size(), state.size());
    move(state, input, next, jacobian);
  }

  void output(const VectorXd& state, const VectorXd& input, VectorXd& output) override {
    set(state);
    sensors_.output(equations_, state, input, output);
  }
  void output_jacobian(const VectorXd& state, const VectorXd& input, MatrixXd& jacobian) override {
    set(state);
    sensors_.jacobian(equations_, values_.slopes, state, input, jacobian);
  }

 private:
  void interval_changed() override {
    step_ = BandedStep(equations_, interval());
    factored_ = false;
  }

  void set(const VectorXd& state) {
    values_ = physical_values(parts_->description, parts_->layout, state);
    if (!equations_.set(values_)) return;
    sensors_.set(equations_);
    factored_ = false;
  }

  // mean - (3 + i sqrt 3) / 12 slope of the inputs
  void take(const VectorXd& input) {
    const filters::StepInput path(input, static_cast<Index>(parts_->description.forces.size()));
    imaginary_ = path.slope();
    real_ = path.mean() - 0.25 * imaginary_;
    imaginary_ *= -std::numbers::sqrt3 / 12.0;
  }

  void force_by(Index unknown, const VectorXd& state) {
    const Drive& drive = parts_->description.drives[unknown];
    BandedStep::Forcing& forcing = forcings_[unknown];
    const double *const q = state.data(), *const rate = q + parts_->layout.coordinates;
    switch (drive.kind) {
      case Drive::Kind::property:
        step_.by_property(
            equations_, drive.index, q, rate,
            {equations_.force_slope(drive.index, real_), equations_.force_slope(drive.index, imaginary_)},
            forcing);
        break;
      case Drive::Kind::mass_damping:
        step_.by_mass_damping(equations_, forcing);
        break;
      case Drive::Kind::stiffness_damping:
        step_.by_stiffness_damping(equations_, forcing);
        break;
      case Drive::Kind::damping_ratio: {
        std::vector<Index> modes;
        for (std::size_t i = 0; i < parts_->description.damped_modes.size(); ++i)
          if (parts_->description.damped_modes[i].unknown == unknown) modes.push_back(static_cast<Index>(i));
        step_.by_ratio(equations_, modes, forcing);
        break;
      }
    }
  }

  std::shared_ptr<const ContinuumMotion::Parts> parts_;
  BandedEquations equations_;
  ContinuumSensors sensors_;
  BandedStep step_;
  bool factored_ = false;
  PhysicalValues values_;
  MatrixXd parts_of_unknowns_;
  VectorXd real_, imaginary_;
  std::vector<BandedStep::Forcing> forcings_;
};

std::unique_ptr<filters::DiscreteModel> continuum_step(std::shared_ptr<const ContinuumMotion::Parts> parts,
                                                       double dt, const filters::Noise& noise) {
  return std::make_unique<ContinuumStep>(std::move(parts), dt, noise);
}

}  // namespace

using banded::BandedEquations, banded::ContinuumSensors;

ContinuumMotion::ContinuumMotion(fem::ParametricSystem equations, MotionDescription description,
                                 const std::string& name) {
  if (!equations.system.nonlinear_forces.empty())
    throw std::invalid_argument("the system has nonlinear forces; expected a linear one");
  if (description.drives.size() != description.unknowns.size())
    throw std::invalid_argument(std::to_string(description.drives.size()) + " drives for " +
                                std::to_string(description.unknowns.size()) + " unknowns; expected one each");
  parts_ = std::make_shared<const Parts>(std::move(equations), std::move(description), name);
}

ContinuumMotion::~ContinuumMotion() = default;

Index ContinuumMotion::input_size() const {
  return static_cast<Index>(parts_->description.forces.size());
}

std::vector<filters::Label> ContinuumMotion::state_labels() const {
  return experiments::state_labels(parts_->description, parts_->layout, parts_->name);
}

std::vector<filters::Label> ContinuumMotion::output_labels() const {
  return experiments::output_labels(parts_->description);
}

void ContinuumMotion::rate(const VectorXd& state, const VectorXd& input, VectorXd& rate) const {
  BandedEquations equations = parts_->equations;
  equations.set(physical_values(parts_->description, parts_->layout, state));
  const Index n = parts_->layout.coordinates;
  const double *const q = state.data(), *const speed = q + n;
  VectorXd force = VectorXd::Zero(n), product = VectorXd::Zero(n);
  equations.stiffness().add_product(q, force.data());
  equations.stiffness().add_product(speed, product.data());
  force += equations.stiffness_damping() * product;
  equations.dashpots().now().add_product(speed, force.data());
  for (const ModeDamping& mode : equations.mode_dampings())
    force += mode.factor * mode.momentum.dot(state.segment(n, n)) * mode.momentum;
  force = equations.force(input) - force;

  fem::SparseMatrix mass = parts_->system.system.mass;
  for (std::size_t j = 0; j < parts_->system.derivatives.size(); ++j)
    mass += equations.change()[static_cast<Index>(j)] * parts_->system.derivatives[j].mass;
  rate.setZero(state.size());
  rate.head(n) = state.segment(n, n);
  rate.segment(n, n) = Eigen::SimplicialLDLT<fem::SparseMatrix>(mass).solve(force) -
                       equations.mass_damping() * state.segment(n, n);
  for (std::size_t i = 0; i < parts_->layout.drifts.size(); ++i)
    if (parts_->layout.drifts[i] >= 0) rate[parts_->layout.biases[i]] = state[parts_->layout.drifts[i]];
}

void ContinuumMotion::output(const VectorXd& state, const VectorXd& input, VectorXd& output) const {
  BandedEquations equations = parts_->equations;
  ContinuumSensors sensors = parts_->sensors;
  equations.set(physical_values(parts_->description, parts_->layout, state));
  sensors.set(equations);
  sensors.output(equations, state, input, output);
}

void ContinuumMotion::output_jacobian(const VectorXd& state, const VectorXd& input,
                                      MatrixXd& jacobian) const {
  BandedEquations equations = parts_->equations;
  ContinuumSensors sensors = parts_->sensors;
  const PhysicalValues values = physical_values(parts_->description, parts_->layout, state);
  equations.set(values);
  sensors.set(equations);
  sensors.jacobian(equations, values.slopes, state, input, jacobian);
}

std::unique_ptr<filters::DiscreteModel> ContinuumMotion::structured(double dt, const std::string& scheme,
                                                                    const filters::Noise& noise) const {
  if (scheme == "pade") return continuum_step(parts_, dt, noise);
  const Index n = parts_->layout.coordinates;
  if (n <= dense_limit && scheme != "exponential") return nullptr;
  const std::string instead = keeps_mode_shapes(parts_->system, parts_->description)
                                  ? "'pade', or the reduction modal_truncation: these unknowns do not change "
                                    "the mode shapes, so that it is exact for motion in the modes it keeps"
                                  : "'pade', or a reduction";
  throw std::invalid_argument("discretisation '" + scheme +
                              "' would take dense matrices of the whole mesh, " + std::to_string(n) +
                              " coordinates; expected " + instead);
}

namespace {

bool is_zero(const fem::SparseMatrix& matrix) {
  return matrix.nonZeros() == 0 || matrix.norm() == 0.0;
}

}  // namespace

bool keeps_mode_shapes(const fem::ParametricSystem& equations) {
  const fem::StrainFactors& own = equations.system.stiffness;
  const bool same_strains = equations.strain.rows() == own.strain.rows() &&
                            fem::SparseMatrix(equations.strain - own.strain).squaredNorm() == 0.0;
  const fem::SparseMatrix all = same_strains ? own.rigidity : own.assembled();
  for (std::size_t j = 0; j < equations.derivatives.size(); ++j) {
    if (!is_zero(equations.derivatives[j].mass)) return false;
    const fem::SparseMatrix part =
        same_strains ? equations.derivatives[j].rigidity : equations.stiffness_derivative(j);
    // s with D_j = s D, or K_j = s K, to the rounding of both
    const double share = part.cwiseProduct(all).sum() / all.squaredNorm();
    constexpr double rounding = 1e-12;
    if (fem::SparseMatrix(part - share * all).norm() > rounding * part.norm()) return false;
  }
  return true;
}

bool keeps_mode_shapes(const fem::ParametricSystem& equations, const MotionDescription& description) {
  for (const auto& derivative : equations.derivatives)
    if (!is_zero(derivative.damping)) return false;
  return description.forces.empty() && equations.system.nonlinear_forces.empty() &&
         is_zero(equations.system.damping) && keeps_mode_shapes(equations);
}

}  // namespace beamid::experiments
