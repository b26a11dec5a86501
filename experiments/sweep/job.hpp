// What another process has to know to run cases of a sweep.
#pragma once

#include <string>

#include "experiments/sweep/manifest.hpp"

namespace beamid::experiments {

struct SweepJob {
  SweepSource source;
  SweepPlan plan;
};

/// The manifest, and where the files are.
std::string job_text(const SweepSource& source, const nlohmann::ordered_json& manifest);

/// @throws std::runtime_error when the same job has another hash here: this process is of another version, or
/// finds other contents in the files that the experiment names.
SweepJob read_job(const std::string& text);

}  // namespace beamid::experiments
