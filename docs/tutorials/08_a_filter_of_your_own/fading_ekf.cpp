// Extended Kalman filter with a fading memory: the covariance is inflated on its way from sample to sample,
//
//     P- = e^(dt / T) F P F^T + Q
//
// so that a reading counts e^(-s / T) of a new one after s seconds. What changes slowly is followed, and what
// stays constant is known to no more than the last T seconds tell: of a constant read directly,
// P+ tends to R (1 - e^(-dt / T)).
#include <beamid/filters.hpp>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

namespace {

using namespace beamid::filters;
using Eigen::MatrixXd, Eigen::VectorXd;

class FadingMemoryFilter final : public Filter {
 public:
  FadingMemoryFilter(std::unique_ptr<DiscreteModel> model, double memory)
      : Filter(std::move(model)), memory_(memory) {
    if (!(memory > 0.0))
      throw std::invalid_argument("fading_ekf: memory is " + std::to_string(memory) +
                                  " s; expected more than 0");
  }

  void reset(const Gaussian& estimate) override {
    estimate_ = as_matrix(estimate, model_);  // checked against the model
  }

  void predict(const VectorXd& input) override {
    model_.linearised_transition(estimate_.mean, input, next_, tangent_);
    estimate_.mean.swap(next_);
    estimate_.covariance *= std::exp(model_.interval() / memory_);
    step_.predict(estimate_, tangent_, model_.process_noise());
  }

  void take_in(const VectorXd& output, const VectorXd& input) override {
    model_.output(estimate_.mean, input, expected_);
    model_.output_jacobian(estimate_.mean, input, sensor_);
    correction_.innovation = output - expected_;
    step_.correct(estimate_, sensor_, model_.output_noise(), correction_);
  }

  const Gaussian& estimate() const override { return estimate_; }

 private:
  double memory_;  // T [s]
  Gaussian estimate_;
  LinearisedStep step_;  // Joseph's form: the covariance stays symmetric and positive
  VectorXd next_, expected_;
  MatrixXd tangent_, sensor_;
};

const bool registered = filter_registry().add(
    {"fading_ekf",
     "extended Kalman filter that forgets old readings",
     "H. W. Sorenson, J. E. Sacks: Recursive fading memory filtering. Information Sciences 3 (1971) 101-119",
     {{"memory", 10.0, "s", "after this time a reading counts 1/e of a new one"}},
     {},  // not exact on linear models, and not meant to be
     [](std::unique_ptr<DiscreteModel> model, const Options& options) {
       return std::make_unique<FadingMemoryFilter>(std::move(model), options.number("memory"));
     }});

}  // namespace
