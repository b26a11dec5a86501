// Histories by a registered filter, sample after sample.
#pragma once

#include <string>
#include <vector>

#include "experiments/identify/sensing/sensing_model.hpp"
#include "experiments/text/choice.hpp"

namespace beamid::experiments {

struct FilteredRows {
  filters::SmoothedRows rows;        ///< C x_k + D u_k given the readings up to sample k
  std::vector<std::string> remarks;  ///< of the filter
};

/// Whether a filter takes nothing for known of the forces, and needs SensingModel::form_of_walks.
bool estimates_unknown_inputs(const std::string& filter);

/// @param rows C (c x n) of the form's motion; @param feed D (c x m)
/// @throws std::invalid_argument where the filter refuses the model; std::runtime_error where it fails, with
/// the sample's time.
FilteredRows filtered_rows(SensingForm form, const Choice& filter, const filters::Measurements& record,
                           const Eigen::MatrixXd& rows, const Eigen::MatrixXd& feed);

}  // namespace beamid::experiments
