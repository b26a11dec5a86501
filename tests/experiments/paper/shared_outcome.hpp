// The study, run once for all tests of a process.
#pragma once

#include "experiments/paper/outcome.hpp"

namespace beamid::test {

/// Two trials per beam: what is repeated a hundred times has a test of its own.
inline const experiments::paper::Outcome& outcome() {
  static const auto found = experiments::paper::investigate(2009, 2, [](const std::string&) {});
  return found;
}

/// The five beams without noise or filter.
inline const std::vector<experiments::paper::BeamCase>& beam_cases() {
  static const auto cases = [] {
    std::vector<experiments::paper::BeamCase> prepared;
    for (const auto& beam : experiments::paper::test_beams)
      prepared.push_back(experiments::paper::prepare(beam));
    return prepared;
  }();
  return cases;
}

}  // namespace beamid::test
