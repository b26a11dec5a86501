// The `beamid` command. A command with methods of one's own has the same line (docs/tutorials).
#include "apps/command_line.hpp"

int main(int count, char** words) {
  return beamid::apps::run_command_line(count, words);
}
