// One beam and what is done with it, as its TOML file describes it (docs/configuration.md).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/continuum/settings.hpp"
#include "experiments/identifiability/settings.hpp"
#include "experiments/input/input_error.hpp"
#include "experiments/parameter_choice.hpp"
#include "experiments/record.hpp"
#include "experiments/sweep/plan.hpp"
#include "fem/beam.hpp"
#include "fem/damping.hpp"
#include "filters/options.hpp"
#include "filters/running_filter.hpp"

namespace beamid::experiments {

/// A registered method and its options, chosen by name.
struct Choice {
  std::string name;
  filters::Options options;
  Place place = {};  ///< where it was chosen, for messages; empty when it was not
  std::string shape_file =
      {};  ///< of a reduction that takes a given shape; relative to the TOML file's folder; empty: none
};

/// One column of a record's file: by number, from 1, or by its name there.
struct ColumnDescription {
  Quantity quantity = Quantity::acceleration;
  std::string name;                     ///< in the header; empty when chosen by number
  int number = 0;                       ///< from 1; 0 when chosen by name
  double factor = 1;                    ///< to SI units
  std::optional<double> position = {};  ///< of the sensor or the force [m]; absent: the natural point
  double distance = 0.0;                ///< strain: of the surface from the axis [m]
  bool stated = true;                   ///< false: quantity and factor are what the file itself says
};

/// How a record's file is to be read, and what is done with the record before anything else sees it.
struct RecordFormat {
  std::string reader;     ///< registered; empty: the one that recognises the file
  char separator = '\0';  ///< '\0': the first of tab, semicolon, comma in the first row, else blanks (' ')
  int header_lines = 0;   ///< before the rows, the last non-blank one naming columns; 0 finds a single one
  char decimal = '\0';    ///< between whole and fraction, '.' or ','; '\0': what the first rows show
  bool skip_malformed = false;  ///< leave malformed lines out, counted and located in the record's remarks
  bool irregular = false;       ///< take stamps as they are, at unequal intervals
  std::optional<ColumnDescription> time;  ///< factor to seconds
  std::optional<double> sampling_rate;  ///< [Hz]; replaces the printed times, counted from the first of them
  std::vector<ColumnDescription> channels;  ///< empty: the header's names tell quantities and units
  std::optional<InputPath> input;  ///< of force channels between samples; absent: as Record::input_path
  std::optional<std::pair<double, double>> window;  ///< [s]
  Place window_place;                               ///< where the window is set, for messages
  std::vector<Choice> preparation;                  ///< registered steps, in their order
};

/// What is believed before the record is seen; absent values are worked out from the model and the record.
struct PriorBelief {
  std::optional<double> stiffness, stiffness_deviation;  ///< [N/m]
  std::optional<double> damping_ratio, damping_ratio_deviation;
};

struct Experiment {
  std::string title;
  fem::Beam beam;
  int elements = 40;
  fem::DampingLaw damping;
  Excitation excitation;
  std::vector<Sensor> sensors;  ///< none: displacement and acceleration at the natural point
  Simulation simulation;
  FrequencyResponseSettings frequency_response;
  std::optional<std::string> record_file;  ///< relative to the TOML file's folder
  RecordFormat format;
  Choice reduction{"rayleigh", {}};
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
  PriorBelief prior;
  std::map<Quantity, double> noise;     ///< standard deviation per quantity [SI]; absent: from the record
  Choice noise_method{"residual", {}};  ///< how absent ones are found: residual, likelihood, before_event
  std::string estimator = "filter";     ///< of an identification: filter, batch or both
  SweepPlan sweep;
};

}  // namespace beamid::experiments
