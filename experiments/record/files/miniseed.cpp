// Traces of seismological networks: MiniSEED, through libmseed [miniseed], the text of their services (SLIST,
// TSPAIR), and GSE2 (INT, CM6).
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
  double rate = 0.0;   ///< [Hz]
  std::vector<double> values = {};
};

/// Channels of one rate on one grid of instants; what is missing between the segments of one is NaN.
void add_on_grids(std::vector<Segment> segments, int digits, CollectedSignals& signals) {
  constexpr double alike = 1e-4;
  while (!segments.empty()) {
    const double rate = segments.front().rate;
    const auto others = std::stable_partition(segments.begin(), segments.end(), [&](const Segment& one) {
      return std::abs(one.rate / rate - 1.0) <= alike;
    });
    const double start = std::min_element(segments.begin(), others, [](const Segment& a, const Segment& b) {
                           return a.start < b.start;
                         })->start;
    const auto place = [&](const Segment& one) {  // years apart in a damaged file
      return static_cast<std::size_t>(std::min((one.start - start) * rate + 0.5, 1e15));
    };
    std::size_t length = 0;
    for (auto one = segments.begin(); one != others; ++one)
      length = std::max(length, place(*one) + one->values.size());
    std::map<std::string, CollectedSignals::Signal> channels;
    for (auto one = segments.begin(); one != others; ++one) {
      const auto [channel, added] = channels.try_emplace(one->name);
      if (added) {
        signals.announce(one->name, {length});
        channel->second = {one->name, one->unit,
                           std::vector<double>(length, std::numeric_limits<double>::quiet_NaN()), digits};
      }
      std::ranges::copy(one->values,
                        channel->second.values.begin() + static_cast<std::ptrdiff_t>(place(*one)));
    }
    for (auto& [name, signal] : channels) {
      signals.add(name, signal.unit, std::move(signal.values), digits);
      signals.set(name + "/sample_rate", rate);
    }
    segments.erase(segments.begin(), others);
  }
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
  std::vector<Segment> segments;
  for (MSTrace* trace = group->traces; trace != nullptr; trace = trace->next) {
    if (trace->numsamples <= 0) continue;
    if (!(trace->samprate > 0.0) || mst_convertsamples(trace, 'd', 0) != 0)
      throw refuse(name_of_trace(*trace) + " holds no samples at a rate", "numbers at a sampling rate");
    const auto apart = static_cast<double>(static_cast<std::int64_t>(
        static_cast<std::uint64_t>(trace->starttime) - static_cast<std::uint64_t>(group->traces->starttime)));
    const auto* const samples = static_cast<const double*>(trace->datasamples);
    segments.push_back({name_of_trace(*trace),
                        "",
                        apart / static_cast<double>(HPTMODULUS),
                        trace->samprate,
                        {samples, samples + trace->numsamples}});
  }
  if (segments.empty()) throw refuse("no samples", "records of samples");
  add_on_grids(std::move(segments), 15, signals);
}

/// Reads the lines of a text; errors state the line.
class TraceLines {
 public:
  TraceLines(std::istream& stream, const CollectedSignals& signals) : stream_(stream), signals_(signals) {}

  bool next() {
    if (!std::getline(stream_, line_)) return false;
    ++number_;
    if (line_.ends_with('\r')) line_.pop_back();
    return true;
  }

  const std::string& line() const { return line_; }
  std::size_t number() const { return number_; }

  InputError refuse(const std::string& found, const std::string& expected, std::size_t line = 0) const {
    return {{signals_.file(), line == 0 ? number_ : line, 0}, found + "; expected " + expected};
  }

  /// Appends the numbers of the line. @param instant whether it begins with one
  void take_numbers(bool instant, std::vector<double>& values) const {
    std::istringstream fields(line_);
    std::string field;
    if (instant) fields >> field;
    while (fields >> field) {
      const ParsedNumber found = parse_number(field);
      if (!found.number) throw refuse("'" + field + "'", "a number");
      values.push_back(found.value);
    }
  }

 private:
  std::istream& stream_;
  const CollectedSignals& signals_;
  std::string line_;
  std::size_t number_ = 0;
};

/// A segment that begins with the line. @param rate text of [Hz]
Segment segment_of(const TraceLines& lines, std::string name, std::string unit, const std::string& instant,
                   std::string_view rate) {
  const auto stamp = parse_stamp(instant);
  const ParsedNumber own = parse_number(rate);
  if (!stamp || !own.finite || !(own.value > 0.0))
    throw lines.refuse("a trace without its rate or start", "samples, rate and an instant");
  return {std::move(name), std::move(unit), stamp->seconds, own.value};
}

std::size_t stated_count(std::string_view text, const TraceLines& lines) {
  const double count = parse_number(text).value;
  if (!(count >= 1.0 && count < 1e9))
    throw lines.refuse(fmt::format("'{}'", text), "the number of the samples that follow");
  return static_cast<std::size_t>(count);
}

constexpr std::string_view services = "TIMESERIES ";

/// Traces, each behind a line such as
/// "TIMESERIES IU_ANMO_00_BHZ_M, 3600 samples, 20 sps, 2010-02-27T06:30:00.069538, SLIST, FLOAT, M/S":
/// numbers, or instant and number in a line (TSPAIR).
void collect_text(TraceLines& lines, CollectedSignals& signals) {
  static const std::regex form(
      "TIMESERIES ([^,]*), *([0-9]{1,9}) samples, *([-+.0-9eE]+) sps, *([^,]*), *(SLIST|TSPAIR), *[^,]*(?:, "
      "*(.*))?");
  std::vector<Segment> segments;
  bool pairs = false;
  std::size_t count = 0, header = 0;
  const auto finish = [&] {
    if (!segments.empty() && segments.back().values.size() != count)
      throw lines.refuse(fmt::format("{} numbers follow", segments.back().values.size()),
                         fmt::format("{}, as this line states", count), header);
  };
  while (lines.next()) {
    if (!lines.line().starts_with(services)) {
      lines.take_numbers(pairs, segments.back().values);
      continue;
    }
    finish();
    std::smatch match;
    if (!std::regex_match(lines.line(), match, form))
      throw lines.refuse("a trace without its rate or start", "samples, rate and an instant");
    const std::string unit = folded(match[6].str()), name = match[1];
    const std::size_t end = name.rfind('_'), from = end == 0 ? 0 : name.rfind('_', end - 1);
    const bool has_unit = stated_unit(unit).has_value();
    const bool has_code = !has_unit && end != std::string::npos && from != std::string::npos;
    const char* const quantity =
        has_code ? quantity_of(std::string_view(name).substr(from + 1, end - from - 1)) : "";
    segments.push_back(segment_of(lines, quantity + name, has_unit || unit == "counts" ? unit : "",
                                  match[4].str(), match[3].str()));
    pairs = match[5] == "TSPAIR", header = lines.number(), count = stated_count(match[2].str(), lines);
    signals.announce(name, {count});
  }
  finish();
  add_on_grids(std::move(segments), 9, signals);
}

/// Second differences in characters of six bits: a sign, whether more follow, four or five bits of the
/// number.
std::vector<double> from_cm6(std::string_view text, const TraceLines& lines) {
  constexpr std::string_view alphabet = "+-0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
  constexpr std::size_t more = 32, sign = 16;
  std::vector<double> values;
  double slope = 0.0, value = 0.0;
  for (std::size_t at = 0; at < text.size();) {
    const auto bits = [&] {
      const std::size_t found = at < text.size() ? alphabet.find(text[at]) : alphabet.npos;
      if (found == alphabet.npos)
        throw lines.refuse("a character that CM6 does not have", "an undamaged waveform");
      ++at;
      return found;
    };
    std::size_t letter = bits();
    const bool negative = (letter & sign) != 0;
    double number = static_cast<double>(letter % sign);
    while ((letter & more) != 0) letter = bits(), number = 32.0 * number + static_cast<double>(letter % more);
    slope += negative ? -number : number, value += slope;
    values.push_back(value);
  }
  return values;
}

/// The sum that GSE2 states behind the samples, of eight digits.
double checksum_of(const std::vector<double>& values) {
  constexpr double modulus = 1e8;
  double sum = 0.0;
  for (const double value : values) sum = std::fmod(sum + std::fmod(value, modulus), modulus);
  return std::abs(sum);
}

/// "WID2 2009/05/18 06:47:20.255 RNHA  EHN      CM6      750  200.000000 ...", "DAT2", the samples, "CHK2
/// sum". @returns the traces whose sum is another
std::vector<std::string> collect_gse2(TraceLines& lines, CollectedSignals& signals) {
  std::vector<Segment> segments;
  std::vector<std::string> damaged;
  std::string format, compressed;
  bool samples = false;
  std::size_t count = 0;
  const auto finish = [&](double sum) {
    if (!samples) return;
    samples = false;
    std::vector<double>& values = segments.back().values;
    if (format == "CM6") values = from_cm6(compressed, lines);
    if (values.size() != count)
      throw lines.refuse(fmt::format("{} has {} samples", segments.back().name, values.size()),
                         fmt::format("{}, as its header states", count));
    if (sum != checksum_of(values)) damaged.push_back(segments.back().name);
  };
  while (lines.next()) {
    const std::string& line = lines.line();
    if (line.starts_with("WID2 ")) {
      const auto field = [&](std::size_t from, std::size_t length) {
        return from < line.size() ? std::string(trimmed(std::string_view(line).substr(from, length)))
                                  : std::string();
      };
      finish(-1.0);
      format = field(44, 3);
      if (format != "INT" && format != "CM6")
        throw lines.refuse("a waveform in the form '" + format + "'", "INT or CM6");
      std::istringstream numbers(line.substr(47));  // samples and rate: some write them a few columns off
      std::string length, rate;
      numbers >> length >> rate;
      segments.push_back(segment_of(lines, field(29, 5) + "_" + field(35, 3), "counts",
                                    field(5, 10) + " " + field(16, 12), rate));
      count = stated_count(length, lines);
      signals.announce(segments.back().name, {count});
    } else if (line.starts_with("DAT2") && !segments.empty()) {
      samples = true, compressed.clear();
    } else if (line.starts_with("CHK2")) {
      finish(parse_number(trimmed(std::string_view(line).substr(4))).value);
    } else if (samples && format == "CM6") {
      compressed += trimmed(line);
    } else if (samples) {
      lines.take_numbers(false, segments.back().values);
    }
  }
  finish(-1.0);
  if (segments.empty()) throw lines.refuse("no waveform", "WID2 and DAT2");
  add_on_grids(std::move(segments), 15, signals);
  return damaged;
}

bool is_text_of_services(std::string_view beginning) {
  return beginning.starts_with(services) && beginning.find(" sps,") != std::string_view::npos &&
         (beginning.find("SLIST,") != std::string_view::npos ||
          beginning.find("TSPAIR,") != std::string_view::npos);
}

bool is_gse2(std::string_view beginning) {
  return (beginning.starts_with("WID2 ") || beginning.find("\nWID2 ") != std::string_view::npos) &&
         beginning.find("DAT2") != std::string_view::npos;
}

class MiniSeedReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    if (is_text_of_services(beginning) || is_gse2(beginning)) return true;
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
    std::ifstream stream = open_input(file, "a text of traces");
    std::string beginning(1024, '\0');
    stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    beginning.resize(static_cast<std::size_t>(stream.gcount()));
    stream.clear(), stream.seekg(0);
    if (const bool gse2 = is_gse2(beginning); gse2 || is_text_of_services(beginning)) {
      CollectedSignals signals(file.string(), reading_limits(bytes).numbers);
      TraceLines lines(stream, signals);
      std::vector<std::string> damaged;
      if (gse2)
        damaged = collect_gse2(lines, signals);
      else
        collect_text(lines, signals);
      RecordTable table = signals.table(format);
      for (const std::string& name : damaged)
        table.warnings.push_back("The checksum of " + name +
                                 " is that of other samples: the file may be damaged.");
      return table;
    }
    RecordTable table =
        read_apart(file.string(), "libmseed", reading_limits(bytes), collect_traces).table(format);
    table.remarks.emplace_back("MiniSEED states no unit: its signals are the counts of the file.");
    return table;
  }
};

const bool miniseed_registered = record_reader_registry().add(
    {"miniseed",
     "MiniSEED of seismological networks, the text of their services (SLIST, TSPAIR) and GSE2: a signal for "
     "each channel, in counts where no unit is stated, gaps as missing samples",
     "[miniseed]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<MiniSeedReader>(); }});

}  // namespace
}  // namespace beamid::experiments
