// One part of a driven record beside what a model makes of it, line by line.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <vector>

#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/models/motion/supported_response.hpp"

namespace beamid::experiments {

/// What a model makes of one part of a record from a difference d = x_0 - x_N of its ends (l): W (G_k u_k +
/// what d adds) (p x L).
Eigen::MatrixXcd part_motion(const DrivenProblem& problem, const LinearResponse& response,
                             const RecordLines& part, const Eigen::VectorXd& difference);

/// Every so many lines of a part.
RecordLines thinned(const RecordLines& part, Eigen::Index stride);

/// The residual of one part, the ends of it projected out. Rows are all channels of one line, then those of
/// the next, real parts before imaginary ones.
struct PartAt {
  Eigen::MatrixXcd driven;                           ///< W G_k u_k (p x L)
  Eigen::MatrixXcd moved;                            ///< the same with what d adds (p x L)
  Eigen::VectorXd difference;                        ///< d, as the residual has it (l)
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> ends;  ///< of W Z, columns of one length
  Eigen::VectorXd left;                              ///< (2 p L)

  PartAt(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part);

  /// Without what the ends of the part could make of it.
  void project(Eigen::VectorXd& rows) const;
  /// How the lines of another response with the same d differ from these, likewise (2 p L).
  /// @throws std::runtime_error where it has another number of coordinates.
  Eigen::VectorXd change_to(const DrivenProblem& problem, const LinearResponse& other,
                            const RecordLines& part) const;
};

/// The parts of a problem at any unknowns. The problem outlives it.
class DrivenMotion {
 public:
  explicit DrivenMotion(const DrivenProblem& problem);

  const Eigen::MatrixXd& prior() const { return prior_; }  ///< P_0^-1
  Eigen::VectorXd off(const Eigen::VectorXd& theta) const { return theta - problem_.prior.mean; }

  /// @throws std::runtime_error where nothing moves, or a motion grows
  std::vector<PartAt> at(const Eigen::VectorXd& theta) const;
  /// @throws std::runtime_error likewise
  LinearResponse response(const Eigen::VectorXd& theta) const;
  /// Empty where there is no motion, or none that is finite.
  std::vector<PartAt> tried_at(const Eigen::VectorXd& theta) const;
  double cost(const std::vector<PartAt>& parts, const Eigen::VectorXd& theta) const;  ///< J
  /// d left / d theta of every part, up to its sign.
  std::vector<Eigen::MatrixXd> slopes(const std::vector<PartAt>& parts, const Eigen::VectorXd& theta) const;

 private:
  const DrivenProblem& problem_;
  const filters::LinearMotion& motion_;
  Eigen::MatrixXd prior_;
};

}  // namespace beamid::experiments
