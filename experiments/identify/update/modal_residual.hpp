// How far predicted modes are from measured ones, in standard deviations.
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "experiments/identify/update/mode_pairing.hpp"
#include "experiments/modal/modal_data.hpp"

namespace beamid::experiments {

// What least squares makes small, in the coordinates of a search.

// The coordinates in which parameters are searched for.

/// x = ln(p / guess) of positive quantities, whose frequencies depend on ratios; x = (p - guess) / scale of
/// an axial load or of a guess of zero. A box keeps the search within bounds that are stated, or within a
/// factor of 1e4 where none are.
class SearchSpace {
 public:
  explicit SearchSpace(const AskedParameters& asked);
  /// @param likely from, to (q): where the starts are drawn, in place of all that the bounds allow
  SearchSpace(const AskedParameters& asked, const std::vector<std::pair<double, double>>& likely);

  Eigen::Index size() const { return lower_.size(); }
  const Eigen::VectorXd& lower() const { return lower_; }  ///< of x (q)
  const Eigen::VectorXd& upper() const { return upper_; }
  bool stated(Eigen::Index j) const { return stated_[static_cast<std::size_t>(j)]; }  ///< bounds of p_j
  bool logarithmic(Eigen::Index j) const { return logarithmic_[static_cast<std::size_t>(j)]; }

  /// That a step is not to exceed (q): 1 of a logarithm; where bounds are much wider than what is likely, a
  /// fifth of them.
  const Eigen::VectorXd& longest_step() const { return longest_step_; }

  Eigen::VectorXd physical(const Eigen::VectorXd& x) const;
  Eigen::VectorXd slope(const Eigen::VectorXd& x) const;  ///< dp/dx (q)
  Eigen::VectorXd place(const Eigen::VectorXd& values) const;

  /// A start: number 0 is the guess, the others are drawn evenly in x between the bounds stated, or within a
  /// factor of 5 of the guess.
  Eigen::VectorXd start(std::size_t number) const;

 private:
  Eigen::VectorXd guess_, scale_, lower_, upper_, from_, to_, longest_step_;
  std::vector<bool> logarithmic_, stated_;
};

/// r(x) in standard deviations, of one structure or of several that share the parameters.
class FitResidual {
 public:
  struct Value {
    Eigen::VectorXd residual;         ///< (r)
    Eigen::MatrixXd jacobian;         ///< dr/dx (r x q); empty unless asked for
    std::vector<Eigen::Index> pairs;  ///< of one structure: the predicted mode of each measured one
    PredictedModes modes;             ///< likewise
    std::vector<Value> parts;         ///< of several structures: each one's pairs and modes
    double chi_square() const { return residual.squaredNorm(); }
  };
  virtual ~FitResidual() = default;

  /// @throws std::runtime_error when there are no such modes.
  virtual Value at(const Eigen::VectorXd& x, bool jacobian) const = 0;
  /// Numbers that are independent: a shape has as many as its components less those of the space.
  virtual Eigen::Index independent(const Value& value) const = 0;
  virtual const ModesOfParameters& model() const = 0;  ///< of several structures the first one's
  virtual const SearchSpace& space() const = 0;
};

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
