// What `update` and `twins` have in common.
#pragma once

#include "apps/command.hpp"
#include "apps/values.hpp"
#include "experiments/identify/update/update_study.hpp"

namespace beamid::apps {

/// --config, --model-error, --shape-error, --starts.
OptionGroup update_options();
experiments::UpdateSettings update_settings(const Values& values);

/// Errors of the library become those of the experiment file.
experiments::UpdateStudy studied_update(const Values& values, const experiments::Experiment& experiment,
                                        const experiments::ModalData& data);

}  // namespace beamid::apps
