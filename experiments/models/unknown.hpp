// An unknown of a model, in physical units, and how the filter's state carries it.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <utility>

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

}  // namespace beamid::experiments
