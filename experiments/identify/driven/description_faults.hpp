// What of a description, changed alone, would explain what a driven model leaves of its record.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/record/record.hpp"
#include "filters/gaussian.hpp"

namespace beamid::experiments {

/// One described quantity, changed: a mass, a gain, a place; or two places, exchanged.
struct DescriptionFault {
  std::string sentence;    ///< "floor_mass_2: 1155 kg as described, 1004 +- 3 kg by the record"
  double score = 0.0;      ///< |z| of the change; infinite for a place
  double explained = 0.0;  ///< share of what is left, in squares
  Eigen::VectorXd moved;   ///< by how much the unknowns move with it, in the model's coordinates eta (q)
  double gain = 0.0;  ///< of the logarithm of the likelihood of all lines, by the score; infinite likewise
};

/// What the lines of a driven record say of a description.
struct DescriptionTests {
  std::vector<DescriptionFault> faults;  ///< the best first
  Eigen::VectorXd
      deviations;  ///< of the unknowns by the scatter of the lines (LineScores), eta (q); empty: none
};

/// Score tests [rao1948], one quantity x at a time. With r what is left of all lines, J its slopes by the
/// unknowns, d that by x, and d' what J leaves of d:
///
///     x = d'^T r / d'^T d',   z = x d'^T d' / sqrt(sum_k (d'_k r'_k / (1 - h_k))^2),
///     explained = (d'^T r)^2 / (d'^T d' r^T r)
///
/// with r' = r - d' x and h_k = d'_k^2 / d'^T d' of line k, whatever the noise of each [mackinnon1985]. x are
/// the candidates of model_check/candidates.hpp that are not asked about, gains of channels and inputs. A
/// change is followed to its end, by fits of the unknowns with it: of a few lines at a narrow resonance the
/// score is blind. Where there are more than 24 candidates, those that explain a tenth are. Of a chain
/// each sensor is tried at every other floor, and every two are exchanged, where 15 % or more of the motion
/// is left. Inputs that are taken for band-limited are tried with lines between their samples. A damping
/// ratio that is asked of all modes together is held against ratios of their own of the modes in the band,
/// all at once. Of a chain, dashpots in the storeys stand against ratios of modes, and the other way: neither
/// holds the other, and the likelihood decides. Beside noise of the inputs r and its derivatives are
/// whitened, and lags of the channels and of the inputs are tried.
/// @param theta the unknowns that were found, in the model's coordinates (q)
/// @param input_noise standard deviations (m); none above 0: the inputs are exact
/// @returns empty where the record is none of a small linear model with measured inputs.
DescriptionTests description_tests(const Experiment& experiment, const Record& record,
                                   const Choice& reduction, const std::filesystem::path& folder,
                                   const JointModel& model, const filters::Gaussian& prior,
                                   const Eigen::VectorXd& theta, const Eigen::VectorXd& input_noise);

/// Of a driven record that the best of all starts does not make: the channel whose reading, with the other
/// sign or in g where it is taken for m/s2 or the other way, lets the model make it. No search from what is
/// read wrongly comes to an end.
/// @param known beforehand of the unknowns, in the model's coordinates (q)
/// @returns a sentence; empty: there is none
std::string wrong_reading(const JointModel& model, const Record& record, const filters::Gaussian& known);

}  // namespace beamid::experiments
