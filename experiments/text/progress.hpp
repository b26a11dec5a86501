// How long work says what it is doing, without knowing whether anyone watches.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

namespace beamid::experiments {

/// Called with a few words whenever another part of the work begins.
using Progress = std::function<void(const std::string&)>;

/// Nobody watches.
inline void unwatched(const std::string&) {}

// How far long work is, and how long the rest will take.

/// "beam S(43.8): 137 of 1000 trials, 12.3 per second, 1 min 10 s left", at most five times a second. What is
/// left is judged by the average rate so far. May be used from any thread.
class Countdown {
 public:
  /// @param unit what is counted: "trials"
  /// @param before how many of `all` were finished earlier, in no time
  Countdown(const Progress& progress, std::size_t all, std::string unit, std::size_t before = 0);
  Countdown(const Countdown&) = delete;
  Countdown& operator=(const Countdown&) = delete;

  void begin(const std::string& what);  ///< another part of the work; shown at once
  void count(std::size_t more = 1);     ///< so many more are finished

 private:
  void show();

  std::mutex mutex_;
  const Progress& progress_;
  const std::size_t all_, before_;
  const std::string unit_;
  std::size_t done_ = 0;
  std::string what_;
  const double started_;
  double shown_ = 0.0;
};

/// "1 min 10 s"
std::string duration_text(double seconds);

}  // namespace beamid::experiments
