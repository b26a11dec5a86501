// One part of a driven record beside what a model makes of it, line by line.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>

#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/models/motion/linear_response.hpp"

namespace beamid::experiments {

/// Complex lines as real rows: real parts of all, then imaginary ones (2 rows).
Eigen::MatrixXd line_rows(const Eigen::MatrixXcd& lines);

/// What a model makes of one part of a record, all p channels of one line, then those of the next (p L).
struct PartLines {
  Eigen::MatrixXcd driven;  ///< W G_k u_k (p L x 1)
  Eigen::MatrixXcd added;   ///< W Z_k (p L x c)
};

PartLines part_lines(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part);

/// What one part leaves, the ends of it projected out.
struct PartAt {
  PartLines lines;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> ends;
  Eigen::VectorXd scale, coefficients;  ///< of the columns of Z
  Eigen::VectorXd left;                 ///< (2 p L)

  PartAt(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part);

  /// Without what the ends of the part could make of it.
  void project(Eigen::VectorXd& rows) const;
};

}  // namespace beamid::experiments
