// Scripts around the command.
#pragma once

#include <string>

#include "tests/apps/run_command.hpp"

namespace beamid::reliability {

/// Sanitizers have a malloc of their own and take terabytes of addresses: no limit of these can be tested.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

/// What a POSIX shell does with a script in which "$beamid" is the command; its exit code is the last one's.
inline apps::Outcome shell(const apps::Workplace& place, const std::string& script) {
  return place.run("--version >/dev/null; beamid='" BEAMID_COMMAND "'; {\n" + script + "\n}");
}

/// With the experiment and the record of tutorial 2.
inline void copy_tutorial(const apps::Workplace& place, const std::string& below = "") {
  apps::fs::copy(apps::source("docs/tutorials/02_identify_a_record"), place.folder() / below,
                 apps::fs::copy_options::recursive);
}

}  // namespace beamid::reliability
