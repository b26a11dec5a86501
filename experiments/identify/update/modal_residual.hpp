// How far predicted modes are from measured ones, in standard deviations.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/identify/update/fit_residual.hpp"
#include "experiments/modal/modal_data.hpp"

namespace beamid::experiments {

/// What a model is trusted to, beside what was measured: standard deviations.
struct ModelTrust {
  double frequency = 0.005;  ///< of a predicted frequency, a part of it
  double shape = 0.03;       ///< of a predicted shape's component, a part of the largest
};

/// r(x), one number for each frequency, for each component of each shape, and for each prior stated:
///
///     (f(x) - f) / s_f,    (I - S S^+) psi / s_psi,    (eta(p) - eta(guess)) / s_eta
///
/// S holds the predicted shape at the sensors; of close modes all of theirs, since only the space that they
/// span is determined. The scale and sign of a shape do not matter: |r|^2 = |psi|^2 (1 - MAC) / s_psi^2. The
/// prior is one of the parameter's own form: of p, of ln p.
class ModalResidual final : public FitResidual {
 public:
  /// Both must outlive it. @throws std::invalid_argument when there are more modes than the model has.
  ModalResidual(const ModesOfParameters& model, const SearchSpace& space, const ModalData& data,
                ModelTrust trust);

  Value at(const Eigen::VectorXd& x, bool jacobian) const override;
  Eigen::Index independent(const Value& value) const override;

  Eigen::Index size() const { return size_; }  ///< r
  Eigen::Index measured() const;               ///< the first of them, without priors
  double frequency_deviation(std::size_t mode) const { return frequency_deviation_[mode]; }  ///< [Hz]
  double shape_deviation(std::size_t mode) const { return shape_deviation_[mode]; }
  const ModalData& data() const { return data_; }
  const ModesOfParameters& model() const override { return model_; }
  const SearchSpace& space() const override { return space_; }
  const ModelTrust& trust() const { return trust_; }

 private:
  const ModesOfParameters& model_;
  const SearchSpace& space_;
  ModalData data_;
  ModelTrust trust_;
  std::vector<double> frequency_deviation_, shape_deviation_;
  Eigen::Index size_ = 0;

  void add_shape(std::size_t mode, Eigen::Index row, const Eigen::VectorXd& slopes, Value& value) const;
  void add_priors(const Eigen::VectorXd& values, Eigen::Index row, const Eigen::VectorXd& slopes,
                  Value& value) const;
};

}  // namespace beamid::experiments
