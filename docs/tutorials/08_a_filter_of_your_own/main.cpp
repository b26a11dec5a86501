// The beamid command, and whatever else this program registers.
#include <beamid/apps.hpp>

int main(int count, char** words) {
  return beamid::apps::run_command_line(count, words);
}
