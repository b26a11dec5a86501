// Bayesian filters: an estimate moved by a model and corrected by measurements.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "filters/gaussian.hpp"
#include "filters/observed_model.hpp"
#include "filters/registry.hpp"

namespace beamid::filters {

/// What one measurement said; p counts the outputs that were measured.
struct Correction {
  Eigen::VectorXd innovation;             ///< y - E[y] (p)
  Eigen::MatrixXd innovation_covariance;  ///< S (p x p)
  Eigen::VectorXd whitened;        ///< L^-1 innovation, S = L L^T: of unit covariance when consistent (p)
  double normalised_square = 0.0;  ///< innovation^T S^-1 innovation: chi-square of p degrees when consistent
  double log_likelihood = 0.0;     ///< log N(innovation; 0, S)
};

/// Numerical trouble inside a filter; the run that meets it adds step and time.
class FilterFailure : public std::runtime_error {
 public:
  FilterFailure(const std::string& reason, double eigenvalue)
      : std::runtime_error(reason), smallest_eigenvalue(eigenvalue) {}
  double smallest_eigenvalue;  ///< of the covariance that failed; NaN when it is not finite
};

/// A filter on one model: p(z_k | y_0 ... y_k) as a Gaussian.
class Filter {
 public:
  explicit Filter(std::unique_ptr<DiscreteModel> model) : model_(std::move(model)) {}
  virtual ~Filter() = default;

  /// Start from an estimate. @throws std::invalid_argument when its size is not the model's.
  virtual void reset(const Gaussian& estimate) = 0;
  /// z_k | y_0..k  ->  z_k+1 | y_0..k under the input u_k (m). @throws FilterFailure
  virtual void predict(const Eigen::VectorXd& input) = 0;
  /// z_k | y_0..k-1  ->  z_k | y_0..k, given y_k (p). Entries that are NaN were not measured: the filter sees
  /// the others alone, and the estimate stays as it is where there are none. @throws FilterFailure
  const Correction& correct(const Eigen::VectorXd& output, const Eigen::VectorXd& input);

  /// Valid until the next step; a filter that carries a factor may form it only now.
  virtual const Gaussian& estimate() const = 0;
  /// The estimate about some entries of the state alone, as cheaply as the filter can tell it.
  virtual Gaussian marginal(const std::vector<Eigen::Index>& entries) const;

  /// Its interval and noise may be set from step to step.
  ObservedModel& model() { return model_; }
  const ObservedModel& model() const { return model_; }

  /// What a reader of the result should know, in words: approximations made, and what they cost.
  virtual std::vector<std::string> remarks() const { return {}; }

 protected:
  /// Of the outputs that the model shows now (p'), all finite, p' > 0; fills correction_.
  virtual void take_in(const Eigen::VectorXd& output, const Eigen::VectorXd& input) = 0;

  ObservedModel model_;
  Correction correction_;

 private:
  Eigen::VectorXd measured_;
};

/// Contracts a filter may declare; the conformance tests hold it to them.
namespace contract {
/// Equals the Kalman filter to 1e-10: the published case, readings that are missing, a run that is split.
inline constexpr const char* exact_on_linear_gaussian = "exact_on_linear_gaussian";
/// Agrees with the Kalman filter on linear models to within the error of its own sampling.
inline constexpr const char* sampled_on_linear_gaussian = "sampled_on_linear_gaussian";
/// Its covariance is that of its errors.
inline constexpr const char* consistent = "consistent";
/// Finds stiffness and damping from a record without noise to six digits.
inline constexpr const char* identifies = "identifies";
/// Outlying readings move its estimate by a few of its deviations at most.
inline constexpr const char* robust = "robust";
/// Refuses models that are not linear, with std::invalid_argument.
inline constexpr const char* linear_models_only = "linear_models_only";
/// Refuses models whose motion is not linear with their constants held, with std::invalid_argument.
inline constexpr const char* linear_motion_only = "linear_motion_only";
}  // namespace contract

using FilterRegistry = Registry<Filter, std::unique_ptr<DiscreteModel>>;
FilterRegistry& filter_registry();

}  // namespace beamid::filters
