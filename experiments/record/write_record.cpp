#include "experiments/record/write_record.hpp"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <stdexcept>

#include "experiments/record/column_name.hpp"
#include "experiments/text/fields.hpp"

namespace beamid::experiments {
namespace {

void append(std::string& text, double value, int digits) {
  char buffer[40];
  char* const end = buffer + sizeof(buffer);
  const auto result = digits > 0 ? std::to_chars(buffer, end, value, std::chars_format::general, digits)
                                 : std::to_chars(buffer, end, value);
  text.append(buffer, result.ptr);
}

}  // namespace

std::string to_csv(const Record& record, int digits) {
  constexpr int most = 17;  // more say nothing about a double
  if (digits < 0 || digits > most)
    throw std::invalid_argument(fmt::format("digits is {}; expected 0 to {}", digits, most));
  const auto channels = static_cast<Eigen::Index>(record.channels.size());
  if (record.samples.rows() != channels || record.samples.cols() != record.size())
    throw std::invalid_argument(fmt::format("samples are {} x {}; expected {} channels x {} instants",
                                            record.samples.rows(), record.samples.cols(), channels,
                                            record.size()));
  if (!record.samples.allFinite() || !record.time.allFinite())
    throw std::invalid_argument("a record with NaN or infinity; expected finite numbers");
  std::string text;
  for (const std::string& name : column_names(record)) text += (text.empty() ? "" : ",") + csv_field(name);
  text += '\n';
  for (Eigen::Index instant = 0; instant < record.size(); ++instant) {
    append(text, record.time[instant], digits);
    for (Eigen::Index channel = 0; channel < channels; ++channel) {
      text += ',';
      append(text, record.samples(channel, instant), digits);
    }
    text += '\n';
  }
  return text;
}

void write_record(const Record& record, const std::filesystem::path& file, int digits) {
  const std::string text = to_csv(record, digits);
  std::filesystem::path part = file;
  part += ".part";
  std::ofstream stream(part, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code failure;
  if (stream) std::filesystem::rename(part, file, failure);
  if (stream && !failure) return;
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  throw std::runtime_error(file.string() + ": cannot be written" + (failure ? ": " + failure.message() : ""));
}

}  // namespace beamid::experiments
