#include "filters/state_entries.hpp"

#include <algorithm>
#include <stdexcept>

namespace beamid::filters {

std::vector<Eigen::Index> state_entries(const std::string& what, const std::vector<double>& stated,
                                        std::size_t size) {
  std::vector<Eigen::Index> entries;
  for (const double entry : stated) {
    const auto index = static_cast<Eigen::Index>(entry);
    if (!(entry >= 0.0 && entry < static_cast<double>(size)) || static_cast<double>(index) != entry ||
        std::find(entries.begin(), entries.end(), index) != entries.end())
      throw std::invalid_argument(what + " hold " + std::to_string(entry) +
                                  "; expected different whole numbers from 0 to " + std::to_string(size - 1));
    entries.push_back(index);
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace beamid::filters
