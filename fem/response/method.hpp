// What a response method is given, and how it makes itself known.
#pragma once

#include <functional>
#include <string>

#include "fem/response/response.hpp"

namespace beamid::fem {

/// A checked problem: sizes agree, absent initial values are zeros.
struct ResponseProblem {
  const StructuralSystem& system;
  const DampingLaw& damping;
  const TimeGrid& grid;
  Eigen::VectorXd displacement, velocity;  ///< at t = 0 (n)
  const Eigen::MatrixXd& inputs;           ///< f (m x N), or empty

  bool has_inputs() const { return inputs.size() > 0; }
  double time(Eigen::Index sample) const { return static_cast<double>(sample) * grid.interval; }
};

/// Every option of the method, by name.
using ResponseOptions = std::map<std::string, double>;

using ResponseFunction = std::function<Response(const ResponseProblem&, const ResponseOptions&)>;

/// A method's file ends with one line that registers it:
///
///     const bool registered = register_response_method({"newmark", "average acceleration", ...}, newmark);
bool register_response_method(ResponseMethodDescription description, ResponseFunction function);

/// @throws std::invalid_argument "newmark: option 'beta' is -1; expected ..." unless low <= value <= high.
void require_option(const std::string& method, const ResponseOptions& options, const std::string& option,
                    double low, double high, const std::string& expected);

/// Collects the motion, sample after sample.
class ResponseRecorder {
 public:
  explicit ResponseRecorder(const ResponseProblem& problem);

  /// @param q, velocity, acceleration whole motion (n) at `sample`, which counts up from 0.
  void record(Eigen::Index sample, const Eigen::VectorXd& q, const Eigen::VectorXd& velocity,
              const Eigen::VectorXd& acceleration);

  /// Whether the field at `sample` is to be kept.
  bool wants_frame(Eigen::Index sample) const {
    return next_frame_ < response_.frames.size() && response_.frames[next_frame_] == sample;
  }
  void keep_frame(const Eigen::VectorXd& q, const Eigen::VectorXd& velocity,
                  const Eigen::VectorXd& acceleration);

  Response& response() { return response_; }

 private:
  Eigen::SparseMatrix<double, Eigen::RowMajor> outputs_;
  Response response_;
  std::size_t next_frame_ = 0;
};

// Damping in methods that integrate the equations as they are.

/// alpha and beta of the law.
/// @throws std::invalid_argument, naming the method, when the law has no sparse matrix or lets the first
/// mode, or modes of high frequency, gain energy.
ProportionalDamping direct_damping(const ResponseProblem& problem, const std::string& method);

}  // namespace beamid::fem
