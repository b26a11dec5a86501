// What a record's measured forces do between its samples.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/record/record.hpp"
#include "filters/input_path.hpp"
#include "filters/measurements.hpp"

namespace beamid::experiments {

/// How inputs were taken to run.
struct RecordInputs {
  InputPath path = InputPath::linear;
  bool stated = false;        ///< as the experiment says; else by the record's stamps
  Eigen::Index steps = 0;     ///< from sample to sample
  Eigen::Index straight = 0;  ///< of a band-limited path: those at uneven stamps, which are straight
};

/// "band_limited", "linear", "held".
const char* to_string(InputPath path);

/// Takes the inputs' samples (m x N) into `to`, whose stamps are set: band-limited where at least half of the
/// stamps are even, else straight, unless the path is stated. Intervals count as even within 1 % of their
/// mean and what the stamps are printed to.
/// @param imposed rows that are motions of supports: band-limited as all motion of a structure is, whatever
/// is stated of the others
/// @throws std::invalid_argument when a band-limited path is stated and no stamps are even, or a reading is
/// not finite.
RecordInputs take_inputs(const Eigen::MatrixXd& samples, std::optional<InputPath> stated,
                         filters::Measurements& to, const std::vector<Eigen::Index>& imposed = {});

/// Which of a record's inputs are motions of supports.
std::vector<Eigen::Index> imposed_inputs(const Record& record);

/// The m inputs of a record low-passed and decimated (signal/decimation.hpp) to even stamps, on the same kind
/// of path; none without inputs.
filters::InputPaths decimated_inputs(const filters::Measurements& from, Eigen::Index inputs, int factor,
                                     const Eigen::VectorXd& time);

/// Of a record with forces; absent without.
std::optional<RecordInputs> record_inputs(const Record& record);

/// "Measured forces are taken as straight between their samples (input = "linear")."
std::string words(const RecordInputs& inputs);

}  // namespace beamid::experiments
