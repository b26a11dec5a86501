#include "filters/filter.hpp"

namespace beamid::filters {

FilterRegistry& filter_registry() {
  static FilterRegistry registry("filter");
  return registry;
}

}  // namespace beamid::filters
