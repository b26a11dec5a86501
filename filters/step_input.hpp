// The inputs of a model between one sample and the next.
#pragma once

#include <Eigen/Core>

namespace beamid::filters {

/// u(t_k + s dt) = sum_j p_j s^j,  0 <= s <= 1, of m inputs over one step, as the vector [p_0; p_1; ...; p_d]
/// (m (d + 1)). p_0 is u_k itself; of degree 0 the inputs are held, of degree 1 they run straight. Paths of
/// records: input_path.hpp.
///
/// Schemes that evaluate the rate take u at their stages. The (2,2) Pade step is Obreshkov's,
/// x+ - x = dt/2 (x' + x'+) - dt^2/12 (x''+ - x''): of the inputs it takes
///
///     mean = (u(0) + u(1)) / 2 - (u'(1) - u'(0)) / 12,   slope = u(1) - u(0),
///
/// so that it moves polynomials up to the degree 4 exactly [hairer1993, ch. II.13].
class StepInput {
 public:
  static constexpr int highest_degree = 4;

  /// @param path which must outlive this; empty: no input
  /// @param inputs m; 0, of a model that does not say: all of the path, held
  /// @throws std::invalid_argument when the path is no multiple of m, or d above the highest degree.
  StepInput(const Eigen::VectorXd& path, Eigen::Index inputs);

  Eigen::Index size() const { return inputs_; }    ///< m; 0 without a path
  Eigen::Index degree() const { return degree_; }  ///< d
  /// p_j (m)
  auto coefficient(Eigen::Index j) const { return path_.segment(j * inputs_, inputs_); }

  Eigen::VectorXd at(double s) const;  ///< u (m)
  Eigen::VectorXd mean() const;        ///< (m)
  Eigen::VectorXd slope() const;       ///< (m)

 private:
  const Eigen::VectorXd& path_;
  Eigen::Index inputs_, degree_ = 0;
};

}  // namespace beamid::filters
