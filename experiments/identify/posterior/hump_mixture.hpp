// A density to draw from that has all humps of a posterior: Student's t distributions.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "experiments/identify/posterior/humps.hpp"
#include "filters/random.hpp"

namespace beamid::experiments {

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

}  // namespace beamid::experiments
