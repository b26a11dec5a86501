// The study, run once for all tests of a process.
#pragma once

#include "experiments/studies/paper/report.hpp"

namespace beamid::test {

/// Two trials per beam: what is repeated a hundred times has a test of its own.
const experiments::paper::Outcome& outcome();

/// The five beams without noise or filter.
const std::vector<experiments::paper::BeamCase>& beam_cases();

}  // namespace beamid::test
