// SAC files of seismology [sac]: a header of 632 bytes, then the samples, in either byte order.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "experiments/record/record_table.hpp"
#include "experiments/text/fields.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

constexpr std::size_t sac_header = 632, sac_word = 4;
// Words of the header, from 0.
constexpr std::size_t sac_delta = 0, sac_begin = 5, sac_version = 76, sac_count = 79, sac_kind = 85,
                      sac_quantity = 86, sac_even = 105;
constexpr std::size_t sac_station = 440, sac_channel = 600, sac_name_length = 8;

template <class Number>
Number sac_number(std::string_view bytes, std::size_t at, bool swapped) {
  return number_of_bytes<Number>(bytes.data() + at, swapped);
}

std::int32_t sac_integer(std::string_view bytes, std::size_t word, bool swapped) {
  return sac_number<std::int32_t>(bytes, word * sac_word, swapped);
}

bool is_sac(std::string_view bytes, bool swapped) {
  const std::int32_t version = sac_integer(bytes, sac_version, swapped),
                     even = sac_integer(bytes, sac_even, swapped);
  return (version == 6 || version == 7) && (even == 0 || even == 1) &&
         sac_integer(bytes, sac_count, swapped) >= 0;
}

class SacReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    return beginning.size() >= sac_header && (is_sac(beginning, false) || is_sac(beginning, true));
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat&) const override {
    const std::string bytes = read_bytes(file, "a SAC file");
    const auto refuse = [&](const std::string& found, const std::string& expected) {
      return InputError({file.string(), 0, 0}, found + "; expected " + expected);
    };
    if (!recognises(bytes)) throw refuse("no header of SAC", "632 bytes of it, of version 6 or 7");
    const bool swapped = !is_sac(bytes, false);
    const std::int32_t kind = sac_integer(bytes, sac_kind, swapped);
    constexpr std::int32_t time_series = 1;
    if (kind != time_series || sac_integer(bytes, sac_even, swapped) != 1)
      throw refuse(fmt::format("SAC data of kind {}", kind), "an evenly sampled time series (kind 1)");
    const auto count = static_cast<std::size_t>(sac_integer(bytes, sac_count, swapped));
    if (count > (bytes.size() - sac_header) / sac_word)
      throw refuse(fmt::format("{} samples", (bytes.size() - sac_header) / sac_word),
                   fmt::format("{}, as its header states", count));
    double interval = sac_number<float>(bytes, sac_delta * sac_word, swapped),
           begin = sac_number<float>(bytes, sac_begin * sac_word, swapped);
    const std::size_t footer = sac_header + count * sac_word;  // of version 7, in double precision
    if (sac_integer(bytes, sac_version, swapped) == 7 && bytes.size() >= footer + 2 * sizeof(double))
      interval = sac_number<double>(bytes, footer, swapped),
      begin = sac_number<double>(bytes, footer + sizeof(double), swapped);
    else if (interval > 0.0 && std::abs(interval * std::round(1.0 / interval) - 1.0) < 1e-6)
      interval = 1.0 / std::round(1.0 / interval);  // a whole rate, as single precision shows it
    if (!(interval > 0.0) || !std::isfinite(interval))
      throw refuse(fmt::format("an interval of {:g} s", interval), "a positive one");
    constexpr double undefined = -12345.0;
    if (begin == undefined || !std::isfinite(begin)) begin = 0.0;

    RecordTable table;
    table.file = file.string();
    table.by_people = true;
    table.clock = Clock{begin, interval};
    table.names = {name(bytes, sac_integer(bytes, sac_quantity, swapped))};
    table.columns.resize(1);
    for (std::size_t k = 0; k < count; ++k)
      table.columns[0].push_back(sac_number<float>(bytes, sac_header + k * sac_word, swapped));
    table.precision = {PrintedPrecision::of_digits(7)};
    table.remarks.emplace_back("SAC files state no unit for certain: the signal is as in the file.");
    return table;
  }

 private:
  static std::string name(std::string_view bytes, std::int32_t quantity) {
    const auto word = [&](std::size_t at) {
      const std::string_view text = trimmed(bytes.substr(at, sac_name_length));
      return text.starts_with("-12345") ? std::string() : std::string(text.substr(0, text.find('\0')));
    };
    const char* const measured = quantity == 6   ? "displacement"
                                 : quantity == 7 ? "velocity"
                                 : quantity == 8 ? "acceleration"
                                                 : "signal";
    return std::string(trimmed(fmt::format("{} {} {}", measured, word(sac_station), word(sac_channel))));
  }
};

const bool sac_registered =
    record_reader_registry().add({"sac",
                                  "SAC files of seismology, of either byte order: one evenly sampled signal",
                                  "[sac]",
                                  {},
                                  {},
                                  [](const filters::Options&) { return std::make_unique<SacReader>(); }});

}  // namespace
}  // namespace beamid::experiments
