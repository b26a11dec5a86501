// What is said when a long command is interrupted.
#pragma once

#include <string>

namespace beamid::apps {

/// Ends the program by a signal, whatever handler it or a library has for it. Fit for a handler.
void end_by(int signal);

/// While it lives, Ctrl-C or a request to end prints a sentence on standard error; the program then ends as
/// it would without. A handler that another had installed is left alone. One at a time.
class Interruption {
 public:
  explicit Interruption(const std::string& sentence);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  void say(const std::string& sentence);  ///< from now on; from one thread at a time
};

}  // namespace beamid::apps
