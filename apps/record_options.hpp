// How a record is to be read, in words of the command line: no experiment file is needed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/command.hpp"
#include "experiments/config/experiment.hpp"

namespace beamid::apps {

/// --column, --quantity, --unit, --time, --rate, --window, --reader, --skip-malformed, --stamps, --config.
options::options_description record_options();

/// A record's file and how to read it.
struct RecordRequest {
  std::filesystem::path file;
  experiments::RecordFormat format;
};

/// The table [record] of the --config file, where there is one, and what the command line puts in its place:
/// any --column replaces all channels of the file, --quantity and --unit belong to the columns in their order
/// or, given once, to all of them. The record is the positional word "record", else the configuration's
/// `file`.
///
/// A column without --quantity is what the record's file says it is (ColumnDescription::stated is false).
/// @param command its name, for messages.
/// @throws UsageError on words that make no sense; InputError on the --config file.
RecordRequest record_request(const options::variables_map& values, const std::string& command);

/// The same of a command that takes several, parsed with the positional words "record...": one request for
/// each word, all read alike; without a word that of the configuration's `file`.
std::vector<RecordRequest> record_requests(const options::variables_map& values, const std::string& command);

}  // namespace beamid::apps
