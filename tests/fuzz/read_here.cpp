// In place of experiments/record/read_apart.cpp: a fuzzer sees what happens in its own process only. Here the
// faults of HDF5 and matio, which beamid meets in a child process, show as well.
#include "experiments/record/read_apart.hpp"

namespace beamid::experiments {

ReadingLimits reading_limits(std::size_t file_bytes) {
  return {file_bytes * 300 + 64, 0.0, 0};
}

CollectedSignals read_apart(const std::string& file, const std::string&, const ReadingLimits& limits,
                            const std::function<void(CollectedSignals&)>& read) {
  CollectedSignals signals(file, limits.numbers);
  read(signals);
  return signals;
}

std::vector<std::string> texts_apart(const std::string&, const std::string&, const ReadingLimits&,
                                     const std::function<std::vector<std::string>()>& read) {
  return read();
}

}  // namespace beamid::experiments
