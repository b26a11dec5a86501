#include "experiments/models/banded/continuum_step.hpp"

#include <numbers>

#include "experiments/models/banded/banded_step.hpp"
#include "filters/step_input.hpp"
#include "filters/timed_model.hpp"

namespace beamid::experiments {

using banded::BandedEquations, banded::BandedStep, banded::ContinuumSensors;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

namespace {

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

}  // namespace

std::unique_ptr<filters::DiscreteModel> continuum_step(std::shared_ptr<const ContinuumMotion::Parts> parts,
                                                       double dt, const filters::Noise& noise) {
  return std::make_unique<ContinuumStep>(std::move(parts), dt, noise);
}

}  // namespace beamid::experiments
