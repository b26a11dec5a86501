// A density to draw from that has all humps of a posterior: Student's t distributions.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "experiments/identify/posterior/likelihood.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {

// The separate maxima of a posterior density.

/// A maximum of ln L(u) - u^2 / 2 and the normal density that osculates it (Laplace).
struct Hump {
  Eigen::VectorXd top;         ///< u (q)
  double log_density = 0.0;    ///< there, of L(u) N(u; 0, 1)
  Eigen::MatrixXd covariance;  ///< (J^T J + 1)^-1 (q x q)
  double log_mass = 0.0;       ///< Laplace's: log_density + ln sqrt(det 2 pi covariance)
};

/// ln L(u) + ln N(u; 0, 1).
double posterior_log(const LikelihoodValue& value, const Eigen::VectorXd& u);

/// Where damped Newton steps from the starts (q x n) end, on all cores: those that differ, are worth at least
/// a millionth of the best by Laplace, and have a valley between them on the straight line, of half a nat at
/// least. The heaviest first.
std::vector<Hump> separate_humps(const Likelihood& likelihood, const Eigen::MatrixXd& starts);

class HumpMixture {
 public:
  static constexpr double freedom = 6.0;  ///< of the t distributions, whose tails outlast a normal's

  struct Part {
    double share = 0.0;
    Eigen::VectorXd centre;
    Eigen::LLT<Eigen::MatrixXd> root;  ///< of the scale matrix
  };

  /// Laplace's normal densities, with their masses.
  explicit HumpMixture(const std::vector<Hump>& humps);

  std::size_t size() const { return parts_.size(); }
  const Part& part(std::size_t hump) const { return parts_[hump]; }
  /// @param weights (n) of draws (q x n): moves the part to their mean and covariance, where enough of them
  /// count.
  void adapt(std::size_t hump, double share, const Eigen::MatrixXd& draws, const Eigen::VectorXd& weights);

  Eigen::VectorXd draw(std::size_t hump, filters::RandomStream& random) const;
  Eigen::VectorXd draw(filters::RandomStream& random) const;
  double log_density(const Eigen::VectorXd& u) const;
  double even_log_density(const Eigen::VectorXd& u) const;  ///< of the parts in equal shares
  /// The hump to which a place belongs: that of the largest share there.
  std::size_t hump(const Eigen::VectorXd& u) const;

 private:
  std::vector<Part> parts_;
  double mixed_log(const Eigen::VectorXd& u, bool even) const;
  double part_log(const Part& part, const Eigen::VectorXd& u) const;
};

// Evidence and the humps' weights by importance sampling.

struct ImportanceSample {
  double log_evidence = 0.0, standard_error = 0.0;  ///< [nat]
  std::vector<double> share;                        ///< of each hump, by their masses
  double effective_share = 0.0;  ///< effective draws over those made: 1 where the mixture is the posterior
  std::size_t evaluations = 0;
  /// Too few draws count for the numbers above to be relied upon.
  bool poor() const { return effective_share < 0.05; }
};

/// As many draws from each part of the mixture, weighted by L N / mixture (all parts of it), two rounds of
/// which move the parts to the humps' means and covariances [cappe2008]. The draws of a last round, which
/// moves nothing, count.
ImportanceSample importance_sample(const Likelihood& likelihood, HumpMixture& mixture, std::size_t draws,
                                   std::uint64_t seed);

}  // namespace beamid::experiments
