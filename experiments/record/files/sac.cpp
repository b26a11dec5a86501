// SAC files of seismology [sac]: a header of 632 bytes, then the samples, in either byte order; or the same
// in letters and digits.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "experiments/record/delimited_text.hpp"
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

struct SacSignal {
  std::int32_t kind = 0, quantity = 0;
  bool even = false;
  std::size_t count = 0;  ///< of samples, as stated
  double interval = 0.0, begin = 0.0;
  std::string station, channel;
  std::vector<double> values = {};
};

// The alphanumeric form: 14 lines of five numbers, 8 of five whole numbers, 8 of words of 8 letters, then the
// samples, five to a line.
constexpr std::size_t sac_reals = 14, sac_lines = 30, sac_words_line = 22, sac_channel_line = 28;

/// Of a line of numbers in cells of that width.
std::vector<double> sac_cells(std::string_view line, std::size_t width) {
  std::vector<double> values;
  for (std::size_t at = 0; at + width <= line.size(); at += width) {
    const ParsedNumber parsed = parse_number(trimmed(line.substr(at, width)));
    if (!parsed.finite) return {};
    values.push_back(parsed.value);
  }
  return values;
}

bool is_alphanumeric(std::string_view beginning) {
  constexpr std::size_t looked_at = 12, width = 15;
  for (std::size_t k = 0; k < looked_at; ++k) {
    if (beginning.find_first_of("\r\n") == beginning.npos) return false;
    const std::string_view line = take_line(beginning);
    if (line.size() != 5 * width || sac_cells(line, width).size() != 5) return false;
  }
  return true;
}

SacSignal read_alphanumeric(const std::string& file, std::string_view text) {
  const std::vector<std::string_view> lines = lines_of(text);
  if (lines.size() < sac_lines)
    throw InputError({file, lines.size(), 1}, "a header that is cut; expected 30 lines of it");
  std::vector<double> reals, wholes;
  for (std::size_t k = 0; k < sac_words_line; ++k) {
    const std::vector<double> cells = sac_cells(lines[k], k < sac_reals ? 15 : 10);
    if (cells.size() != 5) throw InputError({file, k + 1, 1}, "a line of the header; expected five numbers");
    (k < sac_reals ? reals : wholes)
        .insert((k < sac_reals ? reals : wholes).end(), cells.begin(), cells.end());
  }
  constexpr std::size_t first_whole = 70;
  const auto whole = [&](std::size_t word) { return static_cast<std::int32_t>(wholes[word - first_whole]); };
  const auto word = [&](std::size_t line, std::size_t k) {
    const std::size_t at = k * sac_name_length;
    return at < lines[line].size() ? std::string(trimmed(lines[line].substr(at, sac_name_length)))
                                   : std::string();
  };
  SacSignal found{whole(sac_kind),         whole(sac_quantity),
                  whole(sac_even) == 1,    static_cast<std::size_t>(std::max(whole(sac_count), 0)),
                  reals[sac_delta],        reals[sac_begin],
                  word(sac_words_line, 0), word(sac_channel_line, 2)};
  for (std::size_t k = sac_lines; k < lines.size(); ++k) {
    const std::vector<double> cells = sac_cells(lines[k], 15);
    found.values.insert(found.values.end(), cells.begin(), cells.end());
  }
  return found;
}

SacSignal read_binary(std::string_view bytes) {
  const bool swapped = !is_sac(bytes, false);
  const auto text = [&](std::size_t at) {
    const std::string_view found = trimmed(bytes.substr(at, sac_name_length));
    return std::string(found.substr(0, found.find('\0')));
  };
  SacSignal found{sac_integer(bytes, sac_kind, swapped),
                  sac_integer(bytes, sac_quantity, swapped),
                  sac_integer(bytes, sac_even, swapped) == 1,
                  static_cast<std::size_t>(sac_integer(bytes, sac_count, swapped)),
                  sac_number<float>(bytes, sac_delta * sac_word, swapped),
                  sac_number<float>(bytes, sac_begin * sac_word, swapped),
                  text(sac_station),
                  text(sac_channel)};
  const std::size_t there = std::min(found.count, (bytes.size() - sac_header) / sac_word);
  for (std::size_t k = 0; k < there; ++k)
    found.values.push_back(sac_number<float>(bytes, sac_header + k * sac_word, swapped));
  const std::size_t footer = sac_header + found.count * sac_word;  // of version 7, in double precision
  if (sac_integer(bytes, sac_version, swapped) == 7 && bytes.size() >= footer + 2 * sizeof(double))
    found.interval = sac_number<double>(bytes, footer, swapped),
    found.begin = sac_number<double>(bytes, footer + sizeof(double), swapped);
  else if (found.interval > 0.0 && std::abs(found.interval * std::round(1.0 / found.interval) - 1.0) < 1e-6)
    found.interval = 1.0 / std::round(1.0 / found.interval);  // a whole rate, as single precision shows it
  return found;
}

class SacReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    return is_binary(beginning) || is_alphanumeric(beginning);
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat&) const override {
    const std::string bytes = read_bytes(file, "a SAC file");
    const auto refuse = [&](const std::string& found, const std::string& expected) {
      return InputError({file.string(), 0, 0}, found + "; expected " + expected);
    };
    if (!recognises(bytes)) throw refuse("no header of SAC", "632 bytes of it, of version 6 or 7");
    SacSignal signal = is_binary(bytes) ? read_binary(bytes) : read_alphanumeric(file.string(), bytes);
    constexpr std::int32_t time_series = 1;
    if (signal.kind != time_series || !signal.even)
      throw refuse(fmt::format("SAC data of kind {}", signal.kind), "an evenly sampled time series (kind 1)");
    if (signal.count > signal.values.size())
      throw refuse(fmt::format("{} samples", signal.values.size()),
                   fmt::format("{}, as its header states", signal.count));
    signal.values.resize(signal.count);
    if (!(signal.interval > 0.0) || !std::isfinite(signal.interval))
      throw refuse(fmt::format("an interval of {:g} s", signal.interval), "a positive one");
    constexpr double undefined = -12345.0;
    if (signal.begin == undefined || !std::isfinite(signal.begin)) signal.begin = 0.0;

    RecordTable table;
    table.file = file.string();
    table.by_people = true;
    table.clock = Clock{signal.begin, signal.interval};
    table.names = {name(signal)};
    table.columns = {std::move(signal.values)};
    table.precision = {PrintedPrecision::of_digits(7)};
    table.remarks.emplace_back("SAC files state no unit for certain: the signal is as in the file.");
    return table;
  }

 private:
  static bool is_binary(std::string_view beginning) {
    return beginning.size() >= sac_header && (is_sac(beginning, false) || is_sac(beginning, true));
  }

  static std::string name(const SacSignal& signal) {
    const auto word = [](const std::string& text) { return text.starts_with("-12345") ? "" : text; };
    const char* const measured = signal.quantity == 6   ? "displacement"
                                 : signal.quantity == 7 ? "velocity"
                                 : signal.quantity == 8 ? "acceleration"
                                                        : "signal";
    return std::string(
        trimmed(fmt::format("{} {} {}", measured, word(signal.station), word(signal.channel))));
  }
};

const bool sac_registered = record_reader_registry().add(
    {"sac",
     "SAC files of seismology, binary of either byte order or alphanumeric: one evenly sampled "
     "signal",
     "[sac]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<SacReader>(); }});

}  // namespace
}  // namespace beamid::experiments
