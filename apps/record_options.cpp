#include "apps/record_options.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "experiments/config/readers.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/units.hpp"
#include "experiments/studies/prepare/preparation_report.hpp"
#include "experiments/studies/sensing/report.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/spelling.hpp"

namespace beamid::apps {

using namespace experiments;

Results sensed_record(const Experiment& experiment, const PreparedRecord& prepared,
                      const std::filesystem::path& file, const std::filesystem::path& config,
                      const Progress& progress, const std::optional<Choice>& filter) {
  constexpr Eigen::Index fewest = 100;  // of innovations, for their test
  if (prepared.record.size() < fewest)
    throw InputError({file.string()}, std::to_string(prepared.record.size()) +
                                          " samples; expected at least " + std::to_string(fewest));
  const SensingRecord record = sensing_record(experiment, prepared.record, {config.string()});
  const Choice reduction = sensing_reduction(experiment, record.record.interval());
  Results results = sensing_report(
      experiment, study_sensing(experiment, record, reduction, config.parent_path(), progress, filter),
      file.filename().string());
  add_preparation(results, prepared, experiment.format);
  return results;
}

namespace {

namespace fs = std::filesystem;

const std::map<std::string, char> separators{
    {"tab", '\t'}, {"comma", ','}, {"semicolon", ';'}, {"bar", '|'}, {"space", ' '}};

const std::map<std::string, char> decimal_signs{{"auto", '\0'}, {"point", '.'}, {"comma", ','}};

Words names_of_separators() {
  Words names;
  for (const auto& [name, separator] : separators) names.push_back(name);
  return names;
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

/// @param quantity of which it is a unit; absent: time
double factor(const std::string& symbol, std::optional<Quantity> quantity) {
  if (const auto found = unit_factor(symbol, quantity)) return *found;
  throw UsageError(fmt::format("'{}' is no unit of {}; known: {}", symbol,
                               quantity ? to_string(*quantity) : "time",
                               joined(symbols(quantity ? units(*quantity) : time_units()))));
}

/// The k-th of the words, or the only one.
std::string word_for(const Words& words, std::size_t k) {
  return words.size() == 1 ? words.front() : words[k];
}

std::vector<ColumnDescription> channels(const Words& columns, const Words& quantities,
                                        const Words& units_given) {
  const auto check = [&](const Words& words, const char* option) {
    if (words.size() > 1 && words.size() != columns.size())
      throw UsageError(fmt::format("{} times {} for {} times --column; expected as many, or one for all",
                                   words.size(), option, columns.size()));
  };
  check(quantities, "--quantity");
  check(units_given, "--unit");
  if (quantities.empty() != units_given.empty())
    throw UsageError("--quantity and --unit need each other: units are stated, never guessed");
  std::vector<ColumnDescription> described;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    described.push_back(column(columns[k]));
    ColumnDescription& channel = described.back();
    channel.stated = !quantities.empty();
    if (!channel.stated) continue;
    channel.quantity = *find_quantity(word_for(quantities, k));
    channel.factor = factor(word_for(units_given, k), channel.quantity);
  }
  return described;
}

/// "1", "t:ms".
ColumnDescription time_column(const std::string& word) {
  const std::size_t colon = word.rfind(':');
  ColumnDescription described = column(word.substr(0, colon));
  if (colon != std::string::npos) described.factor = factor(word.substr(colon + 1), {});
  return described;
}

/// Where the sensors of --column sit: a number [m], or the name of a place.
void take_positions(const Words& positions, RecordFormat& format) {
  if (positions.empty()) return;
  if (positions.size() > 1 && positions.size() != format.channels.size())
    throw UsageError(
        fmt::format("{} times --position for {} times --column; expected as many, or one for all",
                    positions.size(), format.channels.size()));
  for (std::size_t k = 0; k < format.channels.size(); ++k) {
    const std::string word = word_for(positions, k);
    const ParsedNumber number = parse_number(word);
    if (number.finite)
      format.channels[k].position = number.value;
    else
      format.channels[k].place = word;
  }
}

}  // namespace

void take_columns(const Values& values, RecordFormat& format) {
  const auto given = [&](const char* name) { return values.has(name) ? values.texts(name) : Words{}; };
  const Words columns = given("column"), quantities = given("quantity"), units_given = given("unit");
  const Words positions = given("position");
  if (columns.empty() && (!quantities.empty() || !units_given.empty() || !positions.empty()))
    throw UsageError("--quantity, --unit and --position of which column? Add --column");
  if (!columns.empty()) format.channels = channels(columns, quantities, units_given);
  take_positions(positions, format);
  if (values.has("delimiter")) format.separator = separators.at(values.text("delimiter"));
  if (values.has("decimal")) format.decimal = decimal_signs.at(values.text("decimal"));
  if (values.has("header-lines")) format.header_lines = values.whole("header-lines");
  if (values.has("time")) format.time = time_column(values.text("time"));
  if (values.has("rate")) format.sampling_rate = values.number("rate");
  if (values.has("reader")) format.reader = values.text("reader");
  if (values.has("skip-malformed")) format.malformed = MalformedRows::skip;
  if (values.has("stamps")) format.irregular = values.text("stamps") == "as_they_are";
}

namespace {

/// Standard input in a file of its own: readers look at the beginning of a file first, and a pipe is read
/// once.
class StandardInput {
 public:
  StandardInput() {
    std::string name = (fs::temp_directory_path() / "beamid_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder for standard input");
    folder_ = name;
    std::ofstream copy(file(), std::ios::binary);
    if (std::cin.peek() != std::char_traits<char>::eof()) copy << std::cin.rdbuf();
    if (!copy.flush()) throw std::runtime_error("standard input cannot be copied to " + file().string());
  }
  ~StandardInput() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  StandardInput(const StandardInput&) = delete;
  StandardInput& operator=(const StandardInput&) = delete;

  fs::path file() const { return folder_ / "standard_input"; }

 private:
  fs::path folder_;
};

fs::path record_file(const std::string& word) {
  if (word != "-") return word;
  static const StandardInput input;
  return input.file();
}

Words quantity_names() {
  Words names;
  for (const Quantity quantity : all_quantities) names.emplace_back(to_string(quantity));
  return names;
}

}  // namespace

Argument record_argument(bool several) {
  return {.name = "record", .several = several};
}

OptionGroup column_options() {
  return {
      "Record",
      {text("column", "N|NAME", "a column to use, by number from 1 or by name").repeated(),
       text("quantity", "WHAT", "quantity of each --column; one value for all or one per column")
           .repeated()
           .one_of(quantity_names()),
       text("unit", "UNIT", "of its numbers: g, m/s2, mm, N, um/m, ...; one for each column or for all")
           .repeated(),
       text("position", "M|PLACE",
            "position of its sensor [m], or the name of that place; one for each column or for all")
           .repeated(),
       text("time", "N|NAME[:UNIT]", "column of time, in s unless the unit is given: 1, t:ms"),
       number("rate", "HZ", "exact sampling rate, in place of rounded times or where there are none [Hz]")
           .greater_than(0)
           .less_than(1e300),
       text("stamps", "HOW", "as_they_are: times may be at unequal intervals; even: they must not")
           .by_default("as_they_are")
           .one_of({"even", "as_they_are"}),
       text("delimiter", "WHAT", "column separator of a text file [detected]").one_of(names_of_separators()),
       text("decimal", "SIGN", "of its numbers; else what its rows show").one_of({"auto", "point", "comma"}),
       whole("header-lines", "N", 0, 1e6, "lines before its first row; else found"),
       flag("skip-malformed", "omit malformed lines, counted and located"),
       text("reader", "NAME", "kind of file, where its beginning does not show it (beamid list readers)")
           .one_of(names_in(record_reader_registry()))}};
}

OptionGroup record_options() {
  OptionGroup group = column_options();
  const auto after_rate = std::ranges::find(group.options, "rate", &Option::name) + 1;
  group.options.insert(after_rate, from_to("window", "part of the record to use [s]"));
  group.options.push_back(
      config_option("take all this from [record] of an experiment file (docs/configuration.md)"));
  return group;
}

std::vector<fs::path> record_files(const Values& values, const fs::path& config,
                                   const std::optional<std::string>& named, RecordFormat& format) {
  take_columns(values, format);
  std::vector<fs::path> files;
  for (const std::string& word : values.texts("record")) {
    if (fs::path(word).extension() == ".toml" && fs::exists(word))
      throw UsageError(fmt::format("'{0}' is an experiment file; expected a record, or --config {0}", word));
    files.push_back(record_file(word));
  }
  std::size_t parts = format.files.size();
  for (const ColumnDescription& channel : format.channels)
    parts = std::max(parts, static_cast<std::size_t>(channel.file));
  if (parts > 1 && (!files.empty() || format.files.empty())) {
    if (files.size() != parts)
      throw UsageError(fmt::format("{} RECORDs; expected {}, the files that the channels of {} come from",
                                   files.size(), parts, config.string()));
    format.files.clear();
    for (const fs::path& file : files) format.files.push_back(file.string());
    files.resize(1);
  }
  if (!files.empty() || !named) return files;
  files.push_back(config.parent_path() / *named);
  if (!fs::exists(files[0])) {
    const auto record = TomlTable::read(config).find_table("record");
    throw InputError(record ? record->value_place("file") : Place{config.string()},
                     "record.file: no such file '" + files[0].string() + "'; expected a record");
  }
  return files;
}

std::vector<fs::path> require_record_files(const Values& values, const fs::path& config,
                                           const std::optional<std::string>& named, RecordFormat& format) {
  std::vector<fs::path> files = record_files(values, config, named, format);
  if (files.empty() && config.empty()) throw UsageError("which RECORD?");
  if (files.empty())
    throw UsageError("no RECORD on the command line, and no 'file' under [record] in " + config.string());
  return files;
}

std::vector<RecordRequest> record_requests(const Values& values) {
  RecordFormat format;
  format.irregular = true;
  const fs::path config = values.text("config");
  std::optional<std::string> named;
  if (!config.empty()) {
    const RecordSection section = read_record_section(config);
    format = section.format;
    named = section.file;
  }
  if (const auto window = values.from_to("window")) {
    format.window = window;
    format.window_place = {"--window"};
  }
  std::vector<RecordRequest> requests;
  for (const fs::path& file : require_record_files(values, config, named, format))
    requests.push_back({file, format});
  return requests;
}

}  // namespace beamid::apps
