#include "experiments/config/read_acquisition.hpp"

#include <fmt/format.h>

#include "experiments/config/key_tables.hpp"
#include "experiments/config/read_simulation.hpp"

namespace beamid::experiments {
namespace {

const Schema<Acquisition>& acquisition_keys() {
  using A = Acquisition;
  constexpr double most_jitter = 0.5, most_repeated = 0.9;
  constexpr int most_gaps = 1000;
  static const Schema<A> keys =
      Schema<A>("acquisition")
          .key("pretrigger_s", &A::pretrigger, not_negative,
               "recorded before the excitation begins, in whole samples; the beam is held where it starts",
               "0.5")
          .key("jitter", &A::jitter, {0.0, most_jitter},
               "standard deviation of the intervals between stamps, a share of their mean", "0.3")
          .key("median_shortfall", &A::median_shortfall, {0.0, most_jitter * largest_shortfall},
               "share of the mean interval by which the median one is shorter: a loop that is held up now "
               "and then",
               "0.08")
          .values("number, 0 to 0.41 of `jitter`")
          .key("gaps", &A::gaps, {0, most_gaps},
               "how often samples are missing: once, anywhere, in each of as many equal parts of the record",
               "3")
          .key("gap_s", &A::gap, "shortest and longest gap; drawn evenly on a logarithmic scale",
               "[0.02, 0.2]")
          .values("two numbers > 0")
          .key("repeated", &A::repeated, {0.0, most_repeated},
               "share of samples that show the reading before once more, under a stamp of their own", "0.04")
          .key("force", &A::force,
               "whether the record holds the exciting force, or the base's acceleration, as a channel; that "
               "of a release never is one",
               "false")
          .key("force_noise_n", &A::force_noise, not_negative,
               "standard deviation of the noise of that channel", "0.5")
          .key("base_noise_m_per_s2", &A::base_noise, not_negative, "likewise, of the base's acceleration",
               "0.01");
  return keys;
}

const bool acquisition_keys_registered =
    register_keys([]() -> const KeyTable& { return acquisition_keys(); });

}  // namespace

Acquisition read_acquisition(const TomlTable& root) {
  Acquisition acquisition;
  if (const auto table = root.find_table("acquisition")) {
    acquisition = acquisition_keys().read(*table);
    const double most = largest_shortfall * acquisition.jitter;
    if (acquisition.median_shortfall > most)
      table->refuse("median_shortfall", fmt::format("a number from 0 to {:g}", most));
    if (!(acquisition.gap.first > 0)) table->refuse("gap_s", "a shortest gap above 0");
  }
  acquisition.sensors = read_defects(root);
  return acquisition;
}

}  // namespace beamid::experiments
