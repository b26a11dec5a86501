// What surrounds a command in place of a terminal: a program that calls it, such as the Python module.
#pragma once

#include <string>

#include "experiments/results/results.hpp"

namespace beamid::apps {

class Receiver {
 public:
  virtual ~Receiver() = default;

  /// What the command found, in place of printing it.
  virtual void take(experiments::Results results) = 0;

  /// Called, from any thread, whenever a command would show what it is doing; what it throws ends the
  /// command.
  virtual void progress(const std::string& what) = 0;
};

}  // namespace beamid::apps
