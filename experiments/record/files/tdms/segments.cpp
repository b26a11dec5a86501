#include "experiments/record/files/tdms/segments.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "experiments/record/record_table.hpp"
#include "experiments/text/input_error.hpp"

namespace beamid::experiments {

// The types of values.

/// As files number them; a type that is not listed has an unknown size.
struct TdmsType {
  std::uint32_t code;
  std::size_t size;  ///< [bytes]; 0: each value another one
  int digits;        ///< significant ones; 0: no real numbers
  double (*read)(const char* bytes, bool big);
  const char* name;
};

namespace {

template <class Number>
double tdms_value(const char* bytes, bool big) {
  return static_cast<double>(number_of_bytes<Number>(bytes, big));
}

/// A stamp has 16 bytes: whole seconds since 1904, and behind or before them, by the byte order, units of
/// 2^-64 s. A double resolves it to half a microsecond.
std::int64_t whole_seconds(const char* stamp, bool big) {
  return number_of_bytes<std::int64_t>(stamp + (big ? 0 : 8), big);
}

double part_of_second(const char* stamp, bool big) {
  return std::ldexp(tdms_value<std::uint64_t>(stamp + (big ? 8 : 0), big), -64);
}

double stamp_value(const char* stamp, bool big) {
  return static_cast<double>(whole_seconds(stamp, big)) + part_of_second(stamp, big);
}

constexpr std::uint32_t type_text = 0x20, type_stamp = 0x44;
constexpr TdmsType tdms_types[] = {{0x01, 1, 3, tdms_value<std::int8_t>, "I8"},
                                   {0x02, 2, 5, tdms_value<std::int16_t>, "I16"},
                                   {0x03, 4, 10, tdms_value<std::int32_t>, "I32"},
                                   {0x04, 8, 15, tdms_value<std::int64_t>, "I64"},
                                   {0x05, 1, 3, tdms_value<std::uint8_t>, "U8"},
                                   {0x06, 2, 5, tdms_value<std::uint16_t>, "U16"},
                                   {0x07, 4, 10, tdms_value<std::uint32_t>, "U32"},
                                   {0x08, 8, 15, tdms_value<std::uint64_t>, "U64"},
                                   {0x09, 4, 7, tdms_value<float>, "float32"},
                                   {0x0A, 8, 15, tdms_value<double>, "float64"},
                                   {0x19, 4, 7, tdms_value<float>, "float32"},
                                   {0x1A, 8, 15, tdms_value<double>, "float64"},
                                   {type_text, 0, 0, nullptr, "text"},
                                   {0x21, 1, 0, tdms_value<std::uint8_t>, "true or false"},
                                   {type_stamp, 16, 15, stamp_value, "stamps"},
                                   {0x08000C, 8, 0, nullptr, "complex numbers"},
                                   {0x10000D, 16, 0, nullptr, "complex numbers"}};

const TdmsType* find_tdms_type(std::uint32_t code) {
  for (const TdmsType& type : tdms_types)
    if (type.code == code) return &type;
  return nullptr;
}

/// Types of DAQmx have numbers of their own: U8, I8, U16, I16, U32, I32, U64, I64, float32, float64.
const TdmsType* find_daqmx_type(std::uint32_t code) {
  constexpr std::uint32_t codes[] = {0x05, 0x01, 0x06, 0x02, 0x07, 0x03, 0x08, 0x04, 0x09, 0x0A};
  return code < std::size(codes) ? find_tdms_type(codes[code]) : nullptr;
}

/// A path is /'group'/'channel', with quotes doubled in a name.
void split_tdms_path(const std::string& path, TdmsObject& object) {
  for (std::size_t at = 0; path.compare(at, 2, "/'") == 0;) {
    if (!object.group_path.empty()) object.group = std::exchange(object.channel, "");
    for (at += 2; at < path.size() && (path[at] != '\'' || path.compare(at, 2, "''") == 0); ++at) {
      object.channel += path[at];
      if (path[at] == '\'') ++at;
    }
    at = std::min(at + 1, path.size());
    if (!object.group.empty()) return;
    object.group_path = path.substr(0, at);
  }
  if (object.channel.empty()) object.channel = path;
}

constexpr std::size_t tdms_lead_in = 28, tdms_most = std::numeric_limits<std::size_t>::max();

/// Reads what is in memory. What a segment describes holds for those behind it: properties, the list of the
/// channels that raw data come in, and the index of each.
class TdmsSegments {
 public:
  TdmsSegments(const std::string& bytes, CollectedSignals& signals) : bytes_(bytes), signals_(signals) {}

  TdmsContent read() {
    for (std::size_t at = 0; at < bytes_.size();) at = read_segment(at);
    return std::move(content_);
  }

 private:
  InputError refuse(const std::string& found, const std::string& expected) const {
    return {{signals_.file(), 0, 0}, found + "; expected " + expected};
  }

  /// @returns where the next one begins. A lead-in is "TDSm", flags, a version, and how far it is from behind
  /// it to the next segment and to the raw data; until a file is closed the next segment is at 2^64 - 1.
  std::size_t read_segment(std::size_t start) {
    constexpr std::uint32_t metadata = 2, new_list = 4, raw_data = 8, interleaved = 32, big_endian = 64;
    if (bytes_.size() - start < tdms_lead_in || bytes_.compare(start, 4, "TDSm") != 0)
      throw refuse(
          fmt::format("{} bytes that are no segment of TDMS behind byte {}", bytes_.size() - start, start),
          "a whole file, each segment with its lead-in");
    const auto flags = number_of_bytes<std::uint32_t>(bytes_.data() + start + 4, false);
    big_ = (flags & big_endian) != 0;
    at_ = start + 8, end_ = bytes_.size();
    const auto version = next<std::uint32_t>();
    if (version != 4712 && version != 4713)
      throw refuse(fmt::format("version {} of TDMS at byte {}", version, start), "4712 or 4713");
    const auto length = next<std::uint64_t>(), described = next<std::uint64_t>();
    const std::size_t begin = at_, size = std::min<std::size_t>(length, end_ - begin);
    const bool open = length == tdms_most;
    if (size < length && !open)
      throw refuse(fmt::format("a segment of {} bytes at byte {}", size, begin),
                   fmt::format("{}, as its lead-in states", length));
    if (described > size && !open)
      throw refuse(fmt::format("raw data {} bytes behind byte {}", described, begin),
                   fmt::format("them in the {} bytes of their segment", size));
    if (open) require_last(begin);
    if (described > size) {
      content_.unfinished += size;
      return bytes_.size();
    }
    end_ = begin + described;
    if (flags & metadata) read_objects((flags & new_list) != 0);
    if (flags & raw_data)
      read_raw(end_ = begin + described, size - described, (flags & interleaved) != 0, open);
    return begin + size;
  }

  /// What an unclosed segment holds must not be read as values where another one follows it.
  void require_last(std::size_t begin) {
    content_.unclosed = true;
    for (std::size_t at = begin; (at = bytes_.find("TDSm", at)) != std::string::npos; ++at)
      for (const bool big : {false, true})
        if (bytes_.size() - at >= tdms_lead_in &&
            number_of_bytes<std::uint32_t>(&bytes_[at + 8], big) / 2 == 4712 / 2)
          throw refuse(fmt::format("a segment without an end, and another one at byte {}", at),
                       "it at the end");
  }

  // The description of objects, from at_ to end_.

  const char* take(std::size_t count) {
    if (count > end_ - at_)
      throw refuse(fmt::format("a description of objects that goes on behind byte {}, its end", end_),
                   "an undamaged file");
    at_ += count;
    return bytes_.data() + at_ - count;
  }

  template <class Number>
  Number next() {
    return number_of_bytes<Number>(take(sizeof(Number)), big_);
  }

  std::string next_text() {
    const std::size_t size = next<std::uint32_t>();
    return {take(size), size};
  }

  /// @param new_list its channels take the place of those before, else they come behind them.
  void read_objects(bool new_list) {
    constexpr std::uint32_t as_before = 0, none = 0xFFFFFFFF;
    if (new_list) list_.clear(), ++lists_;
    for (auto objects = next<std::uint32_t>(); objects > 0; --objects) {
      const auto [at, is_new] = content_.objects.try_emplace(next_text());
      const auto& [path, object] = std::pair<const std::string&, TdmsObject&>(at->first, at->second);
      if (is_new) {
        split_tdms_path(path, object);
        content_.order.push_back(&object);
      }
      const auto index = next<std::uint32_t>();
      object.in_segment = index != none;
      if (object.in_segment && index != as_before) read_index(path, object, index);
      if (object.in_segment && !object.indexed)
        throw refuse(path + " has raw data as before, and has had none", "a type and a number of values");
      if (std::exchange(object.list, lists_) != lists_) list_.push_back(&object);
      for (auto properties = next<std::uint32_t>(); properties > 0; --properties) read_property(path, object);
    }
  }

  void read_property(const std::string& path, TdmsObject& object) {
    const std::string key = next_text();
    const auto code = next<std::uint32_t>();
    const TdmsType* const type = find_tdms_type(code);
    if (type == nullptr)
      throw refuse(fmt::format("property '{}' of {} is of type {:#x}", key, path, code),
                   "a number, a text or a stamp");
    TdmsProperty property;
    property.stamp = code == type_stamp;
    if (code == type_text)
      property.text = next_text();
    else if (const char* const value = take(type->size); type->read != nullptr)
      property.number = type->read(value, big_);
    const double before = object.number(key);
    if (key == "wf_start_time" && property.number != before)
      object.starts.emplace_back(object.values.size(), property.number);
    if (key == "wf_increment" && !object.values.empty() && before > 0.0 &&
        !(std::abs(property.number / before - 1.0) < 1e-9))
      throw refuse(fmt::format("wf_increment of {} changes from {} to {}", path, before, property.number),
                   "one rate in a channel");
    object.properties.insert_or_assign(key, std::move(property));
  }

  /// @param kind the length of a usual index, or a number for each kind of DAQmx.
  void read_index(const std::string& path, TdmsObject& object, std::uint32_t kind) {
    constexpr std::uint32_t scalers = 0x1269, longest = 0x100;
    if (kind > longest && kind != scalers)
      throw refuse(
          fmt::format("{} has raw data of DAQmx's digital lines or of another kind ({:#x})", path, kind),
          tdms_export);
    TdmsIndex index;
    const auto code = next<std::uint32_t>();
    if (next<std::uint32_t>() != 1) throw refuse(path + " has several dimensions", "one");
    index.count = next<std::uint64_t>();
    if (kind == scalers) {
      read_scalers(index);
    } else {
      index.type = find_tdms_type(code);
      if (index.type == nullptr)
        throw refuse(fmt::format("{} has values of {} {:#x}", path,
                                 code == 0x0B || code == 0x1B ? "extended precision, type" : "type", code),
                     std::string("integers, single or double precision, or ") + tdms_export);
      const std::size_t size = index.type->size;
      index.bytes = size == 0                         ? next<std::uint64_t>()
                    : index.count <= tdms_most / size ? index.count * size
                                                      : tdms_most;
      if (index.type->digits == 0) index.fault = index.type->name;
    }
    object.index = std::move(index);
    object.indexed = true;
  }

  /// A scaler is where DAQmx's values stand; what it is called is the number that scales have for it.
  void read_scalers(TdmsIndex& index) {
    const auto scalers = next<std::uint32_t>();
    for (std::uint32_t k = 0; k < scalers; ++k) {
      index.type = find_daqmx_type(next<std::uint32_t>());
      index.buffer = next<std::uint32_t>(), index.within = next<std::uint32_t>();
      next<std::uint32_t>();  // the format of a sample, which its type states
      index.scale = next<std::uint32_t>();
    }
    for (auto widths = next<std::uint32_t>(); widths > 0; --widths)
      index.widths.push_back(next<std::uint32_t>());
    if (index.widths.empty()) throw refuse("raw data of DAQmx without a buffer", "an undamaged file");
    if (scalers != 1) index.fault = fmt::format("{} scalers of DAQmx", scalers);
    if (scalers == 1 && index.type == nullptr) index.fault = "a type of DAQmx without description";
    index.bytes = index.count;
  }

  // Raw data are whole chunks. Value k of a channel begins at byte  offset + k stride  of one. For n values
  // of s bytes of each channel:
  //
  //   contiguous   stride = s                         offset = sum of n s of the channels before
  //   interleaved  stride = sum of s of all channels  offset = sum of s of the channels before
  //   DAQmx        stride = width w of its buffer     offset = sum of n w of the buffers before, and its
  //   place

  struct Layout {
    TdmsObject* channel;
    std::size_t offset = 0, stride = 0, count = 0;
  };

  /// @param open the segment has no stated end, and its last chunk may be cut short.
  void read_raw(std::size_t begin, std::size_t size, bool interleaved, bool open) {
    if (size == 0) return;
    std::vector<Layout> layouts;
    for (TdmsObject* channel : list_)
      if (channel->in_segment && channel->index.bytes > 0) layouts.push_back({channel});
    if (layouts.empty()) throw refuse(fmt::format("{} bytes of raw data of no channel", size), "channels");
    const bool daqmx = !layouts.front().channel->index.widths.empty();
    const std::size_t chunk = daqmx ? lay_out_daqmx(layouts) : lay_out(layouts, interleaved);
    const std::size_t chunks = chunk == 0 ? 0 : size / chunk, rest = size - chunks * chunk;
    if (rest > 0 && (!open || chunk == 0))
      throw refuse(fmt::format("{} bytes of raw data at byte {} in chunks of {}", size, begin, chunk),
                   "whole chunks");
    content_.unfinished += rest;
    for (const Layout& layout : layouts) {
      TdmsObject& channel = *layout.channel;
      if (channel.fault.empty()) channel.fault = channel.index.fault;
      if (!channel.fault.empty() || chunks == 0) continue;
      signals_.announce(channel.channel, {chunks, layout.count});
      channel.digits = std::min(channel.digits, channel.index.type->digits);
      for (std::size_t i = 0; i < chunks; ++i)
        for (std::size_t k = 0; k < layout.count; ++k)
          read_value(channel, bytes_.data() + begin + i * chunk + layout.offset + k * layout.stride);
    }
  }

  void read_value(TdmsObject& channel, const char* value) const {
    const TdmsType& type = *channel.index.type;
    if (type.code != type_stamp) {
      channel.values.push_back(type.read(value, big_));
      return;
    }
    const std::int64_t seconds = whole_seconds(value, big_);
    if (!channel.first_second) channel.first_second = seconds;
    channel.values.push_back(static_cast<double>(seconds) - static_cast<double>(*channel.first_second) +
                             part_of_second(value, big_));
  }

  /// @returns the bytes of a chunk. Rows, and values of a single channel, are chunks of one value each: only
  /// the last one can be cut short.
  std::size_t lay_out(std::vector<Layout>& layouts, bool interleaved) const {
    const TdmsIndex& first = layouts.front().channel->index;
    const bool by_rows = interleaved || (layouts.size() == 1 && first.type->size > 0);
    std::size_t chunk = 0;
    for (Layout& layout : layouts) {
      const TdmsIndex& index = layout.channel->index;
      if (!index.widths.empty() || (interleaved && (index.type->size == 0 || index.count != first.count)))
        throw refuse("'" + layout.channel->channel + "' does not fit the rows of its segment", tdms_export);
      const std::size_t bytes = by_rows ? index.type->size : index.bytes;
      layout = {layout.channel, chunk, bytes, 1};
      if (!by_rows) layout.stride = index.type->size, layout.count = index.count;
      chunk = bytes > tdms_most - chunk ? tdms_most : chunk + bytes;
    }
    if (by_rows)
      for (Layout& layout : layouts) layout.stride = chunk;
    return chunk;
  }

  /// The same for DAQmx's buffers, one behind the other, each of rows with a value of each of its channels.
  std::size_t lay_out_daqmx(std::vector<Layout>& layouts) const {
    const TdmsIndex& first = layouts.front().channel->index;
    const std::size_t count = first.widths.size() == 1 ? 1 : first.count;
    std::size_t width = 0;
    for (const std::uint32_t one : first.widths) width += one;
    for (Layout& layout : layouts) {
      const TdmsIndex& index = layout.channel->index;
      if (index.widths != first.widths || index.count != first.count)
        throw refuse("'" + layout.channel->channel + "' has other buffers of DAQmx than its neighbours",
                     tdms_export);
      if (!index.fault.empty()) continue;
      if (index.buffer >= index.widths.size() || index.within + index.type->size > index.widths[index.buffer])
        throw refuse("'" + layout.channel->channel + "' is outside its buffer of DAQmx", "an undamaged file");
      for (std::size_t b = 0; b < index.buffer; ++b) layout.offset += index.widths[b];
      layout.offset = layout.offset * count + index.within;
      layout.stride = index.widths[index.buffer];
      layout.count = count;
    }
    return width == 0 || count <= tdms_most / width ? width * count : tdms_most;
  }

  const std::string& bytes_;
  CollectedSignals& signals_;
  TdmsContent content_;
  std::vector<TdmsObject*> list_;  ///< of the objects of a segment, in the order of their raw data
  int lists_ = 0;
  bool big_ = false;
  std::size_t at_ = 0, end_ = 0;
};

}  // namespace

double TdmsObject::number(const std::string& key) const {
  const auto at = properties.find(key);
  return at == properties.end() ? std::nan("") : at->second.number;
}

std::string TdmsObject::text(const std::string& key) const {
  const auto at = properties.find(key);
  return at == properties.end() ? "" : at->second.text;
}

TdmsContent read_tdms(const std::string& bytes, CollectedSignals& signals) {
  return TdmsSegments(bytes, signals).read();
}

}  // namespace beamid::experiments
