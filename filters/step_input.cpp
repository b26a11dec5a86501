#include "filters/step_input.hpp"

#include <stdexcept>
#include <string>

namespace beamid::filters {

using Eigen::Index, Eigen::VectorXd;

StepInput::StepInput(const VectorXd& path, Index inputs)
    : path_(path),
      inputs_(path.size() == 0 ? 0
              : inputs > 0     ? inputs
                               : path.size()) {
  if (inputs_ == 0) return;
  degree_ = path.size() / inputs_ - 1;
  if (degree_ < 0 || degree_ > highest_degree || path.size() % inputs_ != 0)
    throw std::invalid_argument("the input of a step has " + std::to_string(path.size()) +
                                " entries; expected 1 to 5 times the model's " + std::to_string(inputs_));
}

VectorXd StepInput::at(double s) const {
  VectorXd value = VectorXd::Zero(inputs_);
  for (Index j = degree_; j >= 0; --j) value = s * value + coefficient(j);
  return value;
}

VectorXd StepInput::mean() const {
  if (inputs_ == 0) return {};
  VectorXd value = coefficient(0);
  for (Index j = 1; j <= degree_; ++j) {
    const double bend = j == 1 ? 0.0 : static_cast<double>(j) / 12.0;
    value += (0.5 - bend) * coefficient(j);
  }
  return value;
}

VectorXd StepInput::slope() const {
  VectorXd value = VectorXd::Zero(inputs_);
  for (Index j = 1; j <= degree_; ++j) value += coefficient(j);
  return value;
}

}  // namespace beamid::filters
