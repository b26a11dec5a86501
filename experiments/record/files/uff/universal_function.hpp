// Dataset 58 of a Universal File, "function at nodal degree of freedom".
#pragma once

#include <string>
#include <vector>

namespace beamid::experiments {

/// A dataset's header, records 6 to 9, and its samples.
struct UniversalFunction {
  int type = 0, node = 0, direction = 0, ordinate = 0, kind = 0;
  std::string identity, label, unit, abscissa_unit;
  std::size_t points = 0;
  bool even = true;
  double start = 0.0, step = 0.0;
  std::vector<double> abscissa, values;

  bool single() const { return ordinate == 2 || ordinate == 5; }  ///< precision
  bool complex() const { return ordinate > 4; }
  /// Of a point: the ordinate's parts, and its abscissa where they are uneven.
  std::size_t numbers_per_point() const { return (complex() ? 2u : 1u) + (even ? 0u : 1u); }
  std::size_t numbers() const { return points * numbers_per_point(); }
};

/// All datasets 58 of a file; others are passed over. @throws InputError at what does not fit the format.
std::vector<UniversalFunction> read_universal_functions(const std::string& name, const std::string& bytes);

}  // namespace beamid::experiments
