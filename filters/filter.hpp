// Bayesian filters: a belief moved by a model and corrected by measurements.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "filters/discrete_model.hpp"
#include "filters/gaussian.hpp"
#include "filters/registry.hpp"

namespace beamid::filters {

/// What one measurement said.
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
  virtual ~Filter() = default;

  /// Start from a belief. @throws std::invalid_argument when its size is not the model's.
  virtual void reset(const Gaussian& belief) = 0;
  /// z_k | y_0..k  ->  z_k+1 | y_0..k under the input u_k (m). @throws FilterFailure
  virtual void predict(const Eigen::VectorXd& input) = 0;
  /// z_k | y_0..k-1  ->  z_k | y_0..k, given y_k (p). @throws FilterFailure
  virtual const Correction& correct(const Eigen::VectorXd& output, const Eigen::VectorXd& input) = 0;

  /// Valid until the next step; a filter that carries a factor may form it only now.
  virtual const Gaussian& belief() const = 0;
  /// The belief about some entries of the state alone, as cheaply as the filter can tell it.
  virtual Gaussian marginal(const std::vector<Eigen::Index>& entries) const;
  virtual const DiscreteModel& model() const = 0;

  /// What a reader of the result should know, in words: approximations made, and what they cost.
  virtual std::vector<std::string> remarks() const { return {}; }
};

/// Contracts a filter may declare; the conformance tests hold it to them.
namespace contract {
inline constexpr const char* exact_on_linear_gaussian =
    "exact_on_linear_gaussian";                          ///< equals the Kalman filter
inline constexpr const char* consistent = "consistent";  ///< its covariance is that of its errors
}  // namespace contract

using FilterRegistry = Registry<Filter, std::unique_ptr<DiscreteModel>>;
FilterRegistry& filter_registry();

}  // namespace beamid::filters
