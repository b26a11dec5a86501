// A record that is to be identified, and what is decided about it where nobody says.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/config/experiment.hpp"
#include "experiments/identify/compare/comparison.hpp"
#include "experiments/record/prepare/prepared_record.hpp"

namespace beamid::experiments {

/// One record, with the experiment as it holds for it.
struct IdentificationRequest {
  std::filesystem::path file;
  Experiment experiment;  ///< preparation and window included
  PreparedRecord prepared;
  std::string window = {};  ///< what was chosen, in words, where the experiment does not say
  bool thinned = false;     ///< by a step against higher modes, which the experiment does not have

  /// A paragraph for each thing that was decided.
  std::vector<std::string> decisions() const;
  /// K and C of a free decay have a report of their own.
  bool is_free_oscillator() const;
  /// With what the modal analysis needed of the record among its remarks: a filter takes it as it is.
  PreparedRecord as_analysed() const;
  /// The record as it is compared, with the noise before its event where that is what the experiment asks
  /// for.
  /// @throws InputError at the noise method
  ComparedRecord compared() const;
};

/// Cuts a free decay out of a record that the experiment does not cut, and in which no force was measured.
/// @throws as decay_window(); InputError at the window
void cut_decay(IdentificationRequest& one);

/// Adds the step that an experiment silent about preparation does not have.
/// @param reductions that the record is identified by; empty: the experiment's one. The step is added where
/// each of them would have it alone, for all are given the same record.
/// @throws as step_against_higher_modes(); InputError at the step or the window
void keep_out_higher_modes(IdentificationRequest& one, const std::vector<Choice>& reductions = {});

}  // namespace beamid::experiments
