// What `beamid identify` is asked to identify: records, each with the experiment as it holds for it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/command.hpp"
#include "experiments/experiment.hpp"
#include "experiments/preparation/prepared_record.hpp"

namespace beamid::apps {

/// Ends a sentence on what other models do not have.
inline constexpr const char* only_for_free_oscillators =
    " is there for model sdof without [[parameters]] on a free decay";

/// One record of the command.
struct IdentifyRequest {
  std::filesystem::path file;
  experiments::Experiment experiment;  ///< command line and preparation included
  experiments::PreparedRecord prepared;
  std::string window = {};  ///< what was chosen, in words, where neither file nor command line says
  bool thinned = false;     ///< by a step against higher modes, which the experiment file does not have

  /// K and C of a free decay have a report of their own.
  bool is_free_oscillator() const;
};

/// The options that say what to identify, beside --config and RECORD.
options::options_description identify_options();

/// What --damping-law asks for; empty: nothing. @throws UsageError
std::string damping_law(const options::variables_map& values);

/// Every RECORD of the command line, or the experiment file's, read and prepared.
/// @throws UsageError, InputError
std::vector<IdentifyRequest> identify_requests(const options::variables_map& values,
                                               const std::filesystem::path& config);

}  // namespace beamid::apps
