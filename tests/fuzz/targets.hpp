// Everything in beamid that reads bytes from outside, one function for each kind.
#pragma once

#include <string>
#include <vector>

namespace beamid::fuzz {

struct Target {
  const char* name;  ///< of its folders below tests/fuzz
  /// Reads these bytes as a file of its kind, in one of its ways. What beamid refuses in one message (exit
  /// code 2) is caught; any other exception, a crash, or a result that breaks a promise (abort) is a finding.
  void (*read)(const std::string& bytes, int way);
  int ways = 1;  ///< of reading the same bytes, such as with malformed rows refused or skipped: way < ways
};

const std::vector<Target>& targets();

}  // namespace beamid::fuzz
