// The beamid command, and whatever else this program registers.
#include "apps/command_line.hpp"

int main(int count, char** words) {
  return beamid::apps::run_command_line(count, words);
}
