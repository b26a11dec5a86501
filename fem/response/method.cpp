#include "fem/response/method.hpp"

#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "fem/modes.hpp"

namespace beamid::fem {

using Eigen::Index, Eigen::VectorXd;

void require_option(const std::string& method, const ResponseOptions& options, const std::string& option,
                    double low, double high, const std::string& expected) {
  const double value = options.at(option);
  if (value >= low && value <= high) return;
  std::ostringstream message;
  message << method << ": option '" << option << "' is " << value << "; expected " << expected;
  throw std::invalid_argument(message.str());
}

ResponseRecorder::ResponseRecorder(const ResponseProblem& problem) : outputs_(problem.system.outputs) {
  const Index samples = problem.grid.samples, outputs = outputs_.rows(), n = problem.system.size();
  response_.time.resize(samples);
  for (Index k = 0; k < samples; ++k) response_.time[k] = problem.time(k);
  for (Eigen::MatrixXd* history : {&response_.displacement, &response_.velocity, &response_.acceleration})
    history->resize(outputs, samples);
  response_.frames = problem.grid.frames;
  const auto frames = static_cast<Index>(response_.frames.size());
  for (Eigen::MatrixXd* field :
       {&response_.field_displacement, &response_.field_velocity, &response_.field_acceleration})
    field->resize(n, frames);
}

void ResponseRecorder::record(Index sample, const VectorXd& q, const VectorXd& velocity,
                              const VectorXd& acceleration) {
  response_.displacement.col(sample).noalias() = outputs_ * q;
  response_.velocity.col(sample).noalias() = outputs_ * velocity;
  response_.acceleration.col(sample).noalias() = outputs_ * acceleration;
  if (wants_frame(sample)) keep_frame(q, velocity, acceleration);
}

void ResponseRecorder::keep_frame(const VectorXd& q, const VectorXd& velocity, const VectorXd& acceleration) {
  const auto frame = static_cast<Index>(next_frame_++);
  response_.field_displacement.col(frame) = q;
  response_.field_velocity.col(frame) = velocity;
  response_.field_acceleration.col(frame) = acceleration;
}

ProportionalDamping direct_damping(const ResponseProblem& problem, const std::string& method) {
  try {
    const ProportionalDamping law = proportional_coefficients(problem.damping);
    if (law.mass < 0.0) damping_ratios(problem.damping, modes(problem.system, 1).angular_frequency);
    if (law.stiffness < 0.0) {
      std::ostringstream message;
      message << name(problem.damping) << " damping: modes above "
              << std::sqrt(-law.mass / law.stiffness) / (2.0 * std::numbers::pi)
              << " Hz would have a negative damping ratio; expected anchors that let it rise with frequency";
      throw std::invalid_argument(message.str());
    }
    return law;
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(method + ": " + error.what());
  }
}

}  // namespace beamid::fem
