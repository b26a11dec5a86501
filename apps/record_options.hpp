// How a record is to be read, in words of the command line: no experiment file is needed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/command.hpp"
#include "experiments/config/experiment.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/results/results.hpp"
#include "experiments/text/progress.hpp"

namespace beamid::apps {

// A measured record under forces that nobody measured.

/// What `beamid sense` and, of such a record, `beamid identify` find.
/// @param config the experiment's file, for messages and files beside it; @param filter of the histories;
/// absent: the smoother
/// @throws InputError of a record of fewer than 100 samples; std::invalid_argument as study_sensing()
experiments::Results sensed_record(const experiments::Experiment& experiment,
                                   const experiments::PreparedRecord& prepared,
                                   const std::filesystem::path& file, const std::filesystem::path& config,
                                   const experiments::Progress& progress,
                                   const std::optional<experiments::Choice>& filter = {});

/// The word RECORD, "-" for standard input; or several.
Argument record_argument(bool several = false);

/// --column, --quantity, --unit, --position, --time, --rate, --window, --stamps, --delimiter, --decimal,
/// --header-lines, --skip-malformed, --reader, --config.
OptionGroup record_options();

/// The same without --window and --config, for commands that have their own.
OptionGroup column_options();

/// Takes what column_options() say over into `format`. @throws UsageError on words that make no sense.
void take_columns(const Values& values, experiments::RecordFormat& format);

/// The RECORDs of the command line, or else the `file` under [record] of the experiment file, if it names
/// one. Standard input, "-", is copied to a file that is removed when the program ends. Where channels come
/// from several files, all RECORDs are those of one record: the first is returned, `format` has them all.
/// What column_options() say is taken over into `format`.
std::vector<std::filesystem::path> record_files(const Values& values, const std::filesystem::path& config,
                                                const std::optional<std::string>& named,
                                                experiments::RecordFormat& format);

/// The same where there must be one. @throws UsageError
std::vector<std::filesystem::path> require_record_files(const Values& values,
                                                        const std::filesystem::path& config,
                                                        const std::optional<std::string>& named,
                                                        experiments::RecordFormat& format);

/// A record's file and how to read it.
struct RecordRequest {
  std::filesystem::path file;
  experiments::RecordFormat format;
};

/// The table [record] of the --config file, where there is one, and what the command line puts in its place:
/// any --column replaces all channels of the file, --quantity and --unit belong to the columns in their order
/// or, given once, to all of them. One request for each RECORD, all read alike; without one that of the
/// configuration's `file`.
///
/// A column without --quantity is what the record's file says it is (ColumnDescription::stated is false).
/// @throws UsageError on words that make no sense; InputError on the --config file.
std::vector<RecordRequest> record_requests(const Values& values);

}  // namespace beamid::apps
