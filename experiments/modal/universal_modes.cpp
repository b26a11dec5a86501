#include "experiments/modal/universal_modes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>

#include "experiments/record/files/universal_lines.hpp"
#include "experiments/text/input_error.hpp"
#include "experiments/text/toml_table.hpp"

namespace beamid::experiments {
namespace {

using Complex = std::complex<double>;

constexpr int normal_mode = 2, complex_eigenvalue = 3,
              complex_eigenvalue_second_order = 7;                 // record 6, field 2
constexpr int displacement = 8, velocity = 11, acceleration = 12;  // record 6, field 4
constexpr int real_numbers = 2, real_double = 4, complex_numbers = 5,
              complex_double = 6;  // record 6, field 5
constexpr std::string_view deviation_words = "standard deviation of the frequency [Hz]:";

/// lambda [rad/s] of a mode, the one of the pair with a positive imaginary part.
Complex eigenvalue_of(const NodalModes::Mode& mode) {
  const double omega = 2.0 * std::numbers::pi * mode.frequency_hz, xi = mode.damping_ratio.value_or(0.0);
  return {-xi * omega, omega * std::sqrt(std::max(0.0, 1.0 - xi * xi))};
}

// Writing.

std::string dataset(int number, const std::string& content) {
  return fmt::format("{:6}\n{:6}\n{}{:6}\n", -1, number, content, -1);
}

/// E13.5, six in a line; -0 is 0.
std::string number_lines(const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format("{:13.5E}{}", values[i] + 0.0, i % 6 == 5 || i + 1 == values.size() ? "\n" : "");
  return text;
}

/// A line of identification: at most 80 bytes of ASCII, as the format has them; NONE where there is nothing.
std::string identification(const std::string& text) {
  std::string line;
  for (const char letter : text) line += letter >= ' ' && letter <= '~' ? letter : '?';
  return (line.empty() ? "NONE" : line.substr(0, 80)) + "\n";
}

std::string node_dataset(const NodalModes& modes) {
  std::string content;
  for (Eigen::Index i = 0; i < modes.places.cols(); ++i)
    content += fmt::format("{:10}{:10}{:10}{:10}{:13.5E}{:13.5E}{:13.5E}\n", i + 1, 0, 0, 8,
                           modes.places(0, i), modes.places(1, i), modes.places(2, i));
  return dataset(15, content);
}

/// One polyline; node 0 lifts the pen.
std::string line_dataset(const NodalModes& modes) {
  std::vector<int> path;
  for (const auto& [from, to] : modes.lines) {
    if (path.empty() || path.back() != from + 1) {
      if (!path.empty()) path.push_back(0);
      path.push_back(from + 1);
    }
    path.push_back(to + 1);
  }
  std::string content = fmt::format("{:10}{:10}{:10}\n{}", 1, path.size(), 8, identification(modes.title));
  for (std::size_t i = 0; i < path.size(); ++i)
    content += fmt::format("{:10}{}", path[i], i % 8 == 7 || i + 1 == path.size() ? "\n" : "");
  return dataset(82, content);
}

std::string mode_dataset(const NodalModes& all, std::size_t number, const NodalModes::Mode& mode) {
  std::string content = identification(all.title);
  content += identification(fmt::format("mode {}, {:.9g} Hz", number, mode.frequency_hz));
  content += identification(mode.damping_ratio ? fmt::format("damping ratio {:.6g}", *mode.damping_ratio)
                                               : "damping ratio not known");
  content += identification(mode.frequency_deviation_hz
                                ? fmt::format("{} {:.5e}", deviation_words, *mode.frequency_deviation_hz)
                                : "");
  content += identification("");
  content +=
      fmt::format("{:10}{:10}{:10}{:10}{:10}{:10}\n", 1, all.complex ? complex_eigenvalue : normal_mode, 2,
                  displacement, all.complex ? complex_numbers : real_numbers, 3);
  const double mass = mode.modal_mass.value_or(0.0);
  if (all.complex) {
    const Complex lambda = eigenvalue_of(mode);
    content += fmt::format("{:10}{:10}{:10}{:10}\n", 2, 6, 1, number);
    content += number_lines({lambda.real(), lambda.imag(), 0, 0, 0, 0});
  } else {
    content += fmt::format("{:10}{:10}{:10}{:10}\n", 2, 4, 1, number);
    content += number_lines({mode.frequency_hz, mass, mode.damping_ratio.value_or(0.0), 0});
  }
  for (Eigen::Index i = 0; i < mode.shape.cols(); ++i) {
    content += fmt::format("{:10}\n", i + 1);
    std::vector<double> values;
    for (const Complex value : mode.shape.col(i)) {
      values.push_back(value.real());
      if (all.complex) values.push_back(value.imag());
    }
    content += number_lines(values);
  }
  return dataset(55, content);
}

// Reading.

/// Numbers of the lines behind a header, in columns of 13 (single precision) or 20.
std::vector<double> numbers_behind(UniversalLines& lines, std::size_t count, std::size_t width) {
  std::vector<double> numbers;
  while (numbers.size() < count) {
    lines.next_of_header("the mode's numbers");
    for (std::size_t from = 0; from < lines.line().size() && numbers.size() < count; from += width) {
      if (lines.field(from, width).empty()) break;
      numbers.push_back(lines.real(from, width, "a number of the mode"));
    }
  }
  return numbers;
}

/// Where the nodes of a file are, by their numbers, in its unit of length.
using NodePlaces = std::map<long long, Eigen::Vector3d>;

void read_nodes(UniversalLines& lines, bool double_precision, NodePlaces& places) {
  while (lines.next() && trimmed(lines.line()) != "-1") {
    const long long node = lines.whole(0, 10, "a node's number");
    const std::size_t from = double_precision ? 0 : 40, width = double_precision ? 25 : 13;
    if (double_precision) lines.next_of_header("a node's place");
    Eigen::Vector3d place;
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[static_cast<Eigen::Index>(axis)] = lines.real(from + axis * width, width, "a node's place");
    places[node] = place;
  }
}

/// [m] of the file's unit of length: lengths are divided by the factor of dataset 164.
double read_length_unit(UniversalLines& lines) {
  lines.next_of_header("the code of the units");
  lines.next_of_header("the factors of the units");
  const double factor = lines.real(0, 25, "the factor of length");
  if (!(factor > 0.0)) lines.fail("no positive factor of length; expected one");
  lines.skip_dataset();
  return 1.0 / factor;
}

struct ReadMode {
  NodalModes::Mode mode;
  std::vector<long long> nodes;
  bool complex = false;
};

/// Frequency, damping ratio and modal mass by the analysis type's own numbers.
void take_eigenvalue(UniversalLines& lines, long long analysis, NodalModes::Mode& mode) {
  lines.next_of_header("record 7, how many numbers describe the mode");
  const long long reals = lines.whole(10, 10, "how many reals describe the mode");
  const std::size_t expected = analysis == normal_mode ? 4 : 6;
  if (reals < (analysis == normal_mode ? 1 : 2) || reals > 100)
    lines.fail(fmt::format("{} reals describe the mode; expected {}", reals, expected), 11);
  const std::vector<double> numbers = numbers_behind(lines, static_cast<std::size_t>(reals), 13);
  if (analysis == normal_mode) {
    mode.frequency_hz = numbers[0];
    if (numbers.size() > 1 && numbers[1] > 0.0) mode.modal_mass = numbers[1];
    if (numbers.size() > 2 && numbers[2] > 0.0) mode.damping_ratio = numbers[2];
  } else {
    const Complex lambda(numbers[0], numbers[1]);
    mode.frequency_hz = std::abs(lambda) / (2.0 * std::numbers::pi);
    mode.damping_ratio = -lambda.real() / std::abs(lambda);
  }
  if (!(mode.frequency_hz > 0.0))
    lines.fail(fmt::format("a mode at {:g} Hz; expected a positive frequency", mode.frequency_hz), 1);
}

/// Absent where the dataset is of another analysis: static, transient, ...
std::optional<ReadMode> read_mode(UniversalLines& lines) {
  ReadMode read;
  for (int id = 1; id <= 5; ++id) {
    lines.next_of_header("five lines of identification");
    const std::size_t at = lines.line().find(deviation_words);
    if (at == std::string_view::npos) continue;
    const double deviation =
        lines.real(at + deviation_words.size(), 20, "the standard deviation of the frequency");
    if (deviation > 0.0) read.mode.frequency_deviation_hz = deviation;
  }
  lines.next_of_header("record 6, the kind of the data");
  const long long analysis = lines.whole(10, 10, "the analysis type"),
                  kind = lines.whole(30, 10, "the kind of data"), form = lines.whole(40, 10, "the data type"),
                  values = lines.whole(50, 10, "the values of a node");
  if (analysis != normal_mode && analysis != complex_eigenvalue &&
      analysis != complex_eigenvalue_second_order) {
    lines.skip_dataset();
    return std::nullopt;
  }
  if (kind != displacement && kind != velocity && kind != acceleration && kind != 0)
    lines.fail(
        fmt::format("data of kind {}; expected 8 (displacement), 11 (velocity) or 12 (acceleration)", kind),
        31);
  if (form != real_numbers && form != real_double && form != complex_numbers && form != complex_double)
    lines.fail(fmt::format("data type {}; expected 2 or 4 (real), 5 or 6 (complex)", form), 41);
  if (values < 1 || values > 6)
    lines.fail(fmt::format("{} values of a node; expected 3 translations, or 6 with rotations", values), 51);
  read.complex = form >= complex_numbers;
  take_eigenvalue(lines, analysis, read.mode);

  const auto per_node = static_cast<std::size_t>(values) * (read.complex ? 2u : 1u);
  std::vector<Eigen::Vector3cd> shape;
  const Complex rate = eigenvalue_of(read.mode);
  const Complex factor = kind == velocity ? rate : kind == acceleration ? rate * rate : Complex(1.0);
  while (lines.next() && trimmed(lines.line()) != "-1") {
    read.nodes.push_back(lines.whole(0, 10, "a node's number"));
    const std::size_t width = form == real_double || form == complex_double ? 20 : 13;
    const std::vector<double> numbers = numbers_behind(lines, per_node, width);
    Eigen::Vector3cd moved = Eigen::Vector3cd::Zero();
    for (std::size_t axis = 0; axis < std::min<std::size_t>(3, static_cast<std::size_t>(values)); ++axis)
      moved[static_cast<Eigen::Index>(axis)] =
          read.complex ? Complex(numbers[2 * axis], numbers[2 * axis + 1]) : Complex(numbers[axis]);
    shape.push_back(moved / factor);
  }
  if (shape.empty()) lines.fail("a mode without nodes; expected its shape");
  read.mode.shape.resize(3, static_cast<Eigen::Index>(shape.size()));
  for (std::size_t i = 0; i < shape.size(); ++i) read.mode.shape.col(static_cast<Eigen::Index>(i)) = shape[i];
  return read;
}

}  // namespace

std::string universal_file(const NodalModes& modes) {
  std::string text = dataset(151, identification(modes.title) + identification("mode shapes") +
                                      identification("beamid " BEAMID_VERSION) + "\n\n" +
                                      identification("beamid " BEAMID_VERSION) + "\n");
  text += dataset(164, fmt::format("{:10}{:<20}{:10}\n{:25.16E}{:25.16E}{:25.16E}\n{:25.16E}\n", 1,
                                   "SI: Meter (newton)", 2, 1.0, 1.0, 1.0, 273.15));
  text += node_dataset(modes);
  if (!modes.lines.empty()) text += line_dataset(modes);
  for (std::size_t m = 0; m < modes.modes.size(); ++m) text += mode_dataset(modes, m + 1, modes.modes[m]);
  return text;
}

NodalModes read_universal_modes(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file, "a Universal File with mode shapes");
  UniversalLines lines(file.string(), bytes);
  NodePlaces places;
  std::vector<ReadMode> read;
  double unit = 1.0;
  for (int number = 0; lines.next_dataset(number);)
    if (number == 15 || number == 2411) {
      read_nodes(lines, number == 2411, places);
    } else if (number == 164) {
      unit = read_length_unit(lines);
    } else if (number == 55) {
      if (auto mode = read_mode(lines)) read.push_back(std::move(*mode));
    } else {
      lines.skip_dataset();
    }
  if (read.empty())
    throw InputError({file.string()},
                     "no mode among the datasets; expected datasets 55 of normal modes or complex modes");

  NodalModes modes;
  const std::vector<long long>& nodes = read.front().nodes;
  modes.places = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (const auto place = places.find(nodes[i]); place != places.end())
      modes.places.col(static_cast<Eigen::Index>(i)) = unit * place->second;
  for (ReadMode& mode : read) {
    if (mode.nodes != nodes)
      throw InputError({file.string()},
                       fmt::format("a mode at {} nodes and one at {} others; expected the same nodes for all",
                                   nodes.size(), mode.nodes.size()));
    modes.complex = modes.complex || mode.complex;
    modes.modes.push_back(std::move(mode.mode));
  }
  return modes;
}

bool holds_universal_modes(const std::filesystem::path& file) {
  std::string beginning(256, ' ');
  std::ifstream(file, std::ios::binary)
      .read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  const std::size_t at = beginning.find_first_not_of(" \r\n");
  if (at == std::string::npos || !beginning.substr(at).starts_with("-1")) return false;
  const std::string bytes = read_bytes(file, "a Universal File");
  UniversalLines lines(file.string(), bytes);
  for (int number = 0; lines.next_dataset(number); lines.skip_dataset())
    if (number == 55) return true;
  return false;
}

}  // namespace beamid::experiments
