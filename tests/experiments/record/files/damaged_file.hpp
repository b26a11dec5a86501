// Damage as files suffer it.
#pragma once

#include <string>

#include "experiments/record/record.hpp"

namespace beamid::experiments {

/// Reads a file a few hundred times with bytes changed, removed, doubled, or its end cut off: it is a record
/// or is refused in the usual way, and nothing else happens.
void expect_read_or_refused(const std::string& name, const std::string& whole, const RecordFormat& format,
                            unsigned seed, int rounds);

}  // namespace beamid::experiments
