// What is wrong, unusual and in order with a record, as text, tables, figures and JSON.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/record/inspect/inspection.hpp"
#include "experiments/results/results.hpp"

namespace beamid::experiments {

/// Tables, warnings in words, and a figure of every channel's history and spectrum.
Results report(const Inspection& found);

// What a report on a record says of it: in words, tables and figures.

/// "tip (acceleration)": the name in the file, or its column, with the quantity unless the name tells it.
std::string title(const InspectedChannel& channel);

/// "m/s2", "as in the file".
std::string unit_text(const InspectedChannel& channel);

/// Whether it has more rises than a test has hits.
bool spiky(const InspectedChannel& channel);

/// "2000 samples from 0 to 10 s ... Evenly sampled at 200 Hz."
std::string sampling_text(const Inspection& found);

/// What is wrong with the record, a sentence each.
std::vector<std::string> inspection_warnings(const Inspection& found);

/// What to write into an experiment file so that every command reads the record like this.
std::string record_table_text(const Inspection& found);

/// The tables `channels` and `events`; the second may have no row.
Table channel_table(const Inspection& found);
Table event_table(const Inspection& found);

/// History and spectrum of every channel that moves, four to a figure.
std::vector<Figure> inspection_figures(const Inspection& found);

// An experiment file of one record: what was stated of it and what its file states, written down.

/// The table [record] that makes every command read the file as read_record(file, format) does, and comments
/// on what a structure needs besides.
/// @param folder of the experiment file, from which the record's path is counted
/// @throws InputError as read_record() does: the one question that is left.
std::string described_record(const std::filesystem::path& file, const RecordFormat& format,
                             const std::filesystem::path& folder);

}  // namespace beamid::experiments
