// How specific the published digits are: which data, filter and observed channels print 0.13 % and 6.41 %.
#pragma once

#include <string>
#include <vector>

#include "experiments/results/figure.hpp"
#include "experiments/results/table.hpp"

namespace beamid::experiments::paper {

/// One combination on the paper's oscillator, with the settings of table 2 and a release of 12 mm.
struct DigitCase {
  std::string data;      ///< generator of the record (data_generator.hpp)
  std::string scheme;    ///< the filter's discretisation
  std::string observed;  ///< "x and v", "x" or "v"
  double stiffness_error_percent = 0.0, damping_error_percent = 0.0;

  /// Whether its errors, without signs, are the published ones to the last digit printed.
  bool prints_the_published_digits() const;
};

/// Every generator with every compared scheme and the three choices of what is observed.
std::vector<DigitCase> examine_digits();

/// Error of C of all of them, and those that print the published digits.
Table digit_matrix(const std::vector<DigitCase>& cases);
Table digit_matches(const std::vector<DigitCase>& cases);
Figure digit_figure(const std::vector<DigitCase>& cases);

}  // namespace beamid::experiments::paper
