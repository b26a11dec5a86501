// A measured record under forces that nobody measured.
#pragma once

#include <filesystem>
#include <optional>

#include "experiments/config/channel_places.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::apps {

/// What `beamid sense` and, of such a record, `beamid identify` find.
/// @param config the experiment's file, for messages and files beside it; @param filter of the histories;
/// absent: the smoother
/// @throws InputError of a record of fewer than 100 samples; std::invalid_argument as study_sensing()
experiments::Results sensed_record(const experiments::Experiment& experiment,
                                   const experiments::PreparedRecord& prepared,
                                   const std::filesystem::path& file, const std::filesystem::path& config,
                                   const experiments::Progress& progress,
                                   const std::optional<experiments::Choice>& filter = {});

}  // namespace beamid::apps
