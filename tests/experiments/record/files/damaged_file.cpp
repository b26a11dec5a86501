#include "tests/experiments/record/files/damaged_file.hpp"

#include <gtest/gtest.h>

#include <random>

#include "experiments/record/read_record.hpp"
#include "tests/experiments/config/temporary_file.hpp"

namespace beamid::experiments {

void expect_read_or_refused(const std::string& name, const std::string& whole, const RecordFormat& format,
                            unsigned seed, int rounds) {
  std::mt19937 random(seed);
  const auto below = [&](std::size_t limit) { return static_cast<std::size_t>(random()) % limit; };
  int refused = 0;
  for (int round = 0; round < rounds; ++round) {
    std::string damaged = whole;
    for (std::size_t change = 0; change <= below(4) && !damaged.empty(); ++change) {
      const std::size_t at = below(damaged.size());
      switch (below(5)) {
        case 0:
          damaged[at] = static_cast<char>(below(256));
          break;
        case 1:
          damaged.erase(at, below(40));
          break;
        case 2:
          damaged.insert(at, damaged.substr(below(damaged.size()), below(60)));
          break;
        case 3:
          damaged[at] = static_cast<char>(damaged[at] ^ (1 << below(8)));
          break;
        default:
          damaged.resize(at + 1);
      }
    }
    const TemporaryFile file(name, damaged);
    try {
      const Record record = read_record(file.path(), format);
      EXPECT_EQ(record.samples.cols(), record.size());
      EXPECT_TRUE(record.samples.allFinite());
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, rounds / 20);
}

}  // namespace beamid::experiments
