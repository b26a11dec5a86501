// A driven record's estimates, held against all samples at once. Oracle: the answer from the truth's own
// values as initial estimates, of which the record has but one.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/config/read_experiment.hpp"
#include "experiments/config/readers.hpp"
#include "experiments/identify/engine/comparison.hpp"

namespace beamid::experiments::all_samples_test {
namespace {

const Progress silent = [](const std::string&) {};

constexpr const char* building = R"(
[chain]
masses_kg = [1000, 1000, 1000, 1000, 1000]
stiffnesses_n_per_m = [2.0e6, 2.0e6, 1.6e6, 1.6e6, 1.2e6]
dashpots_n_s_per_m = [800, 800, 800, 800, 800]

[excitation]
kind = "random"
amplitude_n = 500
frequency_hz = 50
position_m = 5

[model]
name = "beam"
sensor_bias = false

[filter]
discretisation = "pade"

[[sensors]]
position_m = 2
noise_m_per_s2 = 0.01

[[sensors]]
position_m = 4
noise_m_per_s2 = 0.01

[simulation]
duration_s = 10
sampling_rate_hz = 100
steps_per_sample = 2
seed = {}
)";

constexpr const char* unknown = R"(
[[parameters]]
name = "{}{}"
quantity = "{}"
form = "logarithmic"
relative_deviation = {}
{} = {}
from_m = {}
to_m = {}
)";

// Five storeys under a random force at the roof, two accelerometers: stiffness and dashpot of every storey,
// guessed at half or half as much again as the bits of `guesses` say; 0: as they are.
Experiment five_storeys(int seed, unsigned guesses) {
  constexpr double stiffness[]{2.0e6, 2.0e6, 1.6e6, 1.6e6, 1.2e6}, dashpot = 800.0;
  std::string text = fmt::format(building, seed);
  const auto off = [&] {
    const double factor = guesses == 0 ? 1.0 : guesses % 2 == 0 ? 0.5 : 1.5;
    if (guesses != 0) guesses = guesses / 2 + 1024 * (guesses % 2);
    return factor;
  };
  for (int i = 0; i < 5; ++i) {
    text += fmt::format(unknown, "k", i + 1, "storey_stiffness", 0.5, "guess_n_per_m", off() * stiffness[i],
                        i, i + 1);
    text +=
        fmt::format(unknown, "c", i + 1, "storey_damping", 1.0, "guess_n_s_per_m", off() * dashpot, i, i + 1);
  }
  Experiment e = read_experiment(TomlTable::parse(text, "test.toml"));
  e.reduction = parse_reduction("none", "test");
  e.reductions = {e.reduction};
  e.filters = {e.filter};
  e.discretisations = {e.discretisation};
  return e;
}

TEST(AllSamples, SayTheSameFromHalfAndHalfAgainAsFromTheTruth) {
  const unsigned guesses[]{0b1011001110, 0b0110010101};
  for (int seed = 1; seed <= 2; ++seed) {
    const Experiment truth = five_storeys(seed, 0), guessed = five_storeys(seed, guesses[seed - 1]);
    const ComparedRecord record = simulated_record(truth, {}, silent);
    const ComparedRun known = identify_with_model(truth, record, {}, silent).runs.at(0),
                      found = identify_with_model(guessed, record, {}, silent).runs.at(0);
    ASSERT_EQ(found.status, ComparedRun::Status::converged) << found.reason;
    ASSERT_EQ(found.parameters.size(), 10u);
    for (std::size_t j = 0; j < 10; ++j) {
      const Estimate &a = found.parameters[j].estimate, &b = known.parameters[j].estimate;
      EXPECT_NEAR(a.value, b.value, 0.05 * b.deviation) << seed << ": " << a.name;
      EXPECT_NEAR(a.deviation / b.deviation, 1.0, 0.02) << a.name;
      EXPECT_LT(std::abs(a.value - *found.parameters[j].truth), 4.0 * a.deviation) << a.name;
    }
  }
}

}  // namespace
}  // namespace beamid::experiments::all_samples_test
