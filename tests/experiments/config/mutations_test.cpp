// Oracle: a reader's contract. A damaged file parses or throws an InputError; nothing else may happen.
#include <gtest/gtest.h>

#include <random>

#include "experiments/config/read_experiment.hpp"
#include "experiments/record/read_record.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments::mutations_test {
namespace {

/// One to four bytes or pieces removed, doubled, moved or replaced.
std::string mutated(std::string text, std::mt19937& generator) {
  static const char* const pieces[] = {
      "[/",   "[",    "]",  "{",   "}",  "\"", "\"\"\"", "'",    ".",
      "=",    ",",    "\n", "\r",  "#",  "-",  "e",      "_",    "1e999",
      "nan",  "\xff", "\\", "\\u", "[[", "]]", "0x",     "\x01", "99999999999999999999",
      "true", "\t",   ";",  "%"};
  const auto below = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(generator);
  };
  for (std::size_t change = 0, changes = 1 + below(4); change < changes && !text.empty(); ++change) {
    const std::size_t at = below(text.size()),
                      length = 1 + below(std::min<std::size_t>(text.size() - at, 12));
    switch (below(5)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 2:
        text.insert(at, pieces[below(std::size(pieces))]);
        break;
      case 3:
        text.replace(at, length, pieces[below(std::size(pieces))]);
        break;
      default:
        text[at] = static_cast<char>(below(256));
    }
  }
  return below(20) == 0 ? text.substr(0, below(text.size() + 1)) : text;
}

/// @param read what must not throw anything but an InputError.
template <class Read>
void survive(const std::string& valid, unsigned seed, int count, const Read& read) {
  std::mt19937 generator(seed);
  int refused = 0;
  for (int i = 0; i < count; ++i) {
    const std::string text = mutated(valid, generator);
    const TemporaryFile file("mutated", text);
    try {
      read(file.path());
    } catch (const InputError& error) {
      ++refused;
      EXPECT_FALSE(error.file().empty());
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what() << " for the file:\n" << text;
    }
  }
  EXPECT_GT(refused, count / 10);  // else the mutations say nothing
}

constexpr const char* experiment = R"(title = "a beam"
beam = { length_m = 1.1, bending_stiffness_n_m2 = 229, mass_kg = 3.055, tip_mass_kg = 0.36, elements = 20 }
[record]
file = 'a.csv'
window_s = [0.5, 2.0]
time = { column = 1, unit = "ms" }
[[record.channels]]
quantity = "acceleration"
column = "acc"
unit = "g"
[reduction]
method = "rayleigh"
shape = "static_tip_load"
[filter]
method = "ukf"  # unscented
alpha = 1.0
discretisation = "exponential"
[prior]
damping_ratio = 0.01
[noise]
velocity_m_per_s = 1e-5
)";

TEST(Mutations, OfAnExperimentAreReadOrRefused) {
  survive(experiment, 1, 600, [](const std::filesystem::path& file) { read_experiment(file); });
}

TEST(Mutations, OfARecordAreReadOrRefused) {
  std::string record = "# simulated\ntime_s,acceleration_g\n";
  for (int i = 0; i < 20; ++i) record += std::to_string(0.01 * i) + "," + std::to_string(i * i - 3) + "\n";
  RecordFormat by_name;
  by_name.channels = {{Quantity::acceleration, "acceleration_g", 0, 1.0}};
  by_name.window = {0.0, 0.15};
  survive(record, 2, 600, [&](const std::filesystem::path& file) { read_record(file); });
  survive(record, 3, 300, [&](const std::filesystem::path& file) { read_record(file, by_name); });
}

}  // namespace
}  // namespace beamid::experiments::mutations_test
