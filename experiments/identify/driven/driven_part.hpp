// One part of a driven record beside what a model makes of it, line by line.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <vector>

#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/models/motion/supported_response.hpp"

namespace beamid::experiments {

/// What a model makes of one part of a record, all p channels of one line, then those of the next (p L).
struct PartLines {
  Eigen::MatrixXcd driven;  ///< W G_k u_k (p L x 1)
  Eigen::MatrixXcd added;   ///< W Z_k (p L x c)
};

PartLines part_lines(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part);

/// The residual of one part, the ends of it projected out.
struct PartAt {
  PartLines lines;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> ends;
  Eigen::VectorXd scale, coefficients;  ///< of the columns of Z
  Eigen::VectorXd left;                 ///< (2 p L)

  PartAt(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part);

  /// Without what the ends of the part could make of it.
  void project(Eigen::VectorXd& rows) const;
  /// How other lines differ from these, likewise (2 p L).
  Eigen::VectorXd change_to(const PartLines& others) const;
};

/// The parts of a problem at any unknowns. The problem outlives it.
class DrivenMotion {
 public:
  explicit DrivenMotion(const DrivenProblem& problem);

  const Eigen::MatrixXd& prior() const { return prior_; }  ///< P_0^-1
  Eigen::VectorXd off(const Eigen::VectorXd& theta) const { return theta - problem_.prior.mean; }

  /// @throws std::runtime_error where nothing moves, or a motion grows
  std::vector<PartAt> at(const Eigen::VectorXd& theta) const;
  /// Empty where there is no motion, or none that is finite.
  std::vector<PartAt> tried_at(const Eigen::VectorXd& theta) const;
  double cost(const std::vector<PartAt>& parts, const Eigen::VectorXd& theta) const;  ///< J
  /// d left / d theta of every part, up to its sign.
  std::vector<Eigen::MatrixXd> slopes(const std::vector<PartAt>& parts, const Eigen::VectorXd& theta) const;

 private:
  const DrivenProblem& problem_;
  const filters::LinearMotion& motion_;
  Eigen::MatrixXd prior_;

  LinearResponse response(const Eigen::VectorXd& theta) const;
};

}  // namespace beamid::experiments
