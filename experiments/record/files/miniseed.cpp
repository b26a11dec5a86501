// MiniSEED, the format of seismological networks, through libmseed [miniseed].
#include <fmt/format.h>
#include <libmseed.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include <needed_library.hpp>
#include "experiments/record/read_apart.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

constexpr NeededLibrary libmseed{"libmseed.so.2", "libmseed2"};
BEAMID_NEEDED(libmseed, ms_readtraces);
BEAMID_NEEDED(libmseed, ms_errorstr);
BEAMID_NEEDED(libmseed, mst_convertsamples);

/// "acceleration IU.ANMO.00.HNZ": the second letter of a channel's code says what its instrument measures.
std::string name_of_trace(const MSTrace& trace) {
  const char instrument = trace.channel[0] == '\0' ? '\0' : trace.channel[1];
  const char* const quantity = instrument == 'N'                        ? "acceleration "
                               : instrument == 'H' || instrument == 'L' ? "velocity "
                                                                        : "";
  return fmt::format("{}{}.{}.{}.{}", quantity, trace.network, trace.station, trace.location, trace.channel);
}

/// Every channel on one grid of instants; what is missing between its traces is NaN.
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
  hptime_t start = std::numeric_limits<hptime_t>::max(), end = std::numeric_limits<hptime_t>::min();
  for (MSTrace* trace = group->traces; trace != nullptr; trace = trace->next) {
    if (trace->numsamples <= 0) continue;
    if (!(trace->samprate > 0.0) || mst_convertsamples(trace, 'd', 0) != 0)
      throw refuse(name_of_trace(*trace) + " holds no samples at a rate", "numbers at a sampling rate");
    if (rate == 0.0) rate = trace->samprate;
    if (std::abs(trace->samprate / rate - 1.0) > 1e-4)
      throw refuse(fmt::format("channels at {:g} and {:g} Hz", rate, trace->samprate), "one rate in a file");
    start = std::min(start, trace->starttime);
    end = std::max(end, trace->endtime);
  }
  if (rate == 0.0) throw refuse("no samples", "records of samples");
  const auto place = [&](hptime_t instant) {  // years apart in a damaged file
    const auto apart =
        static_cast<double>(static_cast<std::uint64_t>(instant) - static_cast<std::uint64_t>(start));
    return static_cast<std::size_t>(std::min(apart / static_cast<double>(HPTMODULUS) * rate + 0.5, 1e15));
  };
  const std::size_t length = place(end) + 1;
  std::map<std::string, std::vector<double>> channels;
  for (MSTrace* trace = group->traces; trace != nullptr; trace = trace->next) {
    if (trace->numsamples <= 0) continue;
    const auto [channel, added] = channels.try_emplace(name_of_trace(*trace));
    if (added) {
      signals.announce(channel->first, {length});
      channel->second.assign(length, std::numeric_limits<double>::quiet_NaN());
    }
    const std::size_t from = place(trace->starttime);
    const auto* const samples = static_cast<const double*>(trace->datasamples);
    for (std::size_t k = 0; k < static_cast<std::size_t>(trace->numsamples) && from + k < length; ++k)
      channel->second[from + k] = samples[k];
  }
  for (auto& [name, values] : channels) signals.add(name, "", std::move(values), 15);
  signals.set("sample_rate", rate);
}

class MiniSeedReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
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
    RecordTable table =
        read_apart(file.string(), "libmseed", reading_limits(bytes), collect_traces).table(format);
    table.remarks.emplace_back("MiniSEED states no unit: its signals are the counts of the file.");
    return table;
  }
};

const bool miniseed_registered = record_reader_registry().add(
    {"miniseed",
     "MiniSEED of seismological networks: a signal for each channel, in counts, gaps as missing samples",
     "[miniseed]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<MiniSeedReader>(); }});

}  // namespace
}  // namespace beamid::experiments
