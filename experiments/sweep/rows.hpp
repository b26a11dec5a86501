// What a sweep keeps of a case, as lines of CSV.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/sweep/sweep_plan.hpp"

namespace beamid::experiments {

/// One unknown of one run of a case; a run that found nothing has one row without an unknown, NaN for
/// numbers.
struct SweepRow {
  std::size_t number = 0;           ///< of the case
  std::size_t row = 1, rows = 1;    ///< this one, from 1, and how many the case has
  std::uint64_t seed = 0;           ///< simulation.seed
  std::vector<std::string> values;  ///< of the keys that vary, in the plan's order
  std::string reduction, filter, discretisation;
  std::string status;  ///< converged, diverged, refused; failed: the case could not be run at all
  std::string parameter, unit;
  double estimate = std::nan(""), truth = std::nan(""), error = std::nan("");   ///< [unit]
  double deviation = std::nan(""), lower = std::nan(""), upper = std::nan("");  ///< 95 % [unit]
  double bound = std::nan("");                                                  ///< Cramer-Rao [unit]
  std::string reason;                                                           ///< on one line
};

/// The numbers of a row in the order of their columns, and the names of these.
const std::vector<std::pair<const char*, double SweepRow::*>>& number_columns();
/// Likewise the texts.
const std::vector<std::pair<const char*, std::string SweepRow::*>>& text_columns();

/// "case,row,rows,seed,KEY...,reduction,...,reason\n"
std::string header_line(const SweepPlan& plan);
/// With its end "\n", the only one in it. Numbers read back the same.
std::string to_line(const SweepRow& row);
/// @param line without its end. Nothing where it is no such row with so many values.
std::optional<SweepRow> from_line(std::string_view line, std::size_t values);

}  // namespace beamid::experiments
