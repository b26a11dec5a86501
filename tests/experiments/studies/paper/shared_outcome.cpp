#include "tests/experiments/studies/paper/shared_outcome.hpp"

namespace beamid::test {

const experiments::paper::Outcome& outcome() {
  static const auto found = experiments::paper::investigate(2009, 2, [](const std::string&) {});
  return found;
}

const std::vector<experiments::paper::BeamCase>& beam_cases() {
  static const auto cases = [] {
    std::vector<experiments::paper::BeamCase> prepared;
    for (const auto& beam : experiments::paper::test_beams)
      prepared.push_back(experiments::paper::prepare(beam));
    return prepared;
  }();
  return cases;
}

}  // namespace beamid::test
