// NumPy's array files and archives: a header in Python's syntax, then the numbers [npy].
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <regex>

#include "experiments/record/delimited_text.hpp"
#include "experiments/record/read_apart.hpp"
#include "experiments/record/recognised_column.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

constexpr std::string_view magic = "\x93NUMPY", archive_magic = "PK\x03\x04";

template <class Number>
double number_at(const char* bytes, bool swapped) {
  return static_cast<double>(number_of_bytes<Number>(bytes, swapped));
}

// How a type of numbers is read, and how long each is.
struct NumberType {
  std::string_view name;
  std::size_t size;
  double (*read)(const char*, bool swapped);
  int digits;  ///< that it holds
};
constexpr NumberType types[] = {
    {"f8", 8, number_at<double>, 16},       {"f4", 4, number_at<float>, 7},
    {"i1", 1, number_at<std::int8_t>, 3},   {"u1", 1, number_at<std::uint8_t>, 3},
    {"i2", 2, number_at<std::int16_t>, 5},  {"u2", 2, number_at<std::uint16_t>, 5},
    {"i4", 4, number_at<std::int32_t>, 10}, {"u4", 4, number_at<std::uint32_t>, 10},
    {"i8", 8, number_at<std::int64_t>, 16}, {"u8", 8, number_at<std::uint64_t>, 16}};

/// A number of an array: "<f8", ">i2", "|u1".
struct Numbers {
  const NumberType* type = nullptr;
  bool swapped = false;  ///< the high byte first

  explicit Numbers(std::string_view description) {
    for (const NumberType& one : types)
      if (description.size() == 3 && description.substr(1) == one.name) type = &one;
    swapped = description.starts_with('>');
  }
  double read(const char* bytes) const { return type->read(bytes, swapped); }
};

/// A structured array: a column for every field, "[('t', '<f8'), ('acc', '<f4')]"; what is no number is
/// passed over.
/// @param refuse makes the error
template <class Refuse>
void add_records(RecordTable& table, std::string_view data, const std::string& header, const Refuse& refuse) {
  struct Field {
    std::size_t offset;
    Numbers numbers;
    std::optional<double> tick = {};  ///< of instants [s]
  };
  static const std::regex field(
      R"(\('([^']*)',\s*'([<>|=][a-zA-Z])([0-9]{1,6})(?:\[([a-z]+)\])?'(,?\s*\([^)]*\))?\))"),
      one(R"('shape'\s*:\s*\((\d{1,18}),\s*\))");
  std::smatch shape;
  if (!std::regex_search(header, shape, one)) throw refuse("records in more dimensions");
  std::vector<Field> fields;
  std::size_t length = 0;
  const std::size_t before = table.columns.size(), rows = std::stoull(shape[1]);
  for (std::sregex_iterator at(header.begin(), header.end(), field), end; at != end; ++at) {
    const std::string kind = (*at)[2];
    if ((*at)[5].length() > 0) throw refuse("records that hold arrays");
    const std::size_t size = std::stoull((*at)[3]) * (kind[1] == 'U' ? 4 : 1);
    if (const auto tick = seconds_per_unit((*at)[4].str()); kind[1] == 'M' && tick) {
      fields.push_back({length, Numbers(kind.substr(0, 1) + "i8"), tick});
      table.time = before + fields.size() - 1;
      table.names.push_back((*at)[1]);
      table.precision.push_back(PrintedPrecision::of_digits(15));
    } else if (const Numbers numbers(kind + (*at)[3].str()); numbers.type) {
      fields.push_back({length, numbers});
      table.names.push_back((*at)[1]);
      table.precision.push_back(PrintedPrecision::of_digits(numbers.type->digits));
    }
    length += size;
    if (size > data.size()) throw refuse("fewer bytes than the header states");
  }
  if (fields.empty() || rows == 0 || rows > data.size() / length)
    throw refuse("fewer records of numbers than the header states");
  if (rows * length != data.size()) throw refuse("records of other fields than numbers, texts and instants");
  for (const Field& one_field : fields) {
    std::vector<double>& column = table.columns.emplace_back();
    const auto at = [&](std::size_t row) { return data.data() + row * length + one_field.offset; };
    const auto ticks = [&](std::size_t row) {
      return number_of_bytes<std::int64_t>(at(row), one_field.numbers.swapped);
    };
    for (std::size_t row = 0; row < rows; ++row)
      column.push_back(one_field.tick ? *one_field.tick * static_cast<double>(ticks(row) - ticks(0))
                                      : one_field.numbers.read(at(row)));
  }
}

/// The columns of one array, named `name`, behind those that are there; a number alone states the rate or the
/// interval.
void add_array(RecordTable& table, const std::string& bytes, const std::string& name) {
  const auto refuse = [&](const std::string& found) {
    return InputError({table.file}, (name.empty() ? "" : "'" + name + "': ") + found +
                                        "; expected a NumPy array of one or two dimensions of "
                                        "real numbers of up to eight bytes, or of records of such numbers");
  };
  const bool wide = bytes.size() > 8 && bytes[6] >= 2;  // version 2: four bytes of length
  const std::size_t start = wide ? 12 : 10;
  if (bytes.size() < start) throw refuse("a header that is cut short");
  const auto byte = [&](std::size_t at) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at]));
  };
  std::size_t length = byte(8) | byte(9) << 8;
  if (wide) length |= byte(10) << 16 | byte(11) << 24;
  if (bytes.size() < start + length) throw refuse("a header that is cut short");
  const std::string header = bytes.substr(start, length);
  std::smatch type, shape;
  const bool of_records = std::regex_search(header, std::regex(R"('descr'\s*:\s*\[)"));
  if ((!of_records && !std::regex_search(header, type, std::regex(R"('descr'\s*:\s*'([^']+)')"))) ||
      (!std::regex_search(header, shape, std::regex(R"('shape'\s*:\s*\((\d{1,18}),\s*(\d{0,18})\s*\))")) &&
       !std::regex_search(header, shape, std::regex(R"('shape'\s*:\s*\((\s*)(\s*)\))"))))
    throw refuse("an array of more dimensions");
  if (of_records) {
    add_records(table, std::string_view(bytes).substr(start + length), header, refuse);
    return;
  }
  const Numbers numbers(type[1].str());
  const bool text = type[1].str().find_first_of("US") == 1;
  if (!numbers.type && text && !name.empty()) {  // a unit, or labels, in an archive
    static const std::regex unit("(?:y_?|acc_?|data_?|signal_?)?units?", std::regex::icase);
    const std::size_t letter = type[1].str()[1] == 'U' ? 4 : 1;
    std::string word;
    for (std::size_t at = start + length; at < bytes.size() && bytes[at] != '\0'; at += letter)
      word += bytes[at];
    if (const auto known = motion_unit(word); std::regex_match(name, unit) && known)
      table.stated_unit = known;
    return;
  }
  if (!numbers.type) throw refuse(fmt::format("numbers of type '{}'", type[1].str()));
  const bool by_columns = header.find("'fortran_order': True") != std::string::npos;
  const bool of_one = shape[1] == "1" && (shape[2].length() == 0 || shape[2] == "1");
  if (shape[1].length() == 0 || (of_one && !name.empty())) {  // a number alone
    if (bytes.size() < start + length + numbers.type->size) throw refuse("a header without its number");
    const double value = numbers.read(bytes.data() + start + length);
    const SamplingName what = sampling_name(name);
    constexpr double longest = 0.5, alike = 0.02;  // [s]; a longer interval is one of milliseconds
    if (what == SamplingName::none || !(value > (what == SamplingName::rate ? 1.0 / longest : 0.0)) ||
        (what == SamplingName::interval && value > longest))
      return;
    const double rate = what == SamplingName::rate ? value : 1.0 / value;
    if (table.stated_rate && std::abs(rate / *table.stated_rate - 1.0) > alike) {
      table.remarks.push_back(
          fmt::format("'{}' states {:.6g} Hz, and another number {:.6g} Hz: neither is used.", name, rate,
                      *table.stated_rate));
      table.stated_rate.reset();
      return;
    }
    table.stated_rate = rate;
    return;
  }
  const std::size_t rows = std::stoull(shape[1]), width = shape[2].length() > 0 ? std::stoull(shape[2]) : 1;
  const std::size_t count = (bytes.size() - start - length) / numbers.type->size;
  if (width == 0 || rows == 0 || rows > count / width) throw refuse("fewer numbers than the header states");

  const char* const data = bytes.data() + start + length;
  const bool lying = rows < width && rows <= 32;  // a row for each channel
  const std::size_t added = lying ? rows : width, first = table.columns.size();
  table.columns.resize(first + added);
  table.precision.resize(first + added, PrintedPrecision::of_digits(numbers.type->digits));
  for (std::size_t k = 0; k < added && !name.empty(); ++k)
    table.names.push_back(added > 1 ? fmt::format("{}_{}", name, k + 1) : name);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < width; ++column) {
      const std::size_t at = by_columns ? column * rows + row : row * width + column;
      table.columns[first + (lying ? row : column)].push_back(numbers.read(data + at * numbers.type->size));
    }
}

constexpr std::size_t deflated = 8;  ///< the method of np.savez_compressed

/// Of so many bytes; fewer where the stream is damaged, which takes no more memory than it can hold.
std::string inflated(std::string_view compressed, std::size_t whole) {
  constexpr std::size_t largest_ratio = 1032;  // of the format
  if (whole / largest_ratio > compressed.size() + 1) return {};
  std::string bytes(whole, '\0');
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
  stream.avail_in = static_cast<uInt>(compressed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(whole);
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return {};
  inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  bytes.resize(stream.total_out);
  return bytes;
}

/// Arrays of the length that most numbers have; the others are named in a remark.
void keep_one_length(RecordTable& table) {
  std::vector<std::size_t> lengths;
  for (const std::vector<double>& column : table.columns) lengths.push_back(column.size());
  if (std::ranges::adjacent_find(lengths, std::not_equal_to()) == lengths.end()) return;
  const std::size_t length = length_of_most_numbers(lengths);
  std::string others;
  for (std::size_t k = table.columns.size(); k-- > 0;) {
    if (table.columns[k].size() == length) continue;
    others = fmt::format("{} ({}){}{}", k < table.names.size() ? table.names[k] : "", table.columns[k].size(),
                         others.empty() ? "" : ", ", others);
    const auto at = static_cast<std::ptrdiff_t>(k);
    table.columns.erase(table.columns.begin() + at), table.precision.erase(table.precision.begin() + at);
    if (k < table.names.size()) table.names.erase(table.names.begin() + at);
    if (table.time == k)
      table.time.reset();
    else if (table.time && *table.time > k)
      --*table.time;
  }
  table.remarks.push_back(fmt::format("Omitted, as not of {} samples: {}.", length, others));
}

/// The entries of a zip archive, as np.savez writes it: stored or deflated, the name that of the array.
void add_archive(RecordTable& table, const std::string& bytes) {
  constexpr std::string_view entry = "PK\x01\x02";
  constexpr std::size_t fixed = 46, local = 30;
  const auto number = [&](std::size_t at, int length) {
    std::size_t value = 0;
    for (int k = length - 1; k >= 0; --k)
      value = value << 8 | (at + static_cast<std::size_t>(k) < bytes.size()
                                ? static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(k)])
                                : 0U);
    return value;
  };
  const auto refuse = [&](const std::string& found) {
    return InputError({table.file}, found + "; expected arrays as numpy.savez writes them, not compressed");
  };
  const std::size_t end = bytes.rfind("PK\x05\x06");  // which says where the directory begins
  std::size_t at = end == std::string::npos ? end : number(end + 16, 4);
  for (; at < bytes.size() && bytes.compare(at, entry.size(), entry) == 0 && at + fixed <= bytes.size();
       at += fixed + number(at + 28, 2) + number(at + 30, 2) + number(at + 32, 2)) {
    const std::string name = bytes.substr(at + fixed, number(at + 28, 2));
    const std::size_t method = number(at + 10, 2), size = number(at + 20, 4), whole = number(at + 24, 4),
                      header = number(at + 42, 4);
    if (method != 0 && method != deflated) throw refuse("'" + name + "' is compressed by another method");
    const std::size_t begin = header + local + number(header + 26, 2) + number(header + 28, 2);
    if (begin > bytes.size() || size > bytes.size() - begin) throw refuse("'" + name + "' is cut short");
    const std::string content = method == 0 ? bytes.substr(begin, size)
                                            : inflated(std::string_view(bytes).substr(begin, size), whole);
    const auto* const first = reinterpret_cast<const Bytef*>(content.data());
    if (content.size() != whole || crc32(0, first, static_cast<uInt>(whole)) != number(at + 16, 4))
      throw refuse("'" + name + "' is damaged");
    add_array(table, content, name.substr(0, name.rfind(".npy")));
  }
  if (table.columns.empty()) throw refuse("no array");
  keep_one_length(table);
}

class NpyReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override {
    return beginning.starts_with(magic) || (beginning.starts_with(archive_magic) &&
                                            beginning.substr(0, 200).find(".npy") != std::string_view::npos);
  }

  RecordTable read(const std::filesystem::path& file, const RecordFormat&) const override {
    std::ifstream stream = open_input(file, "a NumPy array");
    const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    RecordTable table;
    table.file = file.string();
    table.by_people = true;
    if (bytes.starts_with(archive_magic))
      add_archive(table, bytes);
    else
      add_array(table, bytes, "");
    return table;
  }
};

const bool npy_registered =
    record_reader_registry().add({"npy",
                                  "NumPy's .npy and .npz, a column (or a row) for each signal, the first "
                                  "rising one time; fs or dt as a number",
                                  "[npy]",
                                  {},
                                  {},
                                  [](const filters::Options&) { return std::make_unique<NpyReader>(); }});

}  // namespace
}  // namespace beamid::experiments
