#include "experiments/identify/model_check/observed_modes.hpp"

#include <cmath>

#include "experiments/modal/study/merged_modes.hpp"

namespace beamid::experiments {

std::vector<ObservedMode> observed_modes(const std::vector<RecordModes>& records) {
  std::vector<ObservedMode> observed;
  for (const MergedMode& mode : merge_modes(records)) {
    ObservedMode one{
        mode.frequency_hz.mean, std::fmax(mode.frequency_hz.deviation, mode.frequency_hz.scatter),
        mode.damping_ratio.mean, std::fmax(mode.damping_ratio.deviation, mode.damping_ratio.scatter)};
    for (std::size_t r = 0; r < records.size(); ++r) {
      if (mode.places[r] < 0) continue;
      if (one.records.empty()) one.shape = records[r].modes[mode.places[r]].pole.shape;
      one.records.push_back(records[r].name);
    }
    observed.push_back(std::move(one));
  }
  return observed;
}

}  // namespace beamid::experiments
