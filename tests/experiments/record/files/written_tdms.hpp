// TDMS files written byte by byte, for tests of their reader, by the description of the format [tdms].
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "tests/experiments/record/files/written_record.hpp"

namespace beamid::experiments::tdms_test {

inline constexpr std::uint32_t metadata = 2, new_list = 4, raw = 8, interleaved = 32, big_endian = 64,
                               daqmx = 128, usual = metadata | new_list | raw;
inline constexpr std::uint32_t none = 0xFFFFFFFF, as_before = 0;
inline constexpr std::uint32_t int16 = 2, int32 = 3, float32 = 9, float64 = 10, text_type = 0x20,
                               stamp_type = 0x44;
inline constexpr std::uint64_t endless = ~std::uint64_t{0};

/// Writes numbers in one byte order.
struct Writer {
  bool big = false;

  template <class Number>
  std::string number(Number value) const {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (big) std::reverse(bytes.begin(), bytes.end());
    return bytes;
  }
  std::string u32(std::uint32_t value) const { return number(value); }
  std::string u64(std::uint64_t value) const { return number(value); }
  std::string text(const std::string& value) const {
    return u32(static_cast<std::uint32_t>(value.size())) + value;
  }
  std::string stamp(std::int64_t seconds, double part) const {
    const std::string whole = number(seconds), rest = u64(static_cast<std::uint64_t>(std::ldexp(part, 64)));
    return big ? whole + rest : rest + whole;
  }

  std::string is(const std::string& key, double value) const {
    return text(key) + u32(float64) + number(value);
  }
  std::string is(const std::string& key, const std::string& value) const {
    return text(key) + u32(text_type) + text(value);
  }
  std::string is(const std::string& key, std::uint32_t value) const {
    return text(key) + u32(7) + u32(value);
  }
  std::string starts(std::int64_t seconds, double part = 0.0) const {
    return text("wf_start_time") + u32(stamp_type) + stamp(seconds, part);
  }

  /// @param index complete, by index() or u32(none)
  std::string object(const std::string& path, const std::string& index,
                     const std::vector<std::string>& properties = {}) const {
    std::string bytes = text(path) + index + u32(static_cast<std::uint32_t>(properties.size()));
    for (const std::string& property : properties) bytes += property;
    return bytes;
  }
  std::string index(std::uint32_t type, std::uint64_t count) const {
    return u32(20) + u32(type) + u32(1) + u64(count);
  }
  /// One value of `type` (by DAQmx's numbers) at byte `within` of the rows of a buffer.
  std::string daqmx_index(std::uint32_t type, std::uint64_t count, std::uint32_t within,
                          const std::vector<std::uint32_t>& widths, std::uint32_t buffer = 0) const {
    std::string bytes = u32(0x1269) + u32(0xFFFFFFFF) + u32(1) + u64(count) + u32(1) + u32(type) +
                        u32(buffer) + u32(within) + u32(0) + u32(0) +
                        u32(static_cast<std::uint32_t>(widths.size()));
    for (const std::uint32_t width : widths) bytes += u32(width);
    return bytes;
  }
  std::string objects(const std::vector<std::string>& all) const {
    std::string bytes = u32(static_cast<std::uint32_t>(all.size()));
    for (const std::string& one : all) bytes += one;
    return bytes;
  }
  /// @param described by objects(), or empty
  std::string segment(std::uint32_t flags, const std::string& described, const std::string& values,
                      bool closed = true) const {
    const std::string contents = Writer{}.u32(flags | (big ? big_endian : 0U));
    return "TDSm" + contents + u32(4713) + u64(closed ? described.size() + values.size() : endless) +
           u64(described.size()) + described + values;
  }
};

/// Of signal samples from..to-1, as numbers of that kind.
template <class Number>
std::string values_of(const Writer& write, double (*signal)(int), int from, int to, double unit = 1.0) {
  std::string bytes;
  for (int k = from; k < to; ++k) {
    const double value = signal(k) / unit;
    bytes += write.number(static_cast<Number>(std::is_integral_v<Number> ? std::round(value) : value));
  }
  return bytes;
}

// Whole files.

inline constexpr const char *tip = "/'Run 1'/'Tip'", *hammer = "/'Run 1'/'Hammer'";

inline std::vector<std::string> in_g(const Writer& write) {
  return {write.is("unit_string", "g"), write.is("wf_increment", 0.01)};
}
inline std::vector<std::string> in_newton(const Writer& write) {
  return {write.is("NI_UnitDescription", "N"), write.is("wf_increment", 0.01)};
}

/// Both signals, the samples from..to-1 in one contiguous chunk. @param first describes the channels
inline std::string contiguous(const Writer& write, int from, int to, bool first = true, bool closed = true) {
  const auto count = static_cast<std::uint64_t>(to - from);
  const std::string described =
      write.objects({write.object("/", write.u32(none)), write.object("/'Run 1'", write.u32(none)),
                     write.object(tip, write.index(float64, count), in_g(write)),
                     write.object(hammer, write.index(float64, count), in_newton(write))});
  return write.segment(
      first ? usual : raw, first ? described : "",
      values_of<double>(write, first_signal, from, to) + values_of<double>(write, second_signal, from, to),
      closed);
}

/// One channel, float64.
inline std::string single(const std::vector<std::string>& properties, int samples = written_samples,
                          const std::string& path = tip) {
  const Writer write;
  return write.segment(usual,
                       write.objects({write.object(
                           path, write.index(float64, static_cast<std::uint64_t>(samples)), properties)}),
                       values_of<double>(write, first_signal, 0, samples));
}

}  // namespace beamid::experiments::tdms_test
