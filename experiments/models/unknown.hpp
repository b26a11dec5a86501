// An unknown of a model, in physical units, and how the filter's state carries it.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

/// What stands in the filter's state eta for a parameter p:
///
///     linear        p = eta
///     logarithmic   p = e^eta                                  p > 0
///     bounded       p = lower + (upper - lower) / (1 + e^-eta)     lower < p < upper
enum class Form { linear, logarithmic, bounded };

const char* to_string(Form form);

/// One parameter that a record is asked about, or that is known to some accuracy.
struct Unknown {
  std::string name;        ///< key in results.json without its unit: "bending_stiffness", "damping_ratio_2"
  std::string unit;        ///< SI; empty when dimensionless
  double guess = 0.0;      ///< mean before the record is seen [unit]
  double deviation = 0.0;  ///< standard deviation before the record is seen [unit]
  Form form = Form::linear;
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
  /// Not asked about but not known exactly either: its deviation is what is known of it beforehand, carried
  /// along into the others'.
  bool nuisance = false;

  std::string quantity = {};                             ///< what it is, as [[parameters]] calls it
  std::optional<std::pair<double, double>> region = {};  ///< of the beam that it is about [m]; absent: all
  std::optional<int> mode = {};                          ///< that it is about, from 1; absent: all

  /// eta of p. @throws std::invalid_argument when p is outside what the form allows.
  double to_state(double physical) const;
  double to_physical(double state) const;  ///< p of eta
  double slope(double state) const;        ///< dp/deta
};

// A parameter as an experiment file asks about it.

/// A quantity that models may ask about.
struct ParameterQuantity {
  std::string name;       ///< "bending_stiffness"
  std::string unit;       ///< SI: "N m2"; empty when dimensionless
  std::string suffix;     ///< as in a key: "n_m2"
  bool positive = false;  ///< by its nature: a logarithm of it may stand in a filter's state
};
const std::vector<ParameterQuantity>& parameter_quantities();
/// @throws std::invalid_argument "unknown quantity 'ei'; known: ..."
const ParameterQuantity& parameter_quantity(const std::string& name);

/// A parameter as [[parameters]] of an experiment file names it; what is absent the model fills in.
struct ParameterChoice {
  std::string quantity;                                  ///< "bending_stiffness", "damping_ratio", ...
  std::string name = {};                                 ///< absent: made from the quantity
  std::optional<std::pair<double, double>> region = {};  ///< [m]
  std::optional<int> mode = {};                          ///< from 1; absent: all modes together
  std::optional<double> guess = {}, deviation = {};      ///< [unit of the quantity]
  std::optional<double> relative_deviation = {};         ///< of the guess, instead of the deviation
  std::optional<Form> form = {};
  std::optional<double> lower = {}, upper = {};
  bool known = false;          ///< a nuisance: known to its deviation
  bool keep_positive = false;  ///< where no form is chosen, a positive quantity is logarithmic
  Place place = {};            ///< for messages
};

/// What a model assumes of a parameter by itself.
struct ParameterDefault {
  double guess = 0.0;               ///< [unit of the quantity]
  double relative_deviation = 0.0;  ///< of the guess
};

/// The unknown that a choice asks about. Absent: guess and deviation as the model says, the form linear, or
/// bounded where bounds are given, or logarithmic where the choice keeps it positive; the name made of
/// quantity and mode.
/// @throws std::invalid_argument, or an InputError at the choice's place in a file, when the deviation comes
/// out as zero or the guess is outside what the form allows.
Unknown unknown_of(const ParameterChoice& choice, const ParameterDefault& by_model);

/// One for each choice, in their order. Names that would be the same are numbered.
/// @throws as above, and when two choices have the same given name or mean the same parameter: equal mode,
/// overlapping regions.
std::vector<Unknown> unknowns_of(const std::vector<ParameterChoice>& choices,
                                 const std::vector<ParameterDefault>& by_model);

/// @throws std::invalid_argument at the choice's place when its quantity is none of `known`, or it has a
/// region or a mode where the quantity has none.
void require_quantity(const ParameterChoice& choice, const std::vector<std::string>& known,
                      const std::string& model);

/// Throws `message` as an InputError at the choice's place, or as std::invalid_argument where it has none.
[[noreturn]] void refuse(const ParameterChoice& choice, const std::string& message);

}  // namespace beamid::experiments
