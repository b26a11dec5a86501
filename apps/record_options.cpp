#include "apps/record_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "experiments/config/read_record_format.hpp"
#include "experiments/record/record_reader.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::apps {
namespace {

namespace fs = std::filesystem;
using namespace experiments;
using Words = std::vector<std::string>;

Words words_of(const options::variables_map& values, const char* option) {
  return values.count(option) ? values[option].as<Words>() : Words{};
}

/// "3" is a column's number, anything else its name.
ColumnDescription column(const std::string& word) {
  ColumnDescription described;
  const char* const end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, described.number);
  if (error != std::errc() || rest != end || described.number < 1)
    described.number = 0, described.name = word;
  return described;
}

double factor(const std::string& symbol, const std::vector<Unit>& known, const std::string& of,
              const std::string& command) {
  for (const Unit& unit : known)
    if (unit.symbol == symbol) return unit.factor;
  throw UsageError(
      fmt::format("{}: '{}' is no unit of {}; known: {}", command, symbol, of, joined(symbols(known))));
}

/// The k-th of the words, or the only one.
std::string word_for(const Words& words, std::size_t k) {
  return words.size() == 1 ? words.front() : words[k];
}

std::vector<ColumnDescription> channels(const Words& columns, const Words& quantities,
                                        const Words& units_given, const std::string& command) {
  const auto check = [&](const Words& words, const char* option) {
    if (words.size() > 1 && words.size() != columns.size())
      throw UsageError(fmt::format("{}: {} times {} for {} times --column; expected as many, or one for all",
                                   command, words.size(), option, columns.size()));
  };
  check(quantities, "--quantity");
  check(units_given, "--unit");
  if (quantities.empty() != units_given.empty())
    throw UsageError(command + ": --quantity and --unit need each other: units are stated, never guessed");
  std::vector<ColumnDescription> described;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    described.push_back(column(columns[k]));
    ColumnDescription& channel = described.back();
    channel.stated = !quantities.empty();
    if (!channel.stated) continue;
    const std::string name = word_for(quantities, k);
    const auto quantity = find_quantity(name);
    if (!quantity) {
      Words known;
      for (const Quantity each : all_quantities) known.emplace_back(to_string(each));
      throw UsageError(fmt::format("{}: unknown quantity '{}'; known: {}", command, name, joined(known)));
    }
    channel.quantity = *quantity;
    channel.factor = factor(word_for(units_given, k), units(*quantity), name, command);
  }
  return described;
}

/// "1", "t:ms".
ColumnDescription time_column(const std::string& word, const std::string& command) {
  const std::size_t colon = word.rfind(':');
  ColumnDescription described = column(word.substr(0, colon));
  if (colon != std::string::npos)
    described.factor = factor(word.substr(colon + 1), time_units(), "time", command);
  return described;
}

void take_words(const options::variables_map& values, const std::string& command, RecordFormat& format) {
  const Words columns = words_of(values, "column"), quantities = words_of(values, "quantity"),
              units_given = words_of(values, "unit");
  if (columns.empty() && (!quantities.empty() || !units_given.empty()))
    throw UsageError(command + ": --quantity and --unit of which column? Add --column");
  if (!columns.empty()) format.channels = channels(columns, quantities, units_given, command);
  if (values.count("time")) format.time = time_column(values["time"].as<std::string>(), command);
  if (values.count("rate")) {
    format.sampling_rate = values["rate"].as<double>();
    if (!(*format.sampling_rate > 0) || !(*format.sampling_rate < 1e300))
      throw UsageError(command + ": --rate needs a positive number of samples per second");
  }
  if (values.count("window")) {
    const auto& window = values["window"].as<std::vector<double>>();
    if (window.size() != 2 || !(window[0] < window[1]))
      throw UsageError(command + ": --window needs two times [s], the first below the second: FROM TO");
    format.window = {window[0], window[1]};
    format.window_place = {"--window"};
  }
  if (values.count("reader")) {
    format.reader = values["reader"].as<std::string>();
    try {
      record_reader_registry().find(format.reader);
    } catch (const std::invalid_argument& error) {
      throw UsageError(command + ": " + error.what());
    }
  }
  if (values.count("skip-malformed")) format.skip_malformed = true;
  if (values.count("stamps")) {
    const std::string word = values["stamps"].as<std::string>();
    if (word != "even" && word != "as_they_are")
      throw UsageError(command + ": --stamps is '" + word + "'; expected even or as_they_are");
    format.irregular = word == "as_they_are";
  }
}

}  // namespace

options::options_description record_options() {
  options::options_description described("Record");
  described.add_options()  //
      ("column", options::value<Words>()->composing()->value_name("N|NAME"),
       "a column to use, by number from 1 or by name; may be repeated")  //
      ("quantity", options::value<Words>()->composing()->value_name("WHAT"),
       "that it measures: acceleration, velocity, displacement, force, strain; one for each column or for "
       "all")  //
      ("unit", options::value<Words>()->composing()->value_name("UNIT"),
       "of its numbers: g, m/s2, mm, N, um/m, ...; likewise")  //
      ("time", options::value<std::string>()->value_name("N|NAME[:UNIT]"),
       "column of time, in s unless told: 1, t:ms")  //
      ("rate", options::value<double>()->value_name("HZ"),
       "exact sampling rate, in place of rounded times or where there are none")  //
      ("window", options::value<std::vector<double>>()->multitoken()->value_name("FROM TO"),
       "part of the record to use [s]; after RECORD")  //
      ("stamps", options::value<std::string>()->value_name("HOW"),
       "as_they_are (default): times may be at unequal intervals; even: they must not")  //
      ("skip-malformed", "leave malformed lines out, counted and located")               //
      ("reader", options::value<std::string>()->value_name("NAME"),
       "kind of file, where its beginning does not show it (beamid list readers)")  //
      ("config", options::value<std::string>()->value_name("FILE"),
       "take all this from [record] of an experiment file (docs/configuration.md)");
  return described;
}

std::vector<RecordRequest> record_requests(const options::variables_map& values, const std::string& command) {
  RecordRequest request;
  request.format.irregular = true;
  if (values.count("config")) {
    const fs::path config = values["config"].as<std::string>();
    const RecordSection section = read_record_section(config);
    request.format = section.format;
    if (section.file) request.file = config.parent_path() / *section.file;
  }
  take_words(values, command, request.format);
  if (values.count("record")) {
    std::vector<RecordRequest> requests;
    for (const std::string& word : words_of(values, "record")) requests.push_back({word, request.format});
    return requests;
  }
  if (request.file.empty())
    throw UsageError(command + ": which RECORD?" +
                     (values.count("config") ? " The experiment file names none under [record]" : ""));
  return {request};
}

RecordRequest record_request(const options::variables_map& values, const std::string& command) {
  if (!values.count("record")) return record_requests(values, command).front();
  options::variables_map one = values;
  one.erase("record");
  const Words word{values["record"].as<std::string>()};
  one.insert({"record", options::variable_value(word, false)});
  return record_requests(one, command).front();
}

}  // namespace beamid::apps
