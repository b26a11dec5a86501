// TDMS files of National Instruments [tdms]: channels with their scales, units and sampling interval.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "experiments/record/files/tdms/segments.hpp"
#include "experiments/record/read_apart.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

/// y = c_0 + c_1 x + c_2 x^2 + ...
using TdmsScale = std::vector<double>;

/// NI_Scale[k]_Linear_Slope, ..._Linear_Y_Intercept, or ..._Polynomial_Coefficients[i].
/// @returns nothing for one of another kind, or without its numbers.
TdmsScale tdms_scale(const TdmsObject& owner, const std::string& key, const std::string& type) {
  constexpr double most = 64.0;
  TdmsScale scale;
  if (type == "Linear")
    scale = {owner.number(key + "Linear_Y_Intercept"), owner.number(key + "Linear_Slope")};
  if (type == "Polynomial") {
    const double stated = owner.number(key + "Polynomial_Coefficients_Size"),
                 size = std::isnan(stated) ? 4.0 : stated;
    for (std::size_t i = 0; static_cast<double>(i) < size && size <= most; ++i)
      scale.push_back(owner.number(fmt::format("{}Polynomial_Coefficients[{}]", key, i)));
  }
  const bool whole = std::all_of(scale.begin(), scale.end(), [](double c) { return std::isfinite(c); });
  return whole ? scale : TdmsScale();
}

constexpr double raw_values = 4294967295.0;  ///< as the source of a scale

/// As stated, or one more than the number of the last scale.
double count_of_scales(const TdmsObject& owner) {
  constexpr std::string_view key = "NI_Scale[";
  const double stated = owner.number("NI_Number_Of_Scales");
  double count = std::isnan(stated) ? 0.0 : stated;
  for (auto at = owner.properties.lower_bound(key);
       at != owner.properties.end() && at->first.starts_with(key); ++at) {
    std::uint32_t k = 0;
    std::from_chars(at->first.data() + key.size(), at->first.data() + at->first.size(), k);
    count = std::max(count, k + 1.0);
  }
  return count;
}

/// The scales from a channel's stored values to its own, the last applied first: a channel's values are those
/// of the last scale, and each states by number which one it takes in.
/// @param owner of the properties: the channel, its group or the file
/// @param fault set where a scale is unknown
std::vector<TdmsScale> tdms_scales(const TdmsObject& owner, const TdmsIndex& index, std::string& fault) {
  const double count = count_of_scales(owner);
  const std::string status = owner.text("NI_Scaling_Status");
  const bool daqmx = !index.widths.empty();  // stored as converters give them, whatever the status
  if (status == "scaled" && !daqmx) return {};
  if (!status.empty() && status != "unscaled") fault = "the status '" + status + "' of its scales";
  if (!(count >= 1.0) && !status.empty()) fault = "unscaled, without a scale";
  if (owner.number("NI_Number_Of_Scales") < count) fault = "more scales than NI_Number_Of_Scales";
  std::vector<TdmsScale> scales;
  constexpr std::size_t most = 64;
  for (double at = count - 1.0; at != raw_values && fault.empty();) {
    const std::string key = fmt::format("NI_Scale[{:.0f}]_", at), type = owner.text(key + "Scale_Type");
    if (type.empty() && daqmx && at == static_cast<double>(index.scale)) break;
    scales.push_back(tdms_scale(owner, key, type));
    if (scales.back().empty() || scales.size() > most)
      fault = type.empty() ? fmt::format("no scale {:.0f}", at) : fmt::format("a scale of type {}", type);
    const double source = owner.number(key + type + "_Input_Source");
    at = source >= 0.0 ? source : raw_values;  // -1, or none stated
  }
  return scales;
}

/// Makes a table of the channels of a file.
class TdmsChannels {
 public:
  TdmsChannels(const std::string& name, const std::string& bytes)
      : signals_(name, reading_limits(bytes.size()).numbers), content_(read_tdms(bytes, signals_)) {
    for (const TdmsObject* channel : content_.order)
      if (!channel->values.empty() || !channel->fault.empty()) groups_.insert(channel->group);
    for (TdmsObject* channel : content_.order) add(*channel);
    if (signals_.signals().empty())
      throw refuse("no channel of two numbers" + (omitted_.empty() ? "" : ": omitted are " + omitted_),
                   std::string("numbers with linear or polynomial scales, or ") + tdms_export);
  }

  RecordTable table(const RecordFormat& format) {
    std::set<std::string> names;  // of the channels that belong together
    for (const CollectedSignals::Signal& signal : signals_.signals())
      if (signal.values.size() == signals_.common_length()) names.insert(signal.name);
    std::vector<const TdmsObject*> channels;
    for (const TdmsObject* channel : content_.order)
      if (channel->fault.empty() && names.contains(name_of(*channel))) channels.push_back(channel);
    find_interval(channels, format);
    RecordTable table = signals_.table(format);
    if (table.clock) check_starts(channels, table);
    if (!omitted_.empty()) table.remarks.push_back("Omitted: " + omitted_ + ".");
    if (!scaled_.empty()) table.remarks.push_back("Scaled as the file states: " + scaled_ + ".");
    if (content_.unclosed && content_.unfinished == 0)
      table.remarks.emplace_back("The file was not closed. It ends with a whole sample of each channel.");
    if (content_.unfinished > 0)
      table.warnings.push_back(
          fmt::format("The file was not closed: its last {} bytes, of unfinished samples, are omitted.",
                      content_.unfinished));
    return table;
  }

 private:
  InputError refuse(const std::string& found, const std::string& expected) const {
    return {{signals_.file(), 0, 0}, found + "; expected " + expected};
  }

  /// With its group, where several hold channels.
  std::string name_of(const TdmsObject& channel) const {
    return groups_.size() > 1 ? channel.group + "/" + channel.channel : channel.channel;
  }

  /// The channel, its group and the file, as far as they are described.
  std::vector<const TdmsObject*> owners(const TdmsObject& channel) const {
    std::vector<const TdmsObject*> found{&channel};
    for (const std::string& path : {channel.group_path, std::string("/")})
      if (const auto at = content_.objects.find(path); at != content_.objects.end())
        found.push_back(&at->second);
    return found;
  }

  /// Its values, scaled, go to the signals.
  void add(TdmsObject& channel) {
    const std::string quoted = "'" + name_of(channel) + "'";
    std::vector<TdmsScale> scales;
    if (!channel.values.empty() && channel.fault.empty())
      for (const TdmsObject* owner : owners(channel))
        if (count_of_scales(*owner) >= 1.0 || !owner->text("NI_Scaling_Status").empty()) {
          scales = tdms_scales(*owner, channel.index, channel.fault);
          break;
        }
    if (!channel.fault.empty())
      omitted_ += (omitted_.empty() ? "" : ", ") + quoted + " (" + channel.fault + ")";
    if (channel.values.empty() || !channel.fault.empty()) return;
    if (!scales.empty()) scaled_ += (scaled_.empty() ? "" : ", ") + quoted;
    for (; !scales.empty(); scales.pop_back())
      for (double& value : channel.values) {
        double sum = 0.0;
        for (std::size_t i = scales.back().size(); i > 0; --i) sum = sum * value + scales.back()[i - 1];
        value = sum;
      }
    std::string unit = channel.text("unit_string");
    if (unit.empty()) unit = channel.text("NI_UnitDescription");
    if (unit.empty() && channel.first_second) unit = "s";
    signals_.add(name_of(channel), unit, std::exchange(channel.values, {}), channel.digits);
  }

  /// wf_increment of the channels; where none has one, numbers that sampling_name() recognises.
  void find_interval(const std::vector<const TdmsObject*>& channels, const RecordFormat& format) {
    std::string first;
    double of_first = 0.0;  // [s]
    for (const TdmsObject* channel : channels) {
      const std::string name = "'" + name_of(*channel) + "'";
      const double increment = channel->number("wf_increment");
      if (!(increment > 0.0) || !std::isfinite(increment)) continue;
      const auto unit =
          seconds_per(channel->text("wf_xunit_string"), "the abscissa of " + name, signals_.file(), format);
      if (!unit) continue;
      const double interval = increment * *unit;
      if (first.empty()) signals_.set_interval("wf_increment", interval), first = name, of_first = interval;
      if (std::abs(interval / of_first - 1.0) > 1e-9)
        throw refuse(fmt::format("{} at intervals of {} s and {} of {} s, both of {} samples", first,
                                 of_first, name, interval, signals_.common_length()),
                     "channels of one length to have one rate");
    }
    for (const TdmsObject* channel : channels)
      for (const TdmsObject* owner : owners(*channel))
        for (const auto& [key, property] : owner->properties)
          if (first.empty() && key != "wf_increment" && !property.stamp && property.number > 0.0 &&
              std::isfinite(property.number))
            signals_.set(key, property.number);
  }

  /// The record begins at wf_start_offset. A channel that begins at another time than the first one, or is
  /// resumed later than its samples last, is at wrong times in it from there on.
  void check_starts(const std::vector<const TdmsObject*>& channels, RecordTable& table) const {
    constexpr double resolution = 2e-6;  // of seconds since 1904 in a double, four times
    const double interval = table.clock->interval, tolerated = std::max(0.5 * interval, resolution);
    const auto offset = [](const TdmsObject* channel) {
      const double stated = channel->number("wf_start_offset");
      return std::isfinite(stated) ? stated : 0.0;
    };
    table.clock->start = offset(channels.front());
    std::optional<double> first;  // wf_start_time of the record
    for (const TdmsObject* channel : channels) {
      auto starts = channel->starts;
      if (starts.empty()) starts.emplace_back(0, first.value_or(0.0));
      for (const auto& [before, start] : starts) {
        if (!first && !channel->starts.empty()) first = start;
        const double late = start - first.value_or(0.0) + offset(channel) - table.clock->start -
                            static_cast<double>(before) * interval;
        if (!(std::abs(late) > tolerated)) continue;
        table.warnings.push_back(
            fmt::format("'{}' is {:.6g} s {} its place in the record from sample {} on, by wf_start_time and "
                        "wf_start_offset.",
                        name_of(*channel), std::abs(late), late > 0 ? "behind" : "before", before + 1));
        return;
      }
    }
  }

  CollectedSignals signals_;
  TdmsContent content_;
  std::set<std::string> groups_;
  std::string omitted_, scaled_;
};

class TdmsReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    return beginning.starts_with("TDSm") || beginning.starts_with("TDSh");
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat& format) const override {
    const std::string bytes = read_bytes(file, "a TDMS file");
    if (bytes.starts_with("TDSh"))
      throw InputError({file.string()},
                       "the index of a TDMS file (.tdms_index), which has no samples; expected "
                       "the .tdms file beside it");
    return TdmsChannels(file.string(), bytes).table(format);
  }
};

const bool tdms_registered = record_reader_registry().add(
    {"tdms",
     "TDMS files of LabVIEW, FlexLogger and DAQmx: a signal for each channel, with "
     "the scales, units and sampling interval of the file",
     "[tdms]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<TdmsReader>(); }});

}  // namespace
}  // namespace beamid::experiments
