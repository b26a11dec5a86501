// NumPy's array files: a header in Python's words, then the numbers [npy].
#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <regex>

#include "experiments/record/record_reader.hpp"
#include "experiments/text/text_file.hpp"

namespace beamid::experiments {
namespace {

constexpr std::string_view magic = "\x93NUMPY";

template <class Number>
double number_at(const char* bytes) {
  Number value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

// How a type of numbers is read, and how long each is.
struct NumberType {
  std::string_view name;
  std::size_t size;
  double (*read)(const char*);
  int digits;  ///< that it holds
};
constexpr NumberType types[] = {
    {"<f8", 8, number_at<double>, 16},       {"<f4", 4, number_at<float>, 7},
    {"<i2", 2, number_at<std::int16_t>, 5},  {"<i4", 4, number_at<std::int32_t>, 10},
    {"<i8", 8, number_at<std::int64_t>, 16}, {"<u2", 2, number_at<std::uint16_t>, 5}};

class NpyReader final : public RecordReader {
 public:
  bool recognises(std::string_view beginning) const override { return beginning.starts_with(magic); }

  RecordTable read(const std::filesystem::path& file, const RecordFormat&) const override {
    std::ifstream stream = open_input(file, "a NumPy array");
    const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    const auto refuse = [&](const std::string& found) {
      return InputError({file.string()}, found +
                                             "; expected a NumPy array of one or two dimensions of "
                                             "little-endian numbers (<f8, <f4, <i2, <i4, <i8, <u2)");
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
    if (!std::regex_search(header, type, std::regex(R"('descr'\s*:\s*'([^']+)')")) ||
        !std::regex_search(header, shape, std::regex(R"('shape'\s*:\s*\((\d+),\s*(\d*)\s*\))")))
      throw refuse("an array of records or of more dimensions");
    const NumberType* numbers = nullptr;
    for (const NumberType& one : types)
      if (one.name == type[1].str()) numbers = &one;
    if (!numbers) throw refuse(fmt::format("numbers of type '{}'", type[1].str()));
    const bool by_columns = header.find("'fortran_order': True") != std::string::npos;
    std::size_t rows = std::stoull(shape[1]), width = shape[2].length() > 0 ? std::stoull(shape[2]) : 1;
    const std::size_t count = (bytes.size() - start - length) / numbers->size;
    if (width == 0 || rows == 0 || rows > count / width) throw refuse("fewer numbers than the header states");

    const char* const data = bytes.data() + start + length;
    const bool lying = rows < width && rows <= 32;  // a row for each channel
    RecordTable table;
    table.file = file.string();
    table.by_people = true;
    table.columns.resize(lying ? rows : width);
    table.precision.assign(table.columns.size(), PrintedPrecision::of_digits(numbers->digits));
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < width; ++column) {
        const std::size_t at = by_columns ? column * rows + row : row * width + column;
        table.columns[lying ? row : column].push_back(numbers->read(data + at * numbers->size));
      }
    return table;
  }
};

const bool npy_registered = record_reader_registry().add(
    {"npy",
     "NumPy's array files, a column (or a row) for each signal, the first rising one time",
     "[npy]",
     {},
     {},
     [](const filters::Options&) { return std::make_unique<NpyReader>(); }});

}  // namespace
}  // namespace beamid::experiments
