#include "experiments/record/joined_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "experiments/record/read_record.hpp"
#include "experiments/signal/interpolation.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::experiments {
namespace {

using Eigen::Index, Eigen::VectorXd;

struct RecordPart {
  std::string file, stem;
  Record record;

  double start() const { return record.time[0]; }
  double end() const { return record.time[record.size() - 1]; }
};

/// What each file has: the channels that are asked of it, or all that it describes itself.
std::vector<RecordPart> parts_of(const RecordFormat& format) {
  std::vector<RecordPart> parts;
  for (std::size_t i = 0; i < format.files.size(); ++i) {
    RecordFormat one = format;
    one.files.clear();
    one.window.reset();
    one.own_clock.clear();
    std::erase_if(one.channels,
                  [&](const ColumnDescription& channel) { return channel.file != static_cast<int>(i) + 1; });
    if (one.channels.empty() && !format.channels.empty()) continue;
    const std::filesystem::path file = format.files[i];
    parts.push_back({file.string(), file.stem().string(), read_record(file, one)});
  }
  return parts;
}

/// A file's name says which sensor it is: the channel's own where several files use one name.
void name_apart(std::vector<RecordPart>& parts) {
  std::vector<std::string> names;
  for (const RecordPart& part : parts)
    for (const Channel& channel : part.record.channels) names.push_back(channel.name);
  for (RecordPart& part : parts)
    for (Channel& channel : part.record.channels)
      if (std::ranges::count(names, channel.name) > 1)
        channel.name = part.record.channels.size() == 1 ? part.stem : part.stem + " " + channel.name;
}

/// What all files have in common [s].
std::pair<double, double> common_part(const std::vector<RecordPart>& parts) {
  double from = parts.front().start(), to = parts.front().end();
  for (const RecordPart& part : parts) {
    from = std::max(from, part.start());
    to = std::min(to, part.end());
  }
  return {from, to};
}

/// Whether the stamps of all files are those of one clock.
bool share_clock(const std::vector<RecordPart>& parts) {
  constexpr double least = 0.5;  // of the shortest, in common
  double shortest = parts.front().end() - parts.front().start();
  for (const RecordPart& part : parts) shortest = std::min(shortest, part.end() - part.start());
  const auto [from, to] = common_part(parts);
  return to - from >= least * shortest;
}

/// One channel at other instants within its own.
VectorXd brought_to(const VectorXd& instants, const RecordPart& part, Index row) {
  constexpr double same = 0.02;  // of an interval
  const VectorXd& time = part.record.time;
  const Index first = std::clamp<Index>(
      std::lower_bound(time.begin(), time.end(), instants[0] - 0.5 * part.record.interval()) - time.begin(),
      0, time.size() - 1);
  if (first + instants.size() <= time.size() &&
      (time.segment(first, instants.size()) - instants).cwiseAbs().maxCoeff() < same * part.record.interval())
    return part.record.samples.row(row).segment(first, instants.size()).transpose();
  if (!part.record.samples.row(row).allFinite())
    throw InputError({part.file},
                     "readings are missing between the stamps of the other files; expected every "
                     "sample of a file whose stamps are others");
  return BandLimited(time, part.record.samples.row(row).transpose())(instants);
}

}  // namespace

Record joined_record(const RecordFormat& format) {
  constexpr Index fewest = 16;
  std::vector<RecordPart> parts = parts_of(format);
  name_apart(parts);
  Record joined;
  joined.own_clock = format.own_clock;
  joined.input_path = format.input;
  const bool one_clock = share_clock(parts);
  if (!one_clock)
    for (std::size_t i = 1; i < parts.size(); ++i) {
      parts[i].record.time.array() += parts[0].start() - parts[i].start();
      for (const Channel& channel : parts[i].record.channels) joined.own_clock.push_back(channel.name);
    }
  const auto [from, to] = common_part(parts);
  const RecordPart* fastest = &parts.front();
  for (const RecordPart& part : parts)
    if (part.record.interval() < 0.999 * fastest->record.interval()) fastest = &part;
  const VectorXd& stamps = fastest->record.time;
  const double rounding = 1e-6 * fastest->record.interval();
  const Index first = std::lower_bound(stamps.begin(), stamps.end(), from - rounding) - stamps.begin(),
              last = std::upper_bound(stamps.begin(), stamps.end(), to + rounding) - stamps.begin();
  if (last - first < fewest)
    throw InputError({format.files.front()},
                     fmt::format("{} samples in common of {} files; expected {} at least", last - first,
                                 parts.size(), fewest));
  joined.time = stamps.segment(first, last - first);
  joined.time_resolution = fastest->record.time_resolution;
  std::string others;
  for (const RecordPart& part : parts) {
    for (std::size_t c = 0; c < part.record.channels.size(); ++c) {
      joined.samples.conservativeResize(joined.samples.rows() + 1, joined.time.size());
      joined.samples.bottomRows(1) =
          brought_to(joined.time.cwiseMax(part.start()).cwiseMin(part.end()), part, static_cast<Index>(c))
              .transpose();
      joined.channels.push_back(part.record.channels[c]);
    }
    if (std::abs(part.record.interval() / fastest->record.interval() - 1.0) > 1e-3)
      others += fmt::format("; {} is brought there from {:.6g} Hz", part.stem, 1.0 / part.record.interval());
    for (const std::string& remark : part.record.remarks)
      if (std::ranges::find(joined.remarks, remark) == joined.remarks.end()) joined.remarks.push_back(remark);
    for (const std::string& warning : part.record.warnings)
      joined.warnings.push_back(part.stem + ": " + warning);
  }
  joined.remarks.push_back(fmt::format(
      "{} files joined {}: {} samples in common at {:.6g} Hz{}.", parts.size(),
      one_clock ? "by their stamps" : "from their beginnings, as their stamps have no common zero",
      joined.size(), 1.0 / joined.interval(), others));
  return joined;
}

}  // namespace beamid::experiments
