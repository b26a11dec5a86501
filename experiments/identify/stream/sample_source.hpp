// Lines from a pipe that a signal may end.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "experiments/text/input_error.hpp"
#include "filters/running_filter.hpp"

namespace beamid::experiments {

// One sample in one line.

/// "time,output[,output...]" [s, SI]; an output that is empty or "nan" was not measured.
/// @param place of the line; the column is told by this.
/// @throws InputError naming line and column, what was found and what was expected.
filters::Sample read_sample(const std::string& line, Eigen::Index outputs, const Place& place);

/// The lines of a file descriptor as they arrive, until they end or until SIGINT, SIGTERM or SIGHUP asks the
/// process to end: then there is time to save what is known. A signal that was ignored stays ignored. While
/// one of these lives, a broken pipe is an error of writing and no signal.
class SampleSource {
 public:
  static constexpr std::size_t longest = 65536;  ///< characters of a line

  /// @throws std::runtime_error when signals cannot be waited for
  explicit SampleSource(int descriptor);
  ~SampleSource();  ///< signals do again what they did before
  SampleSource(const SampleSource&) = delete;
  SampleSource& operator=(const SampleSource&) = delete;

  /// The next line, without its end; false when there is none any more.
  /// @throws InputError when it has more than `longest` characters; std::runtime_error when reading fails.
  bool next(std::string& line);
  std::size_t number() const { return number_; }  ///< of the last line, from 1
  int signal() const { return signal_; }          ///< that ended it; 0: none

 private:
  bool read_more();

  int descriptor_, signals_ = -1, signal_ = 0;
  std::string buffer_;
  std::size_t begin_ = 0, number_ = 0;
  bool ended_ = false;
  struct Before;  // what signals did
  std::unique_ptr<Before> before_;
};

}  // namespace beamid::experiments
