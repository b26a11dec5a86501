
#include "experiments/config/readers.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "experiments/config/experiment.hpp"
#include "experiments/config/key_tables.hpp"
#include "experiments/config/useless_keys.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/choice.hpp"
#include "experiments/text/spelling.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {

std::string expected_place(const fem::Structure& structure) {
  constexpr std::size_t most_shown = 8;
  std::vector<std::string> places = fem::place_names(structure);
  const std::size_t count = places.size();
  places.resize(std::min(count, most_shown));
  return fmt::format("one of the places {}{}", joined(places),
                     count > most_shown ? fmt::format(", ... ({} in all)", count) : "");
}

std::string read_place(const TomlTable& table, const fem::Structure& structure, bool needed,
                       const std::string& at, const std::string& position) {
  if (structure.has_positions()) {
    refuse_useless(table, {at}, std::string("for a ") + structure.kind(), position);
    return {};
  }
  refuse_useless(table, {position}, std::string("for a ") + structure.kind() + ", whose places have names",
                 at + ", " + expected_place(structure));
  const auto name = table.find_text(at);
  if (!name) {
    if (needed) table.miss(at, expected_place(structure));
    return {};
  }
  const std::vector<std::string> places = fem::place_names(structure);
  if (std::find(places.begin(), places.end(), *name) == places.end()) {
    const auto meant = nearest(*name, places);
    table.refuse(at, expected_place(structure) + (meant ? "; did you mean '" + *meant + "'?" : ""));
  }
  return *name;
}

namespace {

// The tables [[record.prepare]] of an experiment file.

const KeyTable& step_keys() {
  static const Schema<Choice> keys =
      Schema<Choice>("record.prepare")
          .with_options()
          .other("step", Key::Type::text, "a name from `beamid list steps`", "\"high_pass\"")
          .required("a name from `beamid list steps`");
  return keys;
}

const bool step_keys_registered = register_keys(step_keys);

/// The steps in the order of the file, every one with all of its options.
/// @param record the table [record]
/// @throws InputError at an unknown step, at a bad option, or at the step that misses one.
std::vector<Choice> read_preparation(const TomlTable& record) {
  std::vector<Choice> steps;
  for (const TomlTable& table : record.find_tables("prepare")) {
    if (!table.contains("step")) table.miss("step", step_keys().find("step")->missing);
    const Choice choice = read_choice(table, "step", "", step_registry());
    at_place(choice.place, [&] {
      try {
        step_registry().make(choice.name, choice.options)->check();
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("step '" + choice.name + "': " + error.what());
      }
    });
    steps.push_back(choice);
  }
  return steps;
}

constexpr int most_columns = 100000, most_header_lines = 1000000;

/// [record] as a file has it: its stamps are taken as they are unless it says otherwise.
struct DescribedRecord : RecordFormat {
  std::optional<std::string> file;
  DescribedRecord() { irregular = true; }
};

const Schema<DescribedRecord>& record_keys() {
  using R = DescribedRecord;
  static const Schema<R> keys =
      Schema<R>("record")
          .key("file", &R::file, "the record, relative to this file; a command may name another",
               "\"massa1_test1-1.txt\"")
          .key("files", &R::files,
               "in place of `file`: several files of one record, joined by their stamps; a channel names its "
               "own "
               "by `file`. As many arguments RECORD on the command line take their place",
               "[\"ground.csv\", \"floor_1.csv\"]")
          .key("reader", &R::reader, "a name from `beamid list readers`", "\"lvm\"")
          .fallback("what the file shows to be")
          .choice("separator", &R::separator,
                  {std::pair{"auto", '\0'},
                   {"tab", '\t'},
                   {"comma", ','},
                   {"semicolon", ';'},
                   {"bar", '|'},
                   {"space", ' '}},
                  "between columns; auto takes the first of tab, semicolon, bar, comma that the first row of "
                  "numbers shows, else blanks",
                  "\"semicolon\"")
          .choice("decimal", &R::decimal, {std::pair{"auto", '\0'}, {"point", '.'}, {"comma", ','}},
                  "between whole and fraction; auto takes the comma where the first fifty rows show commas "
                  "inside fields and no point",
                  "\"comma\"")
          .key("header_lines", &R::header_lines, {0, most_header_lines},
               "lines before the first row of numbers, the last non-blank of which names the columns; with 0 "
               "one line of names is found by itself",
               "23")
          .choice(
              "malformed", &R::malformed,
              {std::pair{"refuse", MalformedRows::refuse},
               {"skip", MalformedRows::skip},
               {"missing", MalformedRows::as_missing}},
              "rows with text among the numbers or of another length: refused at their place, or omitted, "
              "counted and located; `\"missing\"` takes cells that are empty, `nan`, `na` or `null`, and "
              "rows "
              "that times printed to whole intervals lack, for samples that were not read, and refuses the "
              "rest",
              "\"skip\"")
          .choice(
              "missing_input", &R::missing_input,
              {std::pair{"refuse", MissingInput::refuse},
               {"leave_out", MissingInput::leave_out},
               {"zero", MissingInput::zero}},
              "samples that a measured force or base acceleration lacks: refused by what needs them; the "
              "longest stretch in which every input is known is used, and reported; or 0, a force that does "
              "not act where it was not recorded",
              "\"leave_out\"")
          .choice("stamps", &R::irregular, {std::pair{"even", false}, {"as_they_are", true}},
                  "whether the times must have equal intervals or may only increase. Filters take unequal "
                  "ones as they are, what needs even samples resamples the record and reports it "
                  "([Preparation](theory/preparation.md))",
                  "\"even\"")
          .choice("input", &R::input,
                  {std::pair{"band_limited", InputPath::band_limited},
                   {"linear", InputPath::linear},
                   {"held", InputPath::held}},
                  "how measured forces run between their samples: as an anti-aliased converter has recorded "
                  "them, straight, or constant until the next one, which makes them late by half an interval "
                  "([theory](theory/discretisation_bias.md#the-bias-of-a-measured-force))",
                  "\"linear\"")
          .fallback("`\"band_limited\"` where at least half of the stamps are even, else `\"linear\"`")
          .key("own_clock", &R::own_clock,
               "channels, by name or quantity, that another clock has stamped: `identify` and `compare` find "
               "the lag of each with the parameters ([theory](theory/own_clocks.md)); others refuse such a "
               "record",
               "[\"acceleration_x9m\"]")
          .key("sampling_rate_hz", &R::sampling_rate, positive,
               "exact rate; times are then start + k / rate. Refused where a printed time is half an "
               "interval, its rounding set aside, from there",
               "1651.612903")
          .fallback("from the printed times")
          .key("window_s", &R::window, "part of the record to use, [from, to]", "[0.808, 1.608]")
          .fallback(
              "whole record; `identify`: the decay behind the last event, between knocks and behind clipped "
              "readings")
          .tables({"time"}, Key::Type::table)
          .tables({"channels", "prepare"});
  return keys;
}

/// One column: its number or name, and its unit.
struct DescribedColumn {
  std::string quantity, unit, place;
  std::optional<double> position, distance;
  double noise = 0.0;
  int file = 1;
};

std::string quoted_symbols(const std::vector<Unit>& known, const char* separator) {
  std::string text;
  for (const std::string& symbol : symbols(known))
    text += (text.empty() ? "" : separator) + ("`\"" + symbol + "\"`");
  return text;
}

Schema<DescribedColumn> make_time_keys() {
  const std::string all = quoted_symbols(time_units(), ", ");
  return Schema<DescribedColumn>("record.time")
      .other("column", Key::Type::column, "the column's number, or its name in the header", "1",
             {1, most_columns})
      .required()
      .key("unit", &DescribedColumn::unit, "unit of time", "\"s\"")
      .fallback("-")
      .values(all.c_str());
}

Schema<DescribedColumn> make_channel_keys() {
  using C = DescribedColumn;
  std::vector<std::string> quantities;
  std::string all;
  for (const Quantity quantity : all_quantities) {
    quantities.emplace_back(to_string(quantity));
    all += (all.empty() ? "" : "; ") + quantities.back() + " " + quoted_symbols(units(quantity), " ");
  }
  return Schema<C>("record.channels")
      .key("quantity", &C::quantity, "what the channel measures", "\"acceleration\"")
      .one_of(quantities)
      .required()
      .other("column", Key::Type::column, "the column's number, or its name in the header", "3",
             {1, most_columns})
      .required()
      .key("file", &C::file, {1, most_columns}, "which of `files` has it, from 1", "2")
      .key("unit", &C::unit, "unit of its numbers", "\"g\"")
      .fallback("-")
      .values(all.c_str())
      .key("position_m", &C::position, on_beam, "where its sensor sits, or where the force acts", "0.35")
      .fallback("the tip, or midspan where the tip is held; none for strain")
      .key("at", &C::place, "in place of `position_m`, of a frame or a system: its place by name",
           "\"ridge.x\"")
      .key("distance_m", &C::distance, "strain: of the gauge from the axis, c of -c w''", "0.003")
      .values("number, not 0")
      .fallback("half the section's height")
      .key(
          "noise", &C::noise, positive,
          "standard deviation of its white noise, in `unit`. Of an input: its samples are taken as uncertain "
          "by as much ([theory](theory/parts_of_structures.md#inputs-that-are-not-exact))",
          "0.02")
      .fallback("that of `[noise]`; an input is exact");
}

const Schema<DescribedColumn>& time_keys() {
  static const Schema<DescribedColumn> keys = make_time_keys();
  return keys;
}

const Schema<DescribedColumn>& channel_keys() {
  static const Schema<DescribedColumn> keys = make_channel_keys();
  return keys;
}

const bool record_keys_registered[] = {register_keys([]() -> const KeyTable& { return record_keys(); }),
                                       register_keys([]() -> const KeyTable& { return time_keys(); }),
                                       register_keys([]() -> const KeyTable& { return channel_keys(); })};

/// @param quantity that is measured; absent: time
double factor_of(const TomlTable& table, std::optional<Quantity> quantity) {
  const std::string expected = fmt::format("a unit of {}: {}", quantity ? to_string(*quantity) : "time",
                                           joined(symbols(quantity ? units(*quantity) : time_units())));
  if (!table.contains("unit")) table.miss("unit", expected);
  const auto factor = unit_factor(*table.find_text("unit"), quantity);
  if (!factor) table.refuse("unit", expected);
  return *factor;
}

ColumnDescription read_column(const TomlTable& table) {
  ColumnDescription column;
  const auto value = table.find_value("column");
  if (!value) table.miss("column", time_keys().find("column")->expected());
  if (std::holds_alternative<double>(*value))
    column.number = static_cast<int>(std::get<double>(*value));
  else
    column.name = std::get<std::string>(*value);
  return column;
}

/// @param structure that the sensors sit on; null where none is described: positions are then taken as they
/// are.
ColumnDescription read_channel(const TomlTable& table, const fem::Structure* structure) {
  const DescribedColumn given =
      structure ? channel_keys().read(table, structure->extent()) : channel_keys().read(table);
  ColumnDescription channel = read_column(table);
  channel.quantity = *find_quantity(given.quantity);
  channel.factor = factor_of(table, channel.quantity);
  channel.position = given.position;
  channel.distance = given.distance.value_or(0.0);
  channel.place = given.place;
  channel.noise = given.noise;
  channel.file = given.file;
  if (structure != nullptr) {
    channel.place = read_place(table, *structure, false);
    check_gauge_position(table, *structure, channel.quantity);
    channel.distance = gauge_distance(table, *structure, channel.quantity, channel.position, given.distance);
  }
  return channel;
}

DescribedRecord read_described(const TomlTable& table, const fem::Structure* structure) {
  check_values(table, "record");
  DescribedRecord record = record_keys().read(table);
  if (record.file && record.file->empty()) table.refuse("file", "the name of a file");
  if (record.file && !record.files.empty()) table.refuse("files", "either file or files");
  if (!record.files.empty()) {
    const std::filesystem::path folder = std::filesystem::path(table.value_place("files").file).parent_path();
    record.file = record.files.front();
    for (std::string& file : record.files) file = (folder / file).string();
  }
  if (!record.reader.empty())
    at_place(table.value_place("reader"), [&] { record_reader_registry().find(record.reader); });
  if (record.window) record.window_place = table.value_place("window_s");
  if (const auto time = table.find_table("time")) {
    record.time = read_column(*time);
    record.time->factor = factor_of(*time, {});
  }
  for (const TomlTable& channel : table.find_tables("channels")) {
    record.channels.push_back(read_channel(channel, structure));
    if (!record.files.empty() && record.channels.back().file > static_cast<int>(record.files.size()))
      channel.refuse("file", "one of the " + std::to_string(record.files.size()) + " files");
  }
  record.preparation = read_preparation(table);
  return record;
}

}  // namespace

RecordSection read_record_section(const TomlTable& table, const fem::Structure* structure) {
  const DescribedRecord record = read_described(table, structure);
  return {record.file, record};
}

RecordSection read_record_section(const std::filesystem::path& file) {
  const TomlTable root = TomlTable::read(file);
  refuse_unknown_keys(root);
  const TomlTable record = root.table("record");
  if (!root.contains("beam")) return read_record_section(record, nullptr);
  const fem::Structure beam = read_beam(root.table("beam"));
  return read_record_section(record, &beam);
}

}  // namespace beamid::experiments
