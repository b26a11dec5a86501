// One structure and what is done with it, as its TOML file describes it (docs/configuration.md).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/config/acquisition_settings.hpp"
#include "experiments/config/identifiability_settings.hpp"
#include "experiments/config/sensing_settings.hpp"
#include "experiments/config/settings.hpp"
#include "experiments/models/parameter_choice.hpp"
#include "experiments/models/prior.hpp"
#include "experiments/models/springs/storey_spring.hpp"
#include "experiments/record/record_format.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/toml_table.hpp"
#include "fem/damping.hpp"
#include "fem/structure.hpp"
#include "filters/running_filter.hpp"

namespace beamid::experiments {

/// A structure, a test of it and what is done with the record: all that an experiment file may say, in SI
/// units.
struct Experiment {
  std::optional<TomlTable> file;  ///< what it was read from, with what was set from outside
  std::string title;
  bool is_described = true;    ///< else made from a record alone: one mode of a mass of 1 kg
  bool mass_is_stated = true;  ///< of such a mode: else K and C are not said
  fem::Structure structure;
  std::vector<StoreySpring> storey_springs;  ///< of a chain, those that follow laws; the others are linear
  int elements = 40;                         ///< of a beam, or of each member of a frame
  fem::DampingLaw damping;
  Excitation excitation;
  std::vector<Excitation> further_excitations;  ///< that act at the same time, forces and the base's motion
  std::vector<Sensor> sensors;                  ///< none: displacement and acceleration at the natural point
  Acquisition acquisition;                      ///< of a virtual test
  Simulation simulation;
  FrequencyResponseSettings frequency_response;
  std::optional<std::string> record_file;  ///< relative to the TOML file's folder
  RecordFormat format;
  Choice reduction{"rayleigh", {}};
  bool reduction_is_stated = false;  ///< by [reduction] of the file
  std::vector<Choice>
      reductions;  ///< to be compared, in the order of the file; none: a choice of the command
  Choice model{"sdof", {}};
  std::vector<ParameterChoice> parameters;  ///< none: what the model asks about by itself
  Choice filter{"ekf", {}};
  std::string discretisation = "exponential";
  filters::OnFailure on_failure = filters::OnFailure::stop;
  std::string smoother;                      ///< of the history of an identification; empty: none
  std::vector<Choice> filters;               ///< to be compared; none: `filter`
  std::vector<std::string> discretisations;  ///< likewise; none: `discretisation`
  int passes = 3;                            ///< over the record, of every run of a comparison
  IdentifiabilitySettings identifiability;
  std::vector<PartOfStructure> parts;  ///< to be identified one by one
  std::vector<UnknownForce> unknown_forces;
  std::vector<VirtualSensor> virtual_sensors;
  std::optional<FatigueLaw> fatigue;
  Prior prior;
  std::map<Quantity, double> noise;     ///< standard deviation per quantity [SI]; absent: from the record
  Choice noise_method{"residual", {}};  ///< how absent ones are found: residual, likelihood, before_event
  std::string estimator = "filter";     ///< of an identification: filter, batch or both
};

}  // namespace beamid::experiments
