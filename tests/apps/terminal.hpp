// The real executable on a terminal of its own, as a user sees it.
#pragma once

#include <pty.h>
#include <unistd.h>

#include <string>

#include "tests/apps/run_command.hpp"

namespace beamid::apps {

/// What a terminal of so many columns gets, standard output and error together, lines ending in "\n".
inline std::string seen_in_terminal(const Workplace& place, const std::string& words, unsigned short columns,
                                    const std::string& environment = "TERM=xterm") {
  const std::string line = "cd '" + place.folder().string() + "' && unset COLUMNS NO_COLOR && " +
                           environment + " '" BEAMID_COMMAND "' " + words;
  winsize size{24, columns, 0, 0};
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  std::string seen;
  char part[4096];
  for (ssize_t count = 0; (count = read(terminal, part, sizeof part)) > 0;)
    for (ssize_t i = 0; i < count; ++i)
      if (!(part[i] == '\r' && i + 1 < count && part[i + 1] == '\n')) seen += part[i];
  close(terminal);
  waitpid(child, nullptr, 0);
  return seen;
}

}  // namespace beamid::apps
