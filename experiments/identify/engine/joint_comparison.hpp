// The unknowns of any model from several records of one structure.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "experiments/identify/engine/comparison.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "filters/gaussian.hpp"

namespace beamid::experiments {

// One estimate from several records of one structure, and whether they agree.

/// What one record says of the unknowns that all share.
struct RecordEstimate {
  filters::Gaussian unknowns;  ///< at the end of the record, prior included (q)
  Eigen::MatrixXd prior;       ///< covariance that the record was begun with (q x q)
  std::vector<bool> nuisance =
      {};                      ///< known beforehand, with this prior, rather than asked about; empty: none
  Eigen::VectorXd start = {};  ///< prior mean of nuisance unknowns (q); empty where there is none
  double noise_ratio = 1;      ///< deviation of the noise that counts over the R that was assumed
  double noise_freedom = 1e9;  ///< degrees of freedom that this ratio is known with
};

struct JointEstimate {
  filters::Gaussian
      unknowns;             ///< deviations for intervals of 1.96: Student's factor and scatter included (q)
  double chi_squared = 0;   ///< of the records about the joint estimate
  double freedom = 0;       ///< q (R - 1); 0 for one record
  double probability = 1;   ///< of one as large where the records agree
  Eigen::VectorXd scatter;  ///< Birge's ratio of every unknown where they do not, else ones (q)

  bool agree() const { return (scatter.array() == 1.0).all(); }
};

/// Information adds up; the prior, which all records were begun with, counts once:
///
///     I_r = (P_r^-1 - P0^-1) / k_r^2,   P = (P0^-1 + sum I_r)^-1,   m = (sum I_r)^-1 sum I_r m_r
///
/// k_r being the noise ratio. The mean is without a prior, as are the m_r after passes that each began from
/// the mean of the one before. Deviations are those of P times Student's factor for 1 / sum (s_r^2 / v_r)
/// degrees of freedom, s_r the share of record r in the information on the unknown [welch1947].
///
/// chi^2 = sum (m_r - m)^T I_r (m_r - m) has q (R - 1) degrees of freedom; its probability is by Fisher's F,
/// as the noise is known with sum v_r only. Below 5 % the records disagree by more than their noise, and the
/// deviation of every unknown i is multiplied by its own Birge ratio [birge1932], where that is above 1:
///
///     sqrt(sum_r (m_r - m)_i^2 / (I_r^-1)_ii / (R - 1))
///
/// What is known beforehand of nuisance unknowns is information on m too, once; q, chi^2 and scatter are of
/// the others.
/// @throws std::invalid_argument without records, or where they say nothing of a combination of unknowns.
JointEstimate joint_estimate(const std::vector<RecordEstimate>& records);

// Sentences on whether records agree.

/// @param names of the unknowns (q)
std::string agreement_words(const JointEstimate& estimate, const std::vector<std::string>& names);

/// `agreement` of results.json.
nlohmann::ordered_json agreement_values(const JointEstimate& estimate, const std::vector<std::string>& names);

// Stiffness and damping of one beam from several records of it: `beamid identify RECORD RECORD...`.

/// One of the records, and what it alone says.
struct IdentifiedRecord {
  std::string name;  ///< as shown
  Record record;
  RecordIdentification found;

  bool lost() const;  ///< whether the filter lost its motion
};

/// What all records say together.
struct JointIdentification {
  std::vector<IdentifiedRecord> records;
  JointEstimate estimate;         ///< of K and C, by the records that are not lost; empty: all are
  Identification identification;  ///< at it, without a run; deviations of the estimate
};

/// Each record has been identified by itself: own start, noise and window; beam, model and prior are shared.
/// @throws std::invalid_argument when equivalent masses differ.
JointIdentification joint_identification(std::vector<IdentifiedRecord> records);

/// What a run says of the unknowns; the noise near its mode counts.
RecordEstimate record_estimate(const ComparedRun& run);

/// What all records say together. Each was identified by itself, in one way: own start, noise and window.
struct JointComparison {
  std::vector<Comparison> records;  ///< of one run each
  JointEstimate estimate;  ///< of what the filter's state carries, by the runs that answer; empty: none
  std::vector<Estimate> parameters;  ///< at it (q)

  bool none_converged() const { return parameters.empty(); }
};

/// Deviations count the noise near each record's mode where its runs were judged (run_verdict.hpp).
/// @throws std::invalid_argument when the records' models have different unknowns.
JointComparison joint_comparison(std::vector<Comparison> records);

}  // namespace beamid::experiments
