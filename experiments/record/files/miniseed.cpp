// MiniSEED, the format of seismological networks, through libmseed [miniseed], and the text of their
// services.
#include <fmt/format.h>
#include <libmseed.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <sstream>

#include <needed_library.hpp>
#include "experiments/record/read_apart.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/record/stamps.hpp"
#include "experiments/record/units.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

constexpr NeededLibrary libmseed{"libmseed.so.2", "libmseed2"};
BEAMID_NEEDED(libmseed, ms_readtraces);
BEAMID_NEEDED(libmseed, ms_errorstr);
BEAMID_NEEDED(libmseed, mst_convertsamples);

/// "acceleration ": the second letter of a channel's code says what its instrument measures.
const char* quantity_of(std::string_view channel) {
  const char instrument = channel.size() < 2 ? '\0' : channel[1];
  return instrument == 'N' ? "acceleration " : instrument == 'H' || instrument == 'L' ? "velocity " : "";
}

/// "acceleration IU.ANMO.00.HNZ".
std::string name_of_trace(const MSTrace& trace) {
  return fmt::format("{}{}.{}.{}.{}", quantity_of(trace.channel), trace.network, trace.station,
                     trace.location, trace.channel);
}

/// Successive samples of one channel.
struct Segment {
  std::string name, unit;
  double start = 0.0;  ///< behind an instant that is common to all [s]
  std::vector<double> values;
};

/// Every channel on one grid of instants; what is missing between its segments is NaN.
void add_on_one_grid(const std::vector<Segment>& segments, double rate, int digits,
                     CollectedSignals& signals) {
  const double start = std::ranges::min(segments, {}, &Segment::start).start;
  const auto place = [&](const Segment& one) {  // years apart in a damaged file
    return static_cast<std::size_t>(std::min((one.start - start) * rate + 0.5, 1e15));
  };
  std::size_t length = 0;
  for (const Segment& one : segments) length = std::max(length, place(one) + one.values.size());
  std::map<std::string, CollectedSignals::Signal> channels;
  for (const Segment& one : segments) {
    const auto [channel, added] = channels.try_emplace(one.name);
    if (added) {
      signals.announce(one.name, {length});
      channel->second = {one.name, one.unit,
                         std::vector<double>(length, std::numeric_limits<double>::quiet_NaN()), digits};
    }
    std::ranges::copy(one.values, channel->second.values.begin() + static_cast<std::ptrdiff_t>(place(one)));
  }
  for (auto& [name, signal] : channels) signals.add(name, signal.unit, std::move(signal.values), digits);
  signals.set("sample_rate", rate);
}

void collect_traces(CollectedSignals& signals) {
  MSTraceGroup* group = nullptr;
  const int failure = ms_readtraces(&group, signals.file().c_str(), -1, -1.0, -1.0, 0, 1, 1, 0);
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    return InputError({signals.file(), 0, 0}, found + "; expected " + expected);
  };
  if (failure != MS_NOERROR || group == nullptr || group->traces == nullptr)
    throw refuse(fmt::format("no MiniSEED that libmseed reads ({})", ms_errorstr(failure)),
                 "records of samples");
  double rate = 0.0;
  std::vector<Segment> segments;
  for (MSTrace* trace = group->traces; trace != nullptr; trace = trace->next) {
    if (trace->numsamples <= 0) continue;
    if (!(trace->samprate > 0.0) || mst_convertsamples(trace, 'd', 0) != 0)
      throw refuse(name_of_trace(*trace) + " holds no samples at a rate", "numbers at a sampling rate");
    if (rate == 0.0) rate = trace->samprate;
    if (std::abs(trace->samprate / rate - 1.0) > 1e-4)
      throw refuse(fmt::format("channels at {:g} and {:g} Hz", rate, trace->samprate), "one rate in a file");
    const auto apart = static_cast<double>(static_cast<std::int64_t>(
        static_cast<std::uint64_t>(trace->starttime) - static_cast<std::uint64_t>(group->traces->starttime)));
    const auto* const samples = static_cast<const double*>(trace->datasamples);
    segments.push_back({name_of_trace(*trace),
                        "",
                        apart / static_cast<double>(HPTMODULUS),
                        {samples, samples + trace->numsamples}});
  }
  if (segments.empty()) throw refuse("no samples", "records of samples");
  add_on_one_grid(segments, rate, 15, signals);
}

constexpr std::string_view text_beginning = "TIMESERIES ";

/// Traces of a text, each behind a line such as
/// "TIMESERIES IU_ANMO_00_BHZ_M, 3600 samples, 20 sps, 2010-02-27T06:30:00.069538, SLIST, FLOAT, M/S":
/// numbers, or instant and number in a line (TSPAIR).
void collect_text(std::istream& lines, CollectedSignals& signals) {
  static const std::regex form(
      "TIMESERIES ([^,]*), *([0-9]{1,9}) samples, *([-+.0-9eE]+) sps, *([^,]*), *(SLIST|TSPAIR), *[^,]*(?:, "
      "*(.*))?");
  const auto refuse = [&](std::size_t line, const std::string& found, const std::string& expected) {
    return InputError({signals.file(), line, 0}, found + "; expected " + expected);
  };
  std::vector<Segment> segments;
  double rate = 0.0;
  bool pairs = false;
  std::size_t count = 0, number = 0, header = 0;
  const auto finish = [&] {
    if (!segments.empty() && segments.back().values.size() != count)
      throw refuse(header, fmt::format("{} numbers follow", segments.back().values.size()),
                   fmt::format("{}, as this line states", count));
  };
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.ends_with('\r')) line.pop_back();
    if (std::smatch match; line.starts_with(text_beginning)) {
      finish();
      const auto stamp = std::regex_match(line, match, form) ? parse_stamp(match[4].str()) : std::nullopt;
      const double own = stamp ? parse_number(match[3].str()).value : 0.0;
      if (!(own > 0.0))
        throw refuse(number, "a trace without its rate or start", "samples, sps and an instant");
      if (rate > 0.0 && std::abs(own / rate - 1.0) > 1e-4)
        throw refuse(number, fmt::format("channels at {:g} and {:g} Hz", rate, own), "one rate in a file");
      rate = own, pairs = match[5] == "TSPAIR", header = number;
      count = static_cast<std::size_t>(parse_number(match[2].str()).value);
      signals.announce(match[1], {count});
      const std::string unit = folded(match[6].str()), name = match[1];
      const std::size_t end = name.rfind('_'), from = end == 0 ? 0 : name.rfind('_', end - 1);
      const bool has_unit = stated_unit(unit).has_value();
      segments.push_back({(has_unit || end == std::string::npos || from == std::string::npos
                               ? ""
                               : quantity_of(std::string_view(name).substr(from + 1, end - from - 1))) +
                              name,
                          has_unit ? unit : "",
                          stamp->seconds,
                          {}});
      continue;
    }
    std::istringstream fields(line);
    std::string field;
    if (pairs) fields >> field;
    while (fields >> field) {
      const ParsedNumber found = parse_number(field);
      if (!found.number) throw refuse(number, "'" + field + "'", "a number");
      segments.back().values.push_back(found.value);
    }
  }
  finish();
  add_on_one_grid(segments, rate, 9, signals);
}

class MiniSeedReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    if (beginning.starts_with(text_beginning) && beginning.find(" sps,") != std::string_view::npos &&
        (beginning.find("SLIST,") != std::string_view::npos ||
         beginning.find("TSPAIR,") != std::string_view::npos))
      return true;
    constexpr std::size_t fixed_header = 48;
    if (beginning.size() < fixed_header) return false;
    for (const char letter : beginning.substr(0, 6))
      if (letter != ' ' && letter != '\0' && !std::isdigit(static_cast<unsigned char>(letter))) return false;
    return std::string_view("DRQM").find(beginning[6]) != std::string_view::npos &&
           (beginning[7] == ' ' || beginning[7] == '\0') &&
           beginning.find_first_of(std::string_view("\0\1\2\3\4", 5)) != beginning.npos;
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const override {
    const std::size_t bytes = count_bytes(file, "a MiniSEED file");
    std::ifstream stream = open_input(file, "a MiniSEED file");
    if (stream.peek() == text_beginning.front()) {
      CollectedSignals signals(file.string(), reading_limits(bytes).numbers);
      collect_text(stream, signals);
      return signals.table(format);
    }
    RecordTable table =
        read_apart(file.string(), "libmseed", reading_limits(bytes), collect_traces).table(format);
    table.remarks.emplace_back("MiniSEED states no unit: its signals are the counts of the file.");
    return table;
  }
};

const bool miniseed_registered = record_reader_registry().add(
    {"miniseed",
     "MiniSEED of seismological networks and the text of their services (SLIST, TSPAIR): a signal for each "
     "channel, in counts where no unit is stated, gaps as missing samples",
     "[miniseed]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<MiniSeedReader>(); }});

}  // namespace
}  // namespace beamid::experiments
