// A few numbers of an array, and where they stand in it.
#pragma once

#include <cstddef>
#include <vector>

namespace beamid::experiments::banded {

/// The entries of one matrix among those of a sum.
struct EntryList {
  std::vector<int> place;
  std::vector<double> value;

  /// sum += factor times this
  void add(double factor, std::vector<double>& sum) const {
    for (std::size_t k = 0; k < place.size(); ++k) sum[place[k]] += factor * value[k];
  }
};

}  // namespace beamid::experiments::banded
