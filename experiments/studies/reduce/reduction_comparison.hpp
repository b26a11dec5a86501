// Reductions of one beam against its mesh: what each of them keeps.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/studies/reduce/model_behaviour.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::experiments {

struct ReductionComparisonSettings {
  int modes = 5;       ///< compared, the lowest with strain
  double band = 20.0;  ///< frequency responses are compared from a fifth of the first frequency to this many
};

/// One reduction against the mesh. Errors are relative: 0.01 is a per cent, positive where the reduced model
/// has more. NaN: there is no such number.
struct ComparedReduction {
  Choice choice;
  std::string label;      ///< its name, and what tells it from others of that name
  Eigen::Index size = 0;  ///< r
  bool identity = false;  ///< nothing was reduced: there are no shapes to store

  std::vector<Eigen::Index> partner;  ///< of each mode compared: number of the model's mode; -1: none
  Eigen::VectorXd frequency_hz;       ///< of that (K)
  Eigen::VectorXd frequency_error;    ///< (K)
  Eigen::VectorXd mac;  ///< weighted with the mass (K); the best there is where there is no partner
  Eigen::VectorXd deflection_mac;  ///< plain, of deflections at the nodes (K)
  Eigen::VectorXd comac;           ///< of the modes that have a partner, at the nodes

  ModelBehaviour behaviour;
  double static_stiffness_error = 0.0;
  double modal_mass_error = 0.0;
  double response_error = 0.0;      ///< || |H_r| - |H| || / || |H| || over the band, L2
  double worst_response = 0.0;      ///< largest | log10 |H_r / H| |, in decibels
  double worst_response_hz = 0.0;   ///< where
  double displacement_error = 0.0;  ///< ||x_r - x|| / ||x|| over the record
  double acceleration_error = 0.0;

  Eigen::VectorXd significance;  ///< Bases::significance
  std::string significance_name;
  ModelModes modes;             ///< for pictures, not more than were compared
  double reduce_seconds = 0.0;  ///< that it took to reduce, by the clock [s]
};

struct ReductionComparison {
  ReductionComparisonSettings settings;
  fem::StructuralSystem system;  ///< of the mesh
  fem::Point observed;           ///< output 0 and input 0
  fem::DampingLaw damping;
  bool damping_assumed = false;  ///< the experiment describes none
  ModelModes modes;              ///< of the mesh: those compared begin after the rigid ones
  ModelBehaviour behaviour;
  ReleaseTest release;
  Eigen::VectorXd frequency_hz;  ///< of the frequency responses
  std::vector<ComparedReduction> reductions;
  std::vector<std::string> notes;

  Eigen::Index compared() const;  ///< K
  /// Frequency of compared mode i, from 0 [Hz].
  double mode_hz(Eigen::Index i) const { return modes.modes.frequency_hz()[modes.modes.rigid + i]; }
};

/// @param choices in their order. Those without a place were not asked for: one that cannot reduce the beam
/// is left out with a note.
/// @param folder in which shape files are looked for.
/// @throws InputError at the place of a choice that cannot reduce the beam, and as read_shape();
/// std::invalid_argument when the beam or its damping is impossible.
ReductionComparison compare_reductions(const Experiment& experiment, const std::vector<Choice>& choices,
                                       const ReductionComparisonSettings& settings,
                                       const std::filesystem::path& folder, const Progress& progress);

}  // namespace beamid::experiments
