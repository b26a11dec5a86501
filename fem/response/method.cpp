#include "fem/response/method.hpp"

#include <sstream>
#include <stdexcept>

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

}  // namespace beamid::fem
