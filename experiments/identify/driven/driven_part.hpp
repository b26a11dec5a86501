// One part of a driven record beside what a model makes of it, line by line.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/QR>
#include <functional>
#include <optional>
#include <vector>

#include "experiments/identify/driven/driven_fit.hpp"
#include "experiments/models/motion/supported_response.hpp"

namespace beamid::experiments {

/// What a model makes of one part of a record from a difference d = x_0 - x_N of its ends (l): W (G_k u_k +
/// what d adds) (p x L).
Eigen::MatrixXcd part_motion(const DrivenProblem& problem, const LinearResponse& response,
                             const RecordLines& part, const Eigen::VectorXd& difference);

/// W G_k of every input by itself, times its size (p x L each).
std::vector<Eigen::MatrixXcd> motions_by_inputs(const DrivenProblem& problem, const LinearResponse& response,
                                                const RecordLines& part, const Eigen::VectorXd& sizes);

/// Every so many lines of a part.
RecordLines thinned(const RecordLines& part, Eigen::Index stride);

/// The residual of one part, whitened, the ends of it projected out. Rows are all channels of one line, then
/// those of the next, real parts before imaginary ones.
struct PartAt {
  Eigen::MatrixXcd driven;                           ///< W G_k u_k (p x L)
  Eigen::MatrixXcd moved;                            ///< the same with what d adds (p x L)
  Eigen::VectorXd difference;                        ///< d, as the residual has it (l)
  Eigen::MatrixXd columns;                           ///< W Z, of one length each
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> ends;  ///< of them
  Eigen::VectorXd left;                              ///< (2 p L)

  PartAt(const DrivenProblem& problem, const LinearResponse& response, const RecordLines& part);

  /// Without what the ends of the part could make of it.
  void project(Eigen::VectorXd& rows) const;
  /// How the lines of another response with the same d differ from these, likewise (2 p L), of exact inputs.
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

/// The residual of a problem's first part at its unknowns, and score tests [rao1948] of what may be described
/// otherwise: directions in which a change moves the residual (2 p L), the unknowns' own taken out. The
/// problem outlives it.
class LineScores {
 public:
  /// @throws std::runtime_error where there is no motion
  LineScores(const DrivenProblem& problem, const Eigen::VectorXd& theta);

  const Eigen::VectorXd& left() const { return part().left; }
  const Eigen::MatrixXd& slopes() const { return slopes_; }  ///< by the unknowns (2 p L x q)

  /// Of a model of another description at the same unknowns: how the lines made differ from those of the
  /// description as it is, made anew in the same way. Each has the ends that suit it.
  Eigen::VectorXd change_of(const JointModel& described, const JointModel& other) const;
  Eigen::VectorXd gain_of(Eigen::Index channel) const;
  Eigen::VectorXd gain_of_inputs() const;
  /// Of a lag [sampling intervals] of one channel; absent: of all inputs.
  Eigen::VectorXd lag_of(std::optional<Eigen::Index> channel) const;

  struct Score {
    double change, deviation, score, explained;  ///< score: |change| / deviation; of the squares left
    Eigen::VectorXd moved;                       ///< the unknowns with it (q)
  };
  /// Absent where the unknowns make of it what it makes. @param collinear what they leave of it, at least
  std::optional<Score> score(const Eigen::VectorXd& direction, double collinear = 1e-3) const;

  /// Standard deviations of the unknowns by the residual of each line where it weighs, whatever its noise
  /// (q): the diagonal of N^-1 (sum_k J_k^T r'_k r'_k^T J_k) N^-1, N = J^T J, r'_k = r_k / sqrt(1 - h_k) with
  /// the leverage h_k [mackinnon1985]. Forces that nobody measures make the lines of a resonance scatter by
  /// more than those beside it.
  Eigen::VectorXd deviations() const;

  /// s^T V^-1 s of many directions together, by what is left with them, whatever the noise of each line.
  /// Directions that the unknowns make, or that make each other, drop out.
  double together(const Eigen::MatrixXd& directions) const;

 private:
  const DrivenProblem& problem_;
  Eigen::VectorXd theta_;
  DrivenMotion motion_;
  LinearResponse response_;
  std::vector<PartAt> parts_;  // one
  Eigen::MatrixXd slopes_;
  Eigen::LDLT<Eigen::MatrixXd> normal_;
  Eigen::VectorXd at_once_;  // what no unknowns make, to first order

  const PartAt& part() const { return parts_.front(); }
  Eigen::VectorXd left_of(const JointModel& model) const;
  /// By a change of the readings or of what is known of them.
  Eigen::VectorXd slope_by(const std::function<void(DrivenProblem& other, double step)>& change) const;
};

}  // namespace beamid::experiments
